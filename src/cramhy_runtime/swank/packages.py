"""Packages as Emacs shows them."""

from __future__ import annotations


def prompt_of(package):
    """``TUT``: the shortest name of a package, as at the prompt."""
    return min(package.names, key=len)
