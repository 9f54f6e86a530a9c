"""Files and systems of programs: loading, ASDF, and Lisp packages as Python modules."""
