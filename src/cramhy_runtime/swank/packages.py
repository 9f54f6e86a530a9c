"""Packages as Emacs shows them."""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import find_package


def prompt_of(package):
    """``TUT``: the shortest name of a package, as at the prompt."""
    return min(package.names, key=len)


def package_called(written):
    """The package that ``written`` means as it stands in a buffer, such as ``:tut`` or ``"TUT"``; ``None`` if there is none."""
    name = written.strip().lstrip("#").lstrip(":").strip('"').strip("|")
    return find_package(name) or find_package(name.upper())
