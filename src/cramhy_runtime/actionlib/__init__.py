"""Actions: goals that take a while, with feedback on the way, and that can be cancelled.

An action is five topics and a rule for what the two sides tell each other on them. `goals` has what both sides know of a goal,
`client` the side that wants something and `simple_client` its Lisp functions (package ACTIONLIB-LISP), `calls` the older client
that waits for its goal, and `server` the side that does it (package ACTIONLIB). Source: roslisp.md 13.
"""
