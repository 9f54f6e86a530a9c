"""What Common Lisp sees of the room ``robot_world``: the package ROBOT-WORLD, on which CRAM-BULLET-REASONING is written in Lisp."""
