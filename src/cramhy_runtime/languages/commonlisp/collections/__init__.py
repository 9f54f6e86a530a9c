"""Lists, arrays, strings and sequences (ANSI chapters 13 to 17). Hash tables are in ``lisp_core/hash_tables.py``."""
