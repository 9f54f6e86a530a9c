"""How Common Lisp sees the room ``process_modules``: its packages, and how its objects are printed and described."""
