"""How Common Lisp sees the room ``turtlesim``: its packages, and how its objects are printed and described."""
