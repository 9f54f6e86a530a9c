"""The history of the paper: the way of each turtle and every stroke with its tick, for a moving picture (`replay`).

A new `History` begins at once to observe its simulator (`Turtlesim.observe`). A turtle at rest takes no memory, a tick of driving
about two hundred bytes. Beyond `MOST_SAMPLES`, the history forgets its older half, except the lines on the paper at that point.
Ticks count from the beginning of the history. A tick means 16 ms of plan time, even if the clock differs.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left

from .strokes import Ink
from .dimensions import EXTENT
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .node import Inhabitant, Turtlesim
    from .signatures import Colour, Era, Sample, Stroke, TimedStroke
    from .world import Turtle


MOST_SAMPLES = 250_000
"""Number of poses, strokes and clears to keep: half an hour of one turtle that draws all the time, thirty megabytes."""
_LOOK = 4096  # ticks between two looks at how many they are


class Track:
    """The way of one turtle, from tick ``begin``, when it appeared, to ``end``, when it left, or ``None`` while it is there."""

    __slots__ = ("turtle", "name", "number", "begin", "end", "ticks", "poses", "last")

    def __init__(self, turtle: Turtle, tick: int):
        self.turtle, self.name, self.number = turtle, turtle.name, turtle.number
        self.begin = tick
        self.end: int | None = None
        self.ticks, self.poses = array("I"), array("d")
        self.last: tuple[float, float, float] | None = None

    def see(self, tick: int) -> None:
        """Note the turtle's pose at ``tick`` if it has changed. If it was at rest before, note that too."""
        turtle = self.turtle
        pose = (turtle.x, turtle.y, turtle.heading)
        if pose == self.last or (turtle.x + turtle.y + turtle.heading) * 0.0 != 0.0:  # one that is nowhere stays where it was seen last
            return
        if self.last is not None and self.ticks[-1] < tick - 1:
            self.ticks.append(tick - 1)
            self.poses.extend(self.last)
        self.ticks.append(tick)
        self.poses.extend(pose)
        self.last = pose

    def samples(self) -> list[Sample]:
        """[(tick, x, y, heading), ...], in metres on the screen and radians. Between two samples, the turtle moves evenly."""
        values = self.poses
        return [(tick, *values[3 * index : 3 * index + 3]) for index, tick in enumerate(self.ticks)]

    def forget(self, cut: int) -> None:
        """Forget the way before tick ``cut``, and count ticks from there."""
        first = max(bisect_left(self.ticks, cut + 1) - 1, 0)  # the last sample before says where the turtle stood
        self.ticks = array("I", (max(tick - cut, 0) for tick in self.ticks[first:]))
        self.poses = self.poses[3 * first :]
        self.begin = max(self.begin - cut, 0)
        self.end = None if self.end is None else self.end - cut


class History:
    """The history of one simulator.

    ``tracks``: the ways of the turtles, as `Track`. ``strokes`` and ``clears``: the events on the paper, each with its tick.
    ``ticks``: how many have passed.
    """

    def __init__(self, simulator: Turtlesim):
        self.simulator = simulator
        self.ticks = 0
        self.tracks: list[Track] = []
        self.there: dict[int, Track] = {}
        self._inhabitants: dict[str, Inhabitant] | None = None
        self.clears: list[tuple[int, Colour]] = [(0, simulator.canvas.background)]  # (tick, background)
        self._cleared = simulator.canvas.clears
        self.strokes: list[TimedStroke] = [
            (0, *stroke) for stroke in simulator.canvas.strokes()
        ]  # (tick, x1, y1, x2, y2, colour, width), y up
        self._note_turtles()
        simulator.observe(self.see)

    def stop(self) -> None:
        """Stop observing the simulator."""
        self.simulator.unobserve(self.see)

    def see(self, simulator: Turtlesim, strokes: list[Stroke]) -> None:
        """Note one tick. It is the callback of `Turtlesim.observe`."""
        self.ticks = tick = self.ticks + 1
        canvas = simulator.canvas
        if canvas.clears != self._cleared:
            self._cleared = canvas.clears
            self.clears.append((tick, canvas.background))
        if simulator.inhabitants is not self._inhabitants:
            self._note_turtles()
        for track in self.there.values():
            track.see(tick)
        if strokes:
            self.strokes.extend([(tick, *stroke) for stroke in strokes])
        if not tick % _LOOK and self._size() > MOST_SAMPLES:
            self._shorten()

    def eras(self) -> list[Era]:
        """[(tick, background, strokes), ...]: the beginning and each clear, with the strokes until the next clear."""
        begins = [bisect_left(self.strokes, (tick,)) for tick, _ in self.clears] + [len(self.strokes)]
        return [(tick, background, self.strokes[begins[index] : begins[index + 1]]) for index, (tick, background) in enumerate(self.clears)]

    def _size(self) -> int:
        return len(self.strokes) + len(self.clears) + sum(len(track.ticks) for track in self.tracks)

    def _shorten(self) -> None:
        """Forget the older half, except the lines on the paper in the middle."""
        cut = self.ticks // 2
        paper = Ink()
        begin = max(index for index, (tick, _) in enumerate(self.clears) if tick <= cut)
        first = bisect_left(self.strokes, (self.clears[begin][0],))
        last = bisect_left(self.strokes, (cut + 1,))
        paper.take([(x2, EXTENT - y2, x1, EXTENT - y1, colour, width) for _, x1, y1, x2, y2, colour, width in self.strokes[first:last]])
        self.strokes = [(0, *stroke) for stroke in paper.strokes()[-MOST_SAMPLES // 4 :]] + [
            (tick - cut, *stroke) for tick, *stroke in self.strokes[last:]
        ]
        self.clears = [(max(tick - cut, 0), background) for tick, background in self.clears[begin:]]
        self.tracks = [track for track in self.tracks if track.end is None or track.end > cut]
        for track in self.tracks:
            track.forget(cut)
        self.ticks -= cut

    def _note_turtles(self) -> None:
        self._inhabitants = self.simulator.inhabitants
        now = {id(inhabitant): inhabitant.turtle for inhabitant in self._inhabitants.values()}
        for key in [key for key in self.there if key not in now]:
            self.there.pop(key).end = self.ticks
        for key, turtle in now.items():
            if key not in self.there:
                track = self.there[key] = Track(turtle, self.ticks)
                track.see(self.ticks)
                self.tracks.append(track)
