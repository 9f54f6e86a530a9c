"""The drawing that a turtle shall make, written as a way: ``repeat 4 [ forward :size left 90 ]``.

The words are those of Logo, the language of the first turtle that drew. A number may be a formula without spaces, with values of the
exercise (``:size*2`` or ``size*2``). The way begins at a place and heading, and is drawn where the pen is down.

==================  =====================================================================================
forward N, back N   go on, or back, by N metres
left N, right N     turn on the spot by N degrees
arc R N             go along a circle of radius R metres, N degrees to the left; a negative R: to the right
to X Y              go straight to a place, in metres to the right and up from the beginning; the heading stays
face N              turn to a heading, in degrees from the beginning's
up, down            lift the pen, or put it down
colour R G B        draw in this colour, each from 0 to 255; a way that names a colour asks for it
repeat N [ ... ]    do what is in the brackets N times
==================  =====================================================================================
"""

from __future__ import annotations

import math

from .expressions import computed
from .problems import ExerciseError

PIECE = math.radians(6)
"""An arc becomes straight pieces of so many radians."""
MOST_STEPS = 20_000
_NUMBERS = {"forward": 1, "back": 1, "left": 1, "right": 1, "arc": 2, "to": 2, "face": 1, "up": 0, "down": 0, "colour": 3}


def lines(way, values, begin=(0.0, 0.0, 0.0)):
    """The drawing: a list of (colour or ``None``, [(x, y), ...]), in metres of the world (y up).

    way: the text. values: a dictionary from names to numbers. begin: (x, y, heading) in metres and radians. Raises `ExerciseError`.
    """
    pencil = _Pencil(begin)
    words = way.replace("[", " [ ").replace("]", " ] ").replace(":", "").replace(",", " ").split()
    rest = _draw(words, 0, pencil, values, [0])
    if rest < len(words):
        raise ExerciseError(f"In the way {way!r} a ] closes nothing.")
    pencil.lift()
    return pencil.found


class _Pencil:
    def __init__(self, begin):
        self.begin = begin
        self.x, self.y, self.heading = begin
        self.colour = None
        self.down = True
        self.found, self.points = [], []
        self.lift()

    def lift(self):
        """End the line that is being drawn, and begin another here."""
        if len(self.points) > 1:
            self.found.append((self.colour, self.points))
        self.points = [(self.x, self.y)]

    def go(self, x, y):
        self.x, self.y = x, y
        if self.down:
            self.points.append((x, y))
        else:
            self.points = [(x, y)]

    def forward(self, length):
        self.go(self.x + length * math.cos(self.heading), self.y + length * math.sin(self.heading))

    def back(self, length):
        self.forward(-length)

    def left(self, degrees):
        self.heading += math.radians(degrees)

    def right(self, degrees):
        self.left(-degrees)

    def arc(self, radius, degrees):
        side = math.copysign(math.pi / 2, radius)
        middle = self.x + abs(radius) * math.cos(self.heading + side), self.y + abs(radius) * math.sin(self.heading + side)
        angle = math.radians(degrees) * math.copysign(1, radius)
        pieces = max(math.ceil(abs(angle) / PIECE), 1)
        first = self.heading - side
        for piece in range(1, pieces + 1):
            now = first + angle * piece / pieces
            self.go(middle[0] + abs(radius) * math.cos(now), middle[1] + abs(radius) * math.sin(now))
        self.heading += angle

    def to(self, x, y):
        begin_x, begin_y, heading = self.begin
        cosine, sine = math.cos(heading), math.sin(heading)
        self.go(begin_x + cosine * x - sine * y, begin_y + sine * x + cosine * y)

    def face(self, degrees):
        self.heading = self.begin[2] + math.radians(degrees)

    def up(self):
        self.lift()
        self.down = False

    def down_(self):
        self.lift()
        self.down = True

    def colour_(self, *colour):
        self.lift()
        self.colour = tuple(int(part) for part in colour)


def _draw(words, index, pencil, values, steps):
    """Do what the words say from ``index`` up to a ] or the end; the index of that. steps: a list with how many words were done."""
    while index < len(words) and words[index] != "]":
        steps[0] += 1
        if steps[0] > MOST_STEPS:
            raise ExerciseError(f"A way has more than {MOST_STEPS} steps.")
        word = words[index]
        if word == "repeat":
            index = _repeat(words, index, pencil, values, steps)
            continue
        count = _NUMBERS.get(word)
        if count is None:
            raise ExerciseError(f"A way has no word {word!r}. Its words are {', '.join(_NUMBERS)} and repeat.")
        numbers = words[index + 1 : index + 1 + count]
        if len(numbers) < count:
            raise ExerciseError(f"The word {word} of a way needs {count} numbers behind it.")
        getattr(pencil, word + "_" * (word in ("down", "colour")))(*(computed(number, values) for number in numbers))
        index += 1 + count
    return index


def _repeat(words, index, pencil, values, steps):
    if len(words) < index + 3 or words[index + 2] != "[":
        raise ExerciseError("repeat needs a number and what to repeat: repeat 4 [ forward 2 left 90 ].")
    times, begin = int(computed(words[index + 1], values)), index + 3
    end = _closing(words, begin)
    for _ in range(times):
        _draw(words[:end], begin, pencil, values, steps)
    return end + 1


def _closing(words, index):
    depth = 1
    for place in range(index, len(words)):
        depth += (words[place] == "[") - (words[place] == "]")
        if not depth:
            return place
    raise ExerciseError("A [ of a way is not closed.")
