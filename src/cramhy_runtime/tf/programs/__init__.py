"""The programs of the packages tf, tf2_ros, turtle_tf and turtle_tf2, as ``rosrun`` and launch files start them.

`frames` has those that publish and print transforms, `turtles` those of the demonstration in which one turtle follows another.
Importing this package imports none of them.
"""
