"""Frames and how they lie to each other: stamped poses and transforms, tf's buffer, listeners and broadcasters.

The packages CL-TRANSFORMS-STAMPED, CL-TF and CL-TF2 of roslisp_common, made when somebody names one of them
(``languages/commonlisp/faces/tf/package.py``). Source: reference page ``cl-transforms.md``, sections 5 to 8.

Where the parts are:

* `stamped`          poses, points and transforms with a frame and a time; `frames` their names; `errors` the conditions
* `stamped_messages` to and from messages of geometry_msgs
* `buffer`           the transforms of the last ten seconds and the way through them: plain Python, knows nothing of ROS
* `transformer`      the buffer for Lisp, with waiting; the listener that fills it from ``/tf`` and ``/tf_static``
* `broadcasting`     sending transforms; `buffer_client` asking a tf2 buffer server
* `programs`         what ``rosrun`` starts: tf_echo, static_transform_publisher, and the turtle that follows another one
"""
