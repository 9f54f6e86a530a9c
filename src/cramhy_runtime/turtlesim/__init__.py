"""turtlesim in the process: the simulator of the course, tick by tick as the C++ one computes it.

``world`` is the kinematics, ``canvas`` the paper with the pen's lines and the colour sensor, ``node`` the ROS node,
``teleop`` the arrow keys. Importing this package imports none of them.
"""
