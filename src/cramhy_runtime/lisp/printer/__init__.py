"""The printer and the pretty printer: objects in, text out (ANSI chapter 22)."""
