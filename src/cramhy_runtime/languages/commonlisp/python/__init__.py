"""Python from Lisp, and Lisp from Python."""
