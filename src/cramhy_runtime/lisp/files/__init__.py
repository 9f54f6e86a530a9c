"""Pathnames and files (ANSI chapters 19 and 20)."""
