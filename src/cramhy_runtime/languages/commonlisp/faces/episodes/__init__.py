"""How Common Lisp sees the room ``episodes``: its packages, and how its objects are printed and described."""
