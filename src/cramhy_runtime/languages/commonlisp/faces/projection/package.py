"""The face of projection: CRAM-PROJECTION (projection-and-events.md A3). The macros are in ``hy_src/cramhy/proj.hy``."""

from __future__ import annotations

from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import PROJECTION
from cramhy_runtime.projection import clocks
from . import environment_results, macro_support

EXPORTED = """*projection-environment* linear-clock partially-ordered-clock"""


def define_faces():
    """Declare the package."""
    define_face(
        "CRAM-PROJECTION",
        ["PROJ"],
        use=["COMMON-LISP"],
        functions={clocks: "clock-time clock-wait partially-ordered-clock-enabled"},
        export=EXPORTED,
    )
    export(PROJECTION)
    macro_support.define()
    environment_results.define_result()


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_faces()
