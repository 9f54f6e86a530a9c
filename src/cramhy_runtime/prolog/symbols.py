"""The Lisp package of this room, made before anything interns a symbol in it; its contents are in ``package.py``."""

from ..lisp.packages import COMMON_LISP, ensure_package, sym
from ..utilities.symbols import CUT

PROLOG = ensure_package("CRAM-PROLOG", "PROLOG", use=[COMMON_LISP, CUT])

__all__ = ["CUT", "PROLOG", "sym"]
