"""The time of the Lisp program: the kernel's clock, or ``/clock`` if ``/use_sim_time`` is set.

Time is counted in seconds from 1970. In virtual time, the kernel's zero is the moment on the lecture's slide, so every run
prints the same stamps. Source: roslisp.md 9.
"""

from __future__ import annotations

from .. import graph


def ros_time() -> float:
    """The time in seconds since 1970, a double. Under simulated time: the last ``/clock``, or 0.0 before the first."""
    here = graph.active()
    node = here.lisp_node
    if node is not None and getattr(node, "simulated_time", None) is not None:
        return node.simulated_time
    return float(here.now())
