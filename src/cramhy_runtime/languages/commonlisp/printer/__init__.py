"""The printer, the pretty printer, and how classes, pathnames and streams print: objects in, text out (ANSI chapter 22)."""
