"""How Common Lisp sees the room ``designators``: its packages, and how its objects are printed and described."""
