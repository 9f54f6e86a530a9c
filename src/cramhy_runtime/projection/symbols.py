"""The Lisp package of this room, made before anything interns a symbol in it.

``languages/commonlisp/faces/projection/package.py`` declares its contents.
"""

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, sym

PROJ = ensure_package("CRAM-PROJECTION", "PROJ", use=[COMMON_LISP])
PROJ.lends_nicknames = True

__all__ = ["PROJ", "sym"]
