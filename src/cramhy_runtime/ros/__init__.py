"""ROS in the process: a graph of nodes with topics, services and parameters, and roslisp's functions on top of it.

The modules can be used from Python without any Lisp: ``messages`` and ``wire`` (types), ``graph``, ``topics``, ``services``,
``parameters`` (what the master and the sockets do in ROS 1), ``node``, ``client``, ``logging`` and ``time`` (what roslisp's
functions do). ``package`` gives them their Lisp names. Importing this package imports none of them.
"""
