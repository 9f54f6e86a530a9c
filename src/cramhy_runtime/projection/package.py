"""The face of projection: CRAM-PROJECTION (projection-and-events.md A3). The macros are in ``hy_src/cramhy/proj.hy``."""

from __future__ import annotations

from ..lisp.faces import define_face
from ..process_modules import package as _process_modules  # noqa: F401  projections run its modules
from . import clocks, macro_support
from . import printing as _printing  # noqa: F401

EXPORTED = """define-projection-environment define-special-projection-variable with-projection-environment *projection-environment*
    linear-clock partially-ordered-clock with-partially-ordered-clock-disabled"""


def define_faces():
    """Declare the package."""
    define_face("CRAM-PROJECTION", ["PROJ"], use=["COMMON-LISP"],
                functions={clocks: "clock-time clock-wait partially-ordered-clock-enabled"}, export=EXPORTED)
    macro_support.define()


define_faces()
