"""LOOP (ANSI 6.1)."""
