"""A run as an animation: what the things of a world did, each motion for as long as it would take.

While a `Movie` records, it notes the world after each motion: the motions of projection take no time, and what a plan does in one instant
shall be seen one after the other. Changes of different joints that follow each other are one motion. The frames between two notes are made
when the movie is written, from joints and places in between, so that arms keep their length. Nobody's run is changed by it.

A movie is of the world that is shown when it begins; it goes on with the one that takes its place (`shown.current`).
"""

from __future__ import annotations

from bisect import bisect_left
from itertools import accumulate
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.ground.condition_types import SimpleError
from cramhy_runtime.ground.conditions import error

from .. import shown
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
_BASE, _TURN, _JOINT = 1.0, 1.5, 1.2  # m/s, rad/s: how fast things seem to go
_LEAST, _LONGEST = 0.2, 2.0  # seconds of a motion
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
        self.notes: list[World] = []
        self._touched: set = set()

    def begin(self) -> None:
        """Record from now on. Errors: a simple error, when there is no world."""
        world = self._world or shown.current()
        if world is None:
            error(SimpleError("There is no world to make a movie of."))
        self.notes.append(world.copy())
        shown.watch(self._note)

    def end(self) -> None:
        """Record no more."""
        shown.unwatch(self._note)

    def _note(self, world: World) -> None:
        if world is not (self._world or shown.current()):
            return
        now = world.copy()
        moved = set(_moved(self.notes[-1], now))
        if not moved:
            return
        if self._touched and self._together(moved):
            self.notes[-1] = now
            self._touched |= moved
        else:
            self.notes.append(now)
            self._touched = moved
        if len(self.notes) > MOST_NOTES:
            del self.notes[1:-1:2]

    def _together(self, moved: set) -> bool:
        """Whether what has ``moved`` can be shown as one motion with what the last note shows."""
        return not moved & self._touched and {kind for kind, *_ in moved | self._touched} == {"joint"}

    def frames(self) -> Iterator[World]:
        """The worlds that the frames show: the run at even intervals, in `most_frames` of them or less, and its end."""
        steps = [max(1, ceil(_seconds(one, other) * RATE)) for one, other in zip(self.notes, self.notes[1:])]
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


def _moved(one: World, other: World) -> Iterator[tuple]:
    """What differs: ("item", name), ("root", name), ("joint", name, number), ("things",)."""
    if one.things.keys() != other.things.keys():
        yield ("things",)
    held = {item for machine in other.machines() for item in machine.holds}
    for name, now in other.things.items():
        before = one.things.get(name)
        if before is None:
            continue
        if isinstance(now, Item):
            if name not in held and not _same(before.placement, now.placement):
                yield ("item", name)
            continue
        if not _same(before.placement, now.placement):
            yield ("root", name)
        if before.joints is not now.joints and len(before.joints) == len(now.joints):
            yield from (("joint", name, int(number)) for number in np.flatnonzero(before.joints != now.joints))


def _same(one: Placement, other: Placement) -> bool:
    return one is other or (np.array_equal(one.position, other.position) and np.array_equal(one.rotation, other.rotation))


def _seconds(one: World, other: World) -> float:
    """How long the motion from one world to the other seems to take."""
    longest = _LEAST
    for name, now in other.things.items():
        before = one.things.get(name)
        if before is None:
            continue
        turn = 2 * float(np.arccos(np.clip(abs(before.placement.rotation @ now.placement.rotation), 0, 1)))
        longest = max(longest, float(np.linalg.norm(now.placement.position - before.placement.position)) / _BASE, turn / _TURN)
        if not isinstance(now, Item) and len(before.joints) == len(now.joints):
            longest = max(longest, float(np.abs(now.joints - before.joints).max(initial=0.0)) / _JOINT)
    return min(longest, _LONGEST)


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
    if _same(one, other):
        return one
    turn = one.rotation * (1 - share) + other.rotation * (share if one.rotation @ other.rotation >= 0 else -share)
    return Placement(one.position + (other.position - one.position) * share, turn / np.linalg.norm(turn))
