"""How Common Lisp sees the room ``actionlib``: its packages, and how its objects are printed and described."""
