"""The Lisp package of this room, made before anything interns a symbol in it.

``languages/commonlisp/faces/occasions/package.py`` declares its contents.
"""

from cramhy_runtime.designators import symbols as _designators  # noqa: F401  its packages come first
from cramhy_runtime.episodes import symbols as _episodes  # noqa: F401
from cramhy_runtime.lisp_core.packages import ensure_package, sym

COE = ensure_package("CRAM-OCCASIONS-EVENTS", "COE", "OCCASIONS-EVENTS")
COE.lends_nicknames = True

__all__ = ["COE", "sym"]
