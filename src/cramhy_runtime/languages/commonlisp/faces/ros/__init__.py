"""How Common Lisp sees the room ``ros``: its packages, and how its objects are printed and described."""
