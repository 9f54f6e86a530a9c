"""A run as an animation: what the things of a world did, each motion for as long as it would take.

While a `Movie` records, it notes the world after each motion (``notes.py``). The frames between two notes are made when the movie is
written, from joints and places in between, so that arms keep their length. Nobody's run is changed by it.

A movie is of the world that is shown when it begins; it goes on with the one that takes its place (`shown.current`).
"""

from __future__ import annotations

from bisect import bisect_left
from itertools import accumulate
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error

from .. import shown
from ..notes import Notes, same, seconds
from ..placements import Placement
from ..things import Item
from .stills import picture, write
from .views import overview

if TYPE_CHECKING:
    from collections.abc import Iterator

    from PIL.Image import Image as Picture

    from ..world import World
    from .views import View

WIDTH, HEIGHT = 400, 300  # pixels
RATE = 10
"""Frames a second."""
MOST_NOTES, MOST_FRAMES = 2000, 900
_REST = 1.0  # seconds for which the last frame stands
_COLOURS = 128
_SHADES = (0.55, 0.75, 1.0)  # of items' colours


class Movie:
    """Records what happens in a world, from `begin` to `end`; `save` writes it. notes: copies of the world, one after each motion.

    most_frames: how many frames it has at most; a longer run is shown faster.
    """

    def __init__(
        self, world: World | None = None, view: View | None = None, width: int = WIDTH, height: int = HEIGHT, most_frames: int = MOST_FRAMES
    ) -> None:
        self._world, self._view, self.width, self.height, self.most_frames = world, view, width, height, most_frames
        self._noted: Notes | None = None

    @property
    def notes(self) -> list[World]:
        return [] if self._noted is None else self._noted.worlds

    def begin(self) -> None:
        """Record from now on. Errors: a simple error, when there is no world."""
        world = self._world or shown.current()
        if world is None:
            error(SimpleError("There is no world to make a movie of."))
        self._noted = Notes(world, MOST_NOTES)
        shown.watch(self._note)

    def end(self) -> None:
        """Record no more."""
        shown.unwatch(self._note)

    def _note(self, world: World) -> None:
        if world is (self._world or shown.current()):
            self._noted.add(world)

    def frames(self) -> Iterator[World]:
        """The worlds that the frames show: the run at even intervals, in `most_frames` of them or less, and its end."""
        steps = [max(1, ceil(seconds(one, other) * RATE)) for one, other in zip(self.notes, self.notes[1:])]
        ends = list(accumulate(steps))
        count = min(sum(steps), self.most_frames)
        yield self.notes[0]
        for number in range(1, count + 1):
            at = number * ends[-1] / count
            motion = bisect_left(ends, at)
            share = 1 - (ends[motion] - at) / steps[motion]
            yield self.notes[motion + 1] if share >= 1 else _between(self.notes[motion], self.notes[motion + 1], share)

    def save(self, path: str, called: str | None = None) -> None:
        """Write the movie to the GIF file ``path``; other tasks may run meanwhile. called: the user's spelling.

        Errors: a file-error, and a simple error for a size that is none.
        """
        called = called or path
        view = self._view or overview(self.notes[0])
        try:
            pictures = [picture(world, view, self.width, self.height, smooth=1) for world in self.frames()]
        except ValueError as problem:
            error(SimpleError("~a", f"The movie {called} cannot be drawn: {problem}"))
        pictures = _with_palette(pictures, self.notes[-1])
        times = [1000 // RATE] * (len(pictures) - 1) + [round(1000 * _REST)]
        write(pictures[0], path, called, "GIF", save_all=True, append_images=pictures[1:], duration=times, loop=0)


def check(path: str, called: str | None = None) -> None:
    """Signal a simple error if the ending of a file's name is not that of a movie. Call it before the run that is to be shown."""
    if not path.lower().endswith(".gif"):
        error(SimpleError("~a", f"What kind of movie is {called or path} to be? The name of a movie of a world ends in .gif."))


def _with_palette(pictures: list[Picture], world: World) -> list[Picture]:
    """The pictures with few colours, the same in all: those of the first and the last, and those of the items, which may be small."""
    from PIL import Image

    both = Image.new("RGB", (pictures[0].width, 2 * pictures[0].height))
    both.paste(pictures[0], (0, 0))
    both.paste(pictures[-1], (0, pictures[0].height))
    common = both.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT).getpalette()[: 3 * _COLOURS]
    special = [
        round(255 * shade * part)
        for colour in dict.fromkeys(item.colour[:3] for item in world.items())
        for shade in _SHADES
        for part in colour
    ]
    palette = Image.new("P", (1, 1))
    palette.putpalette((common + special)[: 3 * 256])
    return [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures]


# -------------------------------------------------------------------------------------------------------------- between two worlds


def _between(one: World, other: World, share: float) -> World:
    """The world on the way from one to the other; what is held is where its holder is."""
    world = one.copy()
    for name, thing in list(world.things.items()):
        goal = other.things.get(name)
        if goal is None:
            continue
        if isinstance(thing, Item):
            if not world.holders(name):
                thing.placement = _blend(thing.placement, goal.placement, share)
            continue
        world.put(name, _blend(thing.placement, goal.placement, share))
        if len(thing.joints) == len(goal.joints):
            joints = thing.joints + (goal.joints - thing.joints) * share
            world.bend(name, dict(zip(thing.skeleton.joints, joints)))
    return world


def _blend(one: Placement, other: Placement, share: float) -> Placement:
    if same(one, other):
        return one
    turn = one.rotation * (1 - share) + other.rotation * (share if one.rotation @ other.rotation >= 0 else -share)
    return Placement(one.position + (other.position - one.position) * share, turn / np.linalg.norm(turn))
