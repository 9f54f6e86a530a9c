"""How Common Lisp sees the room ``transforms``: its packages, and how its objects are printed and described."""
