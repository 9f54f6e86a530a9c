"""Files and systems of programs: loading, ``compile-file``, ASDF, and Lisp packages as Python modules (ANSI chapter 24)."""
