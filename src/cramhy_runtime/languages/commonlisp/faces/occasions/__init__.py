"""How Common Lisp sees the room ``occasions``: its packages, and how its objects are printed and described."""
