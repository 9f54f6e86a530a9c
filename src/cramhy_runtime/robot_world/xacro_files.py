"""Xacro files: descriptions of robots that are written with macros, and expanded to URDF by the Python package ``xacro``.

``$(find package)`` means a package as all of cramhy finds it, below ``ROS_PACKAGE_PATH``; the package xacro itself would ask ROS 2 for it.
Its expressions are Python: a xacro file is a program, as a launch file is. Source: https://github.com/ros/xacro/wiki.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from cramhy_runtime.extras import install_command
from cramhy_runtime.ros import definition_files
from .descriptions import DescriptionError
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

ENDING = ".xacro"
_FINDER = "ament_index_python"


def is_xacro(path: str | Path) -> bool:
    """Whether a file is one of macros: its name ends in ``.xacro``."""
    return str(path).lower().endswith(ENDING)


def expanded(path: str | Path, arguments: Mapping[str, str] | None = None) -> str:
    """The URDF text that a xacro file is expanded to.

    arguments: values of its ``<xacro:arg>``, by name. Errors: `DescriptionError`, with the files that include each other, if it cannot be
    expanded or the package xacro is not installed; OSError, when the file itself cannot be read.
    """
    with open(path, "rb"):  # the error of a file that is not there is the usual one
        pass
    try:
        import xacro
    except ImportError:
        raise DescriptionError(f"expanding it takes the Python package xacro. Type: {install_command('robot')}", str(path)) from None
    try:
        with _our_packages():
            return xacro.process_file(str(path), mappings=dict(arguments or {})).toxml()
    except Exception as problem:  # whatever Python expressions in the file raise
        inside = [file for file in xacro.filestack or () if file and file != str(path)]
        way = f" It is in {inside[-1]}." if inside else ""
        macros = [macro.body.getAttribute("name") for macro in xacro.macrostack or () if macro.body is not None]
        way += f" The macro {macros[-1]} was being expanded." if macros else ""
        cause, suffix = getattr(problem, "exc", None), getattr(problem, "suffix", "") or ""
        reason = (str(problem) if cause is None else f"{cause} {suffix}").strip().rstrip(".") or type(problem).__name__
        raise DescriptionError(f"xacro cannot expand it: {reason}.{way}", str(path)) from None


def _share(package: str) -> str:
    folder = next((folder for name, folder in definition_files.packages() if name == package), None)
    if folder is None:
        raise LookupError(f"the ROS package {package} is not found; ROS_PACKAGE_PATH names the folders in which packages are")
    return str(folder)


@contextmanager
def _our_packages() -> Iterator[None]:
    """Let ``$(find package)`` be answered by our search: xacro imports a module of ROS 2 for it, in whose place another one stands."""
    finder, packages = ModuleType(_FINDER), ModuleType(f"{_FINDER}.packages")
    packages.get_package_share_directory = _share  # type: ignore[attr-defined]
    before = {module.__name__: sys.modules.get(module.__name__) for module in (finder, packages)}
    sys.modules.update({finder.__name__: finder, packages.__name__: packages})
    try:
        yield
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module
