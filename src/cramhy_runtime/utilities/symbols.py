"""The Lisp package of this room, made before anything interns a symbol in it.

What it contains is declared in ``languages/commonlisp/faces/utilities/package.py``.
"""

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, sym

CUT = ensure_package("CRAM-UTILITIES", "CUT", use=[COMMON_LISP])

__all__ = ["CUT", "sym"]
