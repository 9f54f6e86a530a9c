"""Pathnames: their parts, their text, wild and logical ones (ANSI chapter 19)."""
