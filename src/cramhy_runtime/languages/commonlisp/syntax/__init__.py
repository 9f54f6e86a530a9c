"""How forms are written: backquote, lambda lists, macros, and the shapes of calls (ANSI 2.4.6, 3.1, 3.3 and 3.4)."""
