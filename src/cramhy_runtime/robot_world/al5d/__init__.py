"""A Lynxmotion AL5D on a table, and bricks: the arm of the Cognitive Robotics course, as a simulated ROS node.

A small arm of six hobby servos takes and places bricks. Programs speak to the node ``/lynxmotion_al5d`` as to the course's simulator in
Gazebo. Here MuJoCo moves the arm, and fingers hold a brick by friction alone.

==============  =====================================================================================
``model``       the arm, the table, the bricks and the camera: sizes, limits, colours
``servos``      the way of servos to where they are sent, at limited speed
``bench``       the physical world with the arm in it
``pulses``      messages that are made as long as somebody listens
``pictures``    the camera's pictures, which are drawn when somebody looks at them
``frames``      where the links and the camera are, for tf, and what the camera's picture measures
``names``       the names of the node and of its package
``bricks``      a brick with its topic and its services
``node``        the node of the simulator
``clients``     ``spawn_brick`` and ``kill_brick``, programs for a second terminal
``demand``      the simulator that starts when it is asked for
==============  =====================================================================================

Law: while nothing moves and nobody listens, the arm costs nothing: no timer runs. Sources: the README of the course's package
lynxmotion_al5d_description (topics, services, limits), the maker's figures of the AL5D, https://mujoco.readthedocs.io (contacts).
Importing this package imports none of them.
"""
