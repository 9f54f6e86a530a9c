"""Message and service definitions, in the layout of ROS packages: ``PACKAGE/msg/*.msg`` and ``PACKAGE/srv/*.srv``."""
