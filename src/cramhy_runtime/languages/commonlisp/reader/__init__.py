"""The reader: text in, forms out (ANSI chapters 2 and 23)."""
