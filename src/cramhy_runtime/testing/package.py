"""The Lisp packages: CRAMHY-TESTING with ``mark``, and TESTING-USER, in which texts of plans are read.

They are made when a program first names one of them (`repl.session`).
"""

from __future__ import annotations

from cramhy_runtime.languages.commonlisp.packages.face_definition import define_face
from cramhy_runtime.lisp_core.packages import on_demand, registered
from . import traces


NAMES = ("CRAMHY-TESTING", "TESTING-USER")


def define_faces():
    """Make the packages, once in each image."""
    for name in NAMES:
        on_demand.pop(name, None)
    if registered("TESTING-USER") is not None:
        return
    define_face("CRAMHY-TESTING", functions={"mark": traces.mark}, export="mark injected-failure")
    define_face("TESTING-USER", use=["CRAM-LANGUAGE", "CRAMHY-TESTING"])
