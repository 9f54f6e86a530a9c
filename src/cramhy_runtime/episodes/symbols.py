"""The Lisp package of this room, made before anything interns a symbol in it.

What it contains is declared in ``languages/commonlisp/faces/episodes/package.py``.
"""

from ..cpl.symbols import CPL_IMPL
from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, sym
from ..utilities.symbols import CUT

CET = ensure_package("CRAM-EXECUTION-TRACE", "CET", use=[COMMON_LISP, CUT, CPL_IMPL])
CET.lends_nicknames = True

__all__ = ["CET", "sym"]
