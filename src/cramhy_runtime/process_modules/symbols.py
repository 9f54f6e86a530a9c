"""The Lisp packages of this room, made before anything interns a symbol in them.

``languages/commonlisp/faces/process_modules/package.py`` declares their contents.
"""

from cramhy_runtime.designators import symbols as _designators  # noqa: F401  its packages come first
from cramhy_runtime.lisp_core.packages import ensure_package, sym

CPM = ensure_package("CRAM-PROCESS-MODULES", "CPM")
EXE = ensure_package("CRAM-EXECUTIVE", "EXE")

__all__ = ["CPM", "EXE", "sym"]
