"""Files that describe robots and furniture: URDF, xacro, which is expanded to URDF, or MJCF, which has <mujoco> around all."""

from __future__ import annotations

from pathlib import Path

from . import urdf, xacro_files
from .descriptions import Description
from .xml_elements import read_bytes, root_name


def read_text(text: str | bytes, file: str = "") -> Description:
    """The description in a text; ``file`` is its name in errors. Errors: `DescriptionError`; ImportError, for MJCF without MuJoCo."""
    if root_name(text) == "mujoco":
        from . import mjcf  # MuJoCo is an extra

        return mjcf.read_text(text, file)
    return urdf.read_text(text, file)


def read_file(path: str | Path) -> Description:
    """The description in a file. Errors: as of `read_text`; OSError, when it cannot be read."""
    if xacro_files.is_xacro(path):
        return urdf.read_text(xacro_files.expanded(path), str(path))
    data = read_bytes(path)
    if root_name(data) == "mujoco":
        from . import mjcf

        return mjcf.read_file(path)
    return urdf.read_text(data, str(path))
