"""Actions: goals that take a while, with feedback on the way, and that can be cancelled.

An action is five topics and a rule for what the two sides tell each other on them. `goals` has what both sides know of a goal,
`client` the side that wants something and `simple_client` its Lisp functions (package ACTIONLIB-LISP), `calls` the older client
that waits for its goal, `goal_server` what every server tells its clients, and `server` the one that gives goals to a function (package
ACTIONLIB). `shape_server` is a program: it lets a turtle draw. Source: roslisp.md 13.
"""
