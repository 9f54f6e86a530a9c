"""The Lisp packages of this room, made before anything interns a symbol in them; their contents are in ``package.py``."""

from ..designators import symbols as _designators  # noqa: F401  its packages come first
from ..lisp.packages import ensure_package, sym

CPM = ensure_package("CRAM-PROCESS-MODULES", "CPM")
EXE = ensure_package("CRAM-EXECUTIVE", "EXE")

__all__ = ["CPM", "EXE", "sym"]
