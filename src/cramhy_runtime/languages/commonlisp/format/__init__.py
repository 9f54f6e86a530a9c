"""``format``: its control strings and their directives (ANSI 22.3)."""
