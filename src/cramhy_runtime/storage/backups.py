"""Replacing a file of which the older version is kept under a second name; both happen, or neither."""

from __future__ import annotations

import os

from .partial_names import PART, forget, part_name


def replace(new, place, backup):
    """Give the file ``new`` the name ``place``, and what was there the name ``backup``, whose file goes. All are in one folder.

    At no moment is there nothing at ``place``. Errors: `OSError`, and then all is as it was.
    """
    older = _second_name(backup)
    try:
        current = _second_name(place)
    except OSError:  # a file system on which a file has one name only
        forget(older)
        return _replace_one_by_one(new, place, backup)
    if current is None:
        forget(older)
        return os.replace(new, place)
    try:
        os.replace(current, backup)
    except BaseException:
        forget(current, older)
        raise
    try:
        os.replace(new, place)
    except BaseException:
        if older is None:
            forget(backup)
        else:
            os.replace(older, backup)
        raise
    forget(older)


def _second_name(path):
    """Another name of the file, or ``None`` if there is no file. Killed in the meantime, it goes as a part does."""
    other = part_name(path, PART)
    try:
        os.link(path, other)
    except FileNotFoundError:
        return None
    return other


def _replace_one_by_one(new, place, backup):
    os.replace(place, backup)
    try:
        os.replace(new, place)
    except BaseException:
        os.replace(backup, place)
        raise
