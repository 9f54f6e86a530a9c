"""Comparing all submissions of a folder with each other.

What two submissions have in common is weighed: a list by the number of its words beside those of lists in it, and less if many
submissions have it, because then it was in the lecture. The measure of a pair is the common weight beside the weight of the smaller one.
"""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

from ..harmless import harmless
from ..problems import ExerciseError
from .shapes import Shape, shapes_of

ENDINGS = (".lisp", ".hy", ".py")
COMMON = 0.5
"""A list that more than this share of the submissions have says nothing about two of them. Small folders: at least five."""
SHOWN = 5
MOST_HEAD = 100
"""Characters of the first words of a list, which may be as long as a program likes."""
LARGEST = 500_000


class Part(NamedTuple):
    """A common part: file and line of the one, of the other, the first words, and the number of words."""

    one: str
    other: str
    head: str
    words: int


class Pair(NamedTuple):
    """Two submissions, the share that is alike (0 to 1), and the largest common parts."""

    one: str
    other: str
    share: float
    parts: list[Part]


class _Submission(NamedTuple):
    name: str
    shapes: dict[str, tuple[str, Shape]]


def similar_pairs(folder, given=None, least=0.4):
    """The pairs with at least the share ``least`` in common, the most alike first. Raises `ExerciseError`.

    folder: has a file or a folder for each submission. given: a folder or file with what all were given, or ``None``.
    """
    submissions = _submissions(Path(folder))
    if len(submissions) < 2:
        raise ExerciseError(f"In {folder} there are no two submissions. It needs a file or a folder for each, with {', '.join(ENDINGS)}.")
    known = {mark for each in _submissions(Path(given), True) for mark in each.shapes} if given is not None else set()
    owners = {}
    for each in submissions:
        for mark in each.shapes:
            owners[mark] = owners.get(mark, 0) + 1
    most = max(len(submissions) * COMMON, 5)
    counted = [
        _Submission(each.name, {mark: found for mark, found in each.shapes.items() if mark not in known and owners[mark] <= most})
        for each in submissions
    ]
    pairs = [_compared(one, other, owners) for one, other in combinations(counted, 2)]
    return sorted((pair for pair in pairs if pair.share and pair.share >= least), key=lambda pair: (-pair.share, pair.one, pair.other))


def _submissions(folder, together=False):
    if folder.is_file():
        return [_submission(folder.name, [folder])]
    if not folder.is_dir():
        raise ExerciseError(f"There is no folder {folder}.")
    if together:
        return [_submission(folder.name, sorted(path for path in folder.rglob("*") if path.suffix in ENDINGS))]
    found = []
    for place in sorted(folder.iterdir()):
        paths = sorted(path for path in place.rglob("*") if path.suffix in ENDINGS) if place.is_dir() else [place]
        paths = [path for path in paths if path.suffix in ENDINGS and "__pycache__" not in path.parts]
        if paths:
            found.append(_submission(place.name, paths))
    return found


def _submission(name, paths):
    shapes = {}
    for path in paths:
        try:
            if not path.is_file() or path.stat().st_size > LARGEST:
                continue
            text = path.read_text(encoding="utf-8", errors="replace")
        except OSError:  # it may not be read, or it is gone
            continue
        for mark, shape in shapes_of(text, path.name).items():
            shapes.setdefault(mark, (path.name, shape))
    return _Submission(name, shapes)


def _compared(one, other, owners):
    common = one.shapes.keys() & other.shapes.keys()
    smaller = min(_weight(each.shapes.values(), owners) for each in (one, other))
    share = _weight((one.shapes[mark] for mark in common), owners) / smaller if smaller else 0.0
    largest = sorted(common, key=lambda mark: (-one.shapes[mark][1].size, one.shapes[mark][1].line, mark))
    parts, covered = [], []
    for mark in largest:
        (file, shape), (file_of_other, shape_of_other) = one.shapes[mark], other.shapes[mark]
        if any(file == name and begin <= shape.line and shape.size < size for name, begin, size in covered) and len(parts) >= 1:
            continue  # it is in one that is listed, or too near to it to tell more
        covered.append((file, shape.line, shape.size))
        places = [harmless(f"{name}:{line}") for name, line in ((file, shape.line), (file_of_other, shape_of_other.line))]
        parts.append(Part(*places, harmless(shape.head)[:MOST_HEAD], shape.size))
    return Pair(harmless(one.name), harmless(other.name), round(min(share, 1.0), 3), parts[:SHOWN])


def _weight(shapes, owners):
    return sum(shape.size**0.5 / (owners[shape.mark] - 1 or 1) for _, shape in shapes)


def as_text(pairs):
    """The pairs for people."""
    if not pairs:
        return "No two submissions are alike.\n"
    lines = []
    for pair in pairs:
        lines.append(f"{pair.share:4.0%}  {pair.one}  {pair.other}")
        lines += [f"        {part.one}  {part.other}  {part.head}, {part.words} words" for part in pair.parts]
    return "\n".join(lines) + "\n"


def as_json(pairs):
    """The pairs as JSON."""
    return json.dumps([{**pair._asdict(), "parts": [part._asdict() for part in pair.parts]} for pair in pairs], indent=2) + "\n"
