"""How Common Lisp sees the room ``projection``: its packages, and how its objects are printed and described."""
