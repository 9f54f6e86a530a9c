"""What one asks at the prompt: describe, inspect, trace, apropos, disassemble (ANSI chapter 25)."""
