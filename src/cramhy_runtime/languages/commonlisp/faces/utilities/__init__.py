"""How Common Lisp sees the room ``utilities``: its packages, and how its objects are printed and described."""
