"""Numbers (ANSI chapter 12)."""
