"""The Lisp package of this room, made before anything interns a symbol in it.

``languages/commonlisp/faces/prolog/package.py`` declares its contents.
"""

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, sym
from ..utilities.symbols import CUT

PROLOG = ensure_package("CRAM-PROLOG", "PROLOG", use=[COMMON_LISP, CUT])

__all__ = ["CUT", "PROLOG", "sym"]
