"""``from cramhy import robot`` in Python, ``(import cramhy [robot])`` in Hy: see `cramhy_runtime.robot`."""

from cramhy_runtime.robot import *  # noqa: F403
from cramhy_runtime.robot import __all__  # noqa: F401
