"""Message and service definitions, as ROS packages keep them: ``PACKAGE/msg/*.msg`` and ``PACKAGE/srv/*.srv``."""
