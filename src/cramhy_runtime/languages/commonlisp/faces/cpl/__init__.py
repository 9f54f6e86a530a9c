"""How Common Lisp sees the room ``cpl``: its packages, and how its objects are printed and described."""
