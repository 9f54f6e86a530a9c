"""The Lisp packages of this room, made before anything interns a symbol in them; their contents are in ``package.py``."""

from ..lisp.packages import COMMON_LISP, ensure_package, sym

CUT = ensure_package("CRAM-UTILITIES", "CUT", use=[COMMON_LISP])
PROLOG = ensure_package("CRAM-PROLOG", "PROLOG", use=[COMMON_LISP, CUT])

__all__ = ["CUT", "PROLOG", "sym"]
