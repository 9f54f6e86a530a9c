"""ROS in the process: a graph of nodes with topics, services and parameters, and roslisp's functions on top of it.

The ground can be used from Python without any Lisp program: ``messages`` and ``wire`` (types), ``topics`` and ``services`` (the
two ends of each), ``names``, ``parameter_tree``, ``graph`` (what the master and the sockets do in ROS 1) and ``rosout``. On it stand
the folder ``roslisp`` (the functions of the program's node), on that ``python`` (the same for programs in Python), and the room
``ros_tools`` (the commands). Importing this package imports none of them.
"""
