"""Geometry: vectors, quaternions, transforms and poses; the Lisp package CL-TRANSFORMS. Source: reference page ``cl-transforms.md``.

Conventions: right-handed, metres and radians, quaternions in the order x y z w. A transform with translation t and rotation q
maps a point p to t + q p q⁻¹, and ``transform_star(a, b)`` applies b first.

The classes hold plain Python floats. The functions with Lisp names (``make_3d_vector``, readers such as ``x``) are the border:
they coerce their arguments as Lisp does and give `DoubleFloat` objects.
"""
