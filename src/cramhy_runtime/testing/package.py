"""The Lisp face: package CRAMHY-TESTING with ``mark``, and TESTING-USER, in which texts of plans are read."""

from __future__ import annotations

from ..lisp.faces import define_face
from . import traces

_defined = False


def define_faces():
    """Make the packages, once."""
    global _defined
    if _defined:
        return
    _defined = True
    define_face("CRAMHY-TESTING", functions={"mark": traces.mark}, export="mark injected-failure")
    define_face("TESTING-USER", use=["CRAM-LANGUAGE", "CRAMHY-TESTING"])
