"""numpy, which comes with the extra ``robot``. All of this folder takes it from here, so that its absence is told in one line."""

from __future__ import annotations

from cramhy_runtime.extras import install_command

try:
    import numpy as np
except ImportError as _problem:
    raise ImportError(f"Costmaps need the Python package numpy, which is not installed. Type: {install_command('robot')}") from _problem

__all__ = ["np"]
