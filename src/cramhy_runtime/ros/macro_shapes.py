"""The shapes of roslisp's macros, for the report of a call that has another one (roslisp.md; written as those of the standard macros in
``lisp/evaluation/macro_shapes.py``: ``[x]`` may be left out, ``...`` repeats).
"""

from __future__ import annotations

from ..lisp.packages import sym

SHAPES = """
(roslisp::def-ros-node name (parameter...) ([:spin spin]) form...)
(roslisp::def-service-call (name service) "service" [:return-field field])
(roslisp::def-service-callback (name service) (field...) form...)
(roslisp-utils::loop-at-most-every seconds form...)
(roslisp::make-message "package/Type" field value...)
(roslisp::make-msg "package/Type" field value...)
(roslisp::make-publisher-msg publication field value...)
(roslisp::make-request "package/Service" field value...)
(roslisp::modify-message-copy message field value...)
(roslisp::publish-msg publication field value...)
(roslisp::register-service "service" type)
(roslisp::ros-debug (topic...) [condition] "text" argument...)
(roslisp::ros-error (topic...) [condition] "text" argument...)
(roslisp::ros-fatal (topic...) [condition] "text" argument...)
(roslisp::ros-info (topic...) [condition] "text" argument...)
(roslisp::ros-warn (topic...) [condition] "text" argument...)
(roslisp::setf-msg place field value...)
(roslisp-utils::spin-until test seconds form...) or (spin-until test (seconds timeout) form...)
(roslisp::store-message-in place)
(roslisp::with-fields (field...) message form...)
(roslisp::with-parallel-thread (function ["name"]) form...)
(roslisp::with-ros-node ("name" [:option value...]) form...)
""".strip().splitlines()


def define():
    """Let the names of the macros know how they are written."""
    for shape in SHAPES:
        name = shape.split()[0].strip("(")
        symbol = sym(name.upper())
        symbol.compiler_data = {**(symbol.compiler_data or {}), "shape": shape.replace(name, name.rpartition(":")[2])}
