"""Geometry: vectors, quaternions, transforms and poses; the Lisp package CL-TRANSFORMS. Source: reference page ``cl-transforms.md``.

Conventions: right-handed, metres and radians, quaternions in the order x y z w. A transform with translation t and rotation q
maps a point p to t + q p q⁻¹, and ``transform_star(a, b)`` applies b first.

The classes `vectors.Vector3`, `quaternions.Quaternion`, `poses.Transform` and `poses.Pose` hold plain Python floats:
``Pose(Vector3(1, 2, 0.1), yaw(0.5))``. The functions with Lisp names (``make_3d_vector``, ``yaw``, readers such as ``x``) take them as
they are, and give them.
"""
