"""The Lisp package of this room, made before anything interns a symbol in it; its contents are in ``package.py``."""

from ..designators import symbols as _designators  # noqa: F401  its packages come first
from ..episodes import symbols as _episodes  # noqa: F401
from ..lisp.packages import ensure_package, sym

COE = ensure_package("CRAM-OCCASIONS-EVENTS", "COE", "OCCASIONS-EVENTS")
COE.lends_nicknames = True

__all__ = ["COE", "sym"]
