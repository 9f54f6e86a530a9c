"""Type specifiers (ANSI chapter 4)."""
