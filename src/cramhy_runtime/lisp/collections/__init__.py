"""Lists, arrays, strings, sequences and hash tables (ANSI chapters 13 to 18)."""
