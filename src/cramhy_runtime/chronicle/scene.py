"""The turtles' world as Foxglove draws it: ``foxglove.SceneUpdate``, the type that its 3D panel shows without any setting.

Made of the messages about the world while they are recorded: the paper as a plate, turtles as arrows in the colours of their pens, lines
as lines. Foxglove keeps what it was told under a name until that is told anew or deleted, so what was drawn is told once, in pieces of a
quarter of a second, and the turtles twenty times a second.
"""

from __future__ import annotations

import json
import math

from cramhy_runtime.ros.message_json import float_texts, text_of
from cramhy_runtime.turtlesim.dimensions import EXTENT, METRE

TOPIC, TYPE = "/cramhy/scene", "foxglove.SceneUpdate"
FRAME = "world"
INK_PERIOD, TURTLE_PERIOD = 0.25, 0.05
"""Seconds of the plan between two messages with lines, and with turtles."""
_FLAT = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
_SHAPES = ("arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models")


class Scene:
    """What Foxglove has been told. `update` gives what is to be told because of a ``cramhy_msgs/World``, its JSON, or ``None``."""

    def __init__(self):
        self.clears = None
        self.pieces = 0
        self.turtles = {}
        self.waiting = []
        self.ink_time = self.turtle_time = -math.inf

    def update(self, world, nanoseconds):
        entities, deletions = [], []
        if world.complete or world.clears != self.clears:
            self.clears, self.waiting, self.turtles = world.clears, [], {}
            self.turtle_time = -math.inf
            deletions.append({"timestamp": time_of(nanoseconds), "type": 1, "id": ""})
            entities.append(text_of(entity(time_of(nanoseconds), "paper", cubes=[_paper(world)])))
        self.waiting += world.strokes
        if self.waiting and world.stamp - self.ink_time >= INK_PERIOD:
            entities.append(self._ink(time_of(nanoseconds), world.stamp))
        if world.stamp - self.turtle_time >= TURTLE_PERIOD or not world.strokes:  # a turtle that came to rest is told where
            self.turtle_time = world.stamp
            here = {turtle.name: _turtle(turtle) for turtle in world.turtles if math.isfinite(turtle.x + turtle.y + turtle.theta)}
            stamp = time_of(nanoseconds)
            deletions += [{"timestamp": stamp, "type": 0, "id": f"turtle {name}"} for name in self.turtles if name not in here]
            moved = {name: arrow for name, arrow in here.items() if arrow != self.turtles.get(name)}
            entities += [_TURTLE % (text_of(stamp), text_of(f"turtle {name}"), *arrow) for name, arrow in moved.items()]
            self.turtles = here
        return _update_text(entities, deletions) if deletions or entities else None

    def rest(self, nanoseconds):
        """The lines that have not been told yet."""
        return _update_text([self._ink(time_of(nanoseconds), math.inf)]) if self.waiting else None

    def _ink(self, stamp, now):
        """The text of an entity with the lines that wait. They are many, so their points are written without plain data in between."""
        pens, number = {}, float_texts
        for stroke in self.waiting:
            x1, y1, x2, y2 = stroke.x1, stroke.y1, stroke.x2, stroke.y2
            pens.setdefault((stroke.r, stroke.g, stroke.b, stroke.width), []).append(
                _TWO_POINTS % (number[x1], number[y1], number[x2], number[y2])
            )
        self.waiting, self.ink_time = [], now
        self.pieces += 1
        lines = [
            {
                "type": 2,
                "pose": _pose(0.0, 0.0, 0.0),
                "thickness": (width or 1) / METRE,
                "scale_invariant": False,
                "points": [],
                "color": _colour(*colour),
                "colors": [],
                "indices": [],
            }
            for *colour, width in pens
        ]
        before, *rest = text_of(entity(stamp, f"ink {self.pieces}", lines=lines)).split('"points":[]')
        return before + "".join([f'"points":[{",".join(points)}]{after}' for points, after in zip(pens.values(), rest)])


