"""The Lisp packages of this room, made before anything interns a symbol in them; their contents are in ``package.py``."""

from ..lisp.packages import ensure_package, sym
from ..prolog import package as _prolog  # noqa: F401  this room's predicates and hooks have names of its packages

DESIG = ensure_package("CRAM-DESIGNATORS", "DESIG")
DESIG_PROPS = ensure_package("CRAM-DESIGNATOR-PROPERTIES", "DESIG-PROPS")
SUPPORT = ensure_package("CRAM-LANGUAGE-DESIGNATOR-SUPPORT", "CPL-DESIG-SUPP")

__all__ = ["DESIG", "DESIG_PROPS", "SUPPORT", "sym"]
