"""ROS in the process: a graph of nodes with topics, services and parameters, and roslisp's functions on top of it.

Python can use the lower modules without any Lisp program: ``messages`` and ``wire`` (types), ``topics`` and ``services`` (the
two ends of each), ``names``, ``parameter_tree``, ``graph`` (the work of the master and the sockets in ROS 1) and ``rosout``.
The folder ``roslisp`` (the functions of the program's node), the folder ``python`` on it (the same for programs in Python) and the room
``ros_tools`` (the commands) use them.
Importing this package imports none of them.
"""
