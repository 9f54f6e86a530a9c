"""What the files of a new catkin package say: its manifest and its CMakeLists.txt. Sources: REP 140 (package.xml), roslisp.md 14.2."""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


KINDS = ("build_depend", "build_export_depend", "exec_depend")


def manifest(name: str, dependencies: Sequence[str], description: str | None = None, kinds: Sequence[str] = KINDS) -> str:
    """The text of ``package.xml``. dependencies: names of packages. description: by default one that says no more than the name.

    kinds: the elements that name each dependency; ``depend`` alone stands for all `KINDS`.
    """
    lines = [
        '<?xml version="1.0"?>',
        '<package format="2">',
        f"  <name>{name}</name>",
        "  <version>0.0.0</version>",
        f"  <description>{description or f'The {name} package'}</description>",
        '  <maintainer email="user@example.org">user</maintainer>',
        "  <license>unknown</license>",
        "  <buildtool_depend>catkin</buildtool_depend>",
    ]
    for kind in kinds:
        lines += [f"  <{kind}>{dependency}</{kind}>" for dependency in dependencies]
    return "\n".join([*lines, "</package>", ""])


def cmake_lists(name: str, dependencies: Sequence[str]) -> str:
    """The text of ``CMakeLists.txt``. Arguments: as for `manifest`."""
    components = " ".join(dependencies)
    return (
        f"cmake_minimum_required(VERSION 3.0.2)\nproject({name})\nfind_package(catkin REQUIRED COMPONENTS {components})\ncatkin_package()\n"
    )
