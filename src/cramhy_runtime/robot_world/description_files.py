"""Files that describe robots and furniture, of either kind: URDF, or MJCF, which has <mujoco> around all."""

from __future__ import annotations

import re
from pathlib import Path

from . import urdf
from .descriptions import Description

_MJCF = re.compile(rb"\A(?:\xef\xbb\xbf)?\s*(?:<\?.*?\?>\s*|<!--.*?-->\s*|<!DOCTYPE[^>]*>\s*)*<mujoco[\s>/]", re.DOTALL)


def read_text(text: str | bytes, file: str = "") -> Description:
    """The description in a text; ``file`` is its name in errors. Errors: `DescriptionError`; ImportError, for MJCF without MuJoCo."""
    if _is_mjcf(text):
        from . import mjcf  # MuJoCo is an extra

        return mjcf.read_text(text, file)
    return urdf.read_text(text, file)


def read_file(path: str | Path) -> Description:
    """The description in a file. Errors: as of `read_text`; OSError, when it cannot be read."""
    if _is_mjcf(Path(path).read_bytes()):
        from . import mjcf

        return mjcf.read_file(path)
    return urdf.read_file(path)


def _is_mjcf(text: str | bytes) -> bool:
    return _MJCF.match(text.encode("utf-8", "replace") if isinstance(text, str) else text) is not None
