"""Classes, generic functions, structures: the object system (ANSI chapters 4.3, 7 and 8)."""
