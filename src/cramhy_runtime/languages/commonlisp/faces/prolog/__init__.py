"""How Common Lisp sees the room ``prolog``: its packages, and how its objects are printed and described."""
