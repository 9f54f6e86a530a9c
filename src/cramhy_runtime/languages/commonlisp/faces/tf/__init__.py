"""How Common Lisp sees the room ``tf``: its packages, and how its objects are printed and described."""
