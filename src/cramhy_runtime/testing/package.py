"""The Lisp face: package CRAMHY-TESTING with ``mark``, and TESTING-USER, in which texts of plans are read.

They are made when a program first names one of them (``image.define_testing``).
"""

from __future__ import annotations

from ..lisp.faces import define_face
from ..lisp.packages import on_demand
from . import traces


def define_faces():
    """Make the packages, once."""
    if on_demand.pop("CRAMHY-TESTING", None) is None:
        return
    on_demand.pop("TESTING-USER", None)
    define_face("CRAMHY-TESTING", functions={"mark": traces.mark}, export="mark injected-failure")
    define_face("TESTING-USER", use=["CRAM-LANGUAGE", "CRAMHY-TESTING"])