_TWO_POINTS = '{"x":%s,"y":%s,"z":0.0},{"x":%s,"y":%s,"z":0.0}'


def _update_text(entities, deletions=()):
    return f'{{"deletions":{text_of(deletions) if deletions else "[]"},"entities":[{",".join(entities)}]}}'


def time_of(nanoseconds):
    """A time as Foxglove's messages have it."""
    return {"sec": nanoseconds // 1_000_000_000, "nsec": nanoseconds % 1_000_000_000}


def entity(stamp, name, **shapes):
    """A ``foxglove.SceneEntity`` of these shapes."""
    return {
        "timestamp": stamp,
        "frame_id": FRAME,
        "id": name,
        "lifetime": {"sec": 0, "nsec": 0},
        "frame_locked": True,
        "metadata": [],
        **{shape: shapes.get(shape, []) for shape in _SHAPES},
    }


def _pose(x, y, z, turn=_FLAT):
    return {"position": {"x": x, "y": y, "z": z}, "orientation": turn}


def _colour(r, g, b):
    return {"r": r / 255, "g": g / 255, "b": b / 255, "a": 1.0}


def _paper(world):
    return {
        "pose": _pose(EXTENT / 2, EXTENT / 2, -0.02),
        "size": {"x": EXTENT, "y": EXTENT, "z": 0.02},
        "color": _colour(world.r, world.g, world.b),
    }


def _turtle(turtle):
    """The texts of what differs between the arrows of turtles, in the order of `_TURTLE`."""
    half, number = turtle.theta / 2, float_texts
    return (
        number[turtle.x],
        number[turtle.y],
        number[math.sin(half)],
        number[math.cos(half)],
        number[turtle.r / 255],
        number[turtle.g / 255],
        number[turtle.b / 255],
    )


def _turtle_text():
    """The text of the entity of a turtle, with ``%s`` for the texts of its time and name, and of its `_turtle`."""
    given = "?"
    arrow = {
        "pose": _pose(given, given, 0.1, {"x": 0.0, "y": 0.0, "z": given, "w": given}),
        "shaft_length": 0.35,
        "shaft_diameter": 0.35,
        "head_length": 0.25,
        "head_diameter": 0.5,
        "color": {"r": given, "g": given, "b": given, "a": 1.0},
    }
    return text_of(entity(given, given, arrows=[arrow])).replace(f'"{given}"', "%s")


_TURTLE = _turtle_text()


# ------------------------------------------------------------------------------------------------------------------- schema


def _object(**properties):
    return {"type": "object", "properties": properties}


def _array(items):
    return {"type": "array", "items": items}


def schema_text():
    """The JSON schema of `TYPE`, as far as it is used here, as bytes of a file."""
    number, integer, text, truth = ({"type": kind} for kind in ("number", "integer", "string", "boolean"))
    moment, vector = _object(sec=integer, nsec=integer), _object(x=number, y=number, z=number)
    pose = _object(position=vector, orientation=_object(x=number, y=number, z=number, w=number))
    colour = _object(r=number, g=number, b=number, a=number)
    arrow = _object(pose=pose, shaft_length=number, shaft_diameter=number, head_length=number, head_diameter=number, color=colour)
    line = _object(
        type=integer,
        pose=pose,
        thickness=number,
        scale_invariant=truth,
        points=_array(vector),
        color=colour,
        colors=_array(colour),
        indices=_array(integer),
    )
    shapes = {shape: _array({"type": "object"}) for shape in _SHAPES}
    shapes.update(arrows=_array(arrow), lines=_array(line), cubes=_array(_object(pose=pose, size=vector, color=colour)))
    entity = _object(
        timestamp=moment,
        frame_id=text,
        id=text,
        lifetime=moment,
        frame_locked=truth,
        metadata=_array(_object(key=text, value=text)),
        **shapes,
    )
    deletion = _object(timestamp=moment, type=integer, id=text)
    made = {"title": TYPE, **_object(deletions=_array(deletion), entities=_array(entity))}
    return json.dumps(made, separators=(",", ":")).encode()
