"""The Lisp packages of this room, made before anything interns a symbol in them.

``languages/commonlisp/faces/cpl/package.py`` declares their contents when all the code is there.
"""

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, sym

CPL_IMPL = ensure_package("CRAM-LANGUAGE-IMPLEMENTATION", "CPL-IMPL", use=[COMMON_LISP])
CPL = ensure_package("CRAM-LANGUAGE", "CPL")

__all__ = ["CPL", "CPL_IMPL", "sym"]
