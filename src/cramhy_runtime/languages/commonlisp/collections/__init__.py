"""Lists, arrays, strings and sequences (ANSI chapters 13 to 17). Hash tables are in ``ground/hash_tables.py``."""
