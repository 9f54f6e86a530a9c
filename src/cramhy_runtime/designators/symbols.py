"""The Lisp packages of this room, made before anything interns a symbol in them.

``languages/commonlisp/faces/designators/package.py`` declares their contents.
"""

from cramhy_runtime.lisp_core.packages import ensure_package, sym
from cramhy_runtime.prolog import symbols as _prolog  # noqa: F401  its package, whose predicates this room extends

DESIG = ensure_package("CRAM-DESIGNATORS", "DESIG")
DESIG_PROPS = ensure_package("CRAM-DESIGNATOR-PROPERTIES", "DESIG-PROPS")
SUPPORT = ensure_package("CRAM-LANGUAGE-DESIGNATOR-SUPPORT", "CPL-DESIG-SUPP")

__all__ = ["DESIG", "DESIG_PROPS", "SUPPORT", "sym"]
