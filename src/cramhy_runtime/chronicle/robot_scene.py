"""The robot's world as Foxglove draws it, in recordings: a scene of its shapes, and the frames and joints of its robots.

Made of the messages about the world while they are recorded. What a plan did in one instant is told as it was at its end, for Foxglove
shows plan time. Loads MuJoCo's arithmetic, which a session with such a world has.
"""

from __future__ import annotations

import json

from cramhy_runtime.ros.messages import message_class_exact

from .scene import FRAME, entity, time_of

TOPIC, FRAMES_TOPIC, JOINTS_TOPIC = "/cramhy/robot_scene", "/cramhy/robot_frames", "/cramhy/joint_states"
FRAMES_TYPE = "foxglove.FrameTransforms"


class RobotScene:
    """What Foxglove has been told of the robot's world."""

    def __init__(self):
        self.things, self.states, self.joint_names = {}, {}, {}

    def update(self, message, nanoseconds):
        """Because of a ``cramhy_msgs/RobotWorld``: (a scene update or None, frames or None, both plain data; JointStates, a list)."""
        stamp, deletions, changed = time_of(nanoseconds), [], {}
        if message.complete is True:
            self.things, self.states = {}, {}
            deletions.append({"timestamp": stamp, "type": 1, "id": ""})
        for name in message.removed:
            self.things.pop(name, None)
            self.states.pop(name, None)
            deletions.append({"timestamp": stamp, "type": 0, "id": name})
        for thing in message.things:
            self.things[thing.name] = thing
            changed[thing.name] = None
        for step in message.steps:
            for state in step.states:
                if state.name in self.things:
                    self.states[state.name] = state
                    changed[state.name] = None
        names = [name for name in changed if name in self.states]
        placed = {name: self._links(name) for name in names}
        entities = [self._entity(stamp, name, placed[name]) for name in names]
        scene = {"deletions": deletions, "entities": entities} if deletions or entities else None
        robots = [name for name in names if self.things[name].kind == "robot"]
        return scene, self._frames(stamp, robots, placed), [self._joints(stamp, name) for name in robots]

    def _links(self, name):
        """Where the links of a thing are: `Placement` after `Placement`."""
        from ..robot_world.placements import Placement, placement

        state, found = self.states[name], []
        for link in self.things[name].links:
            frame = placement(link.frame[:3], link.frame[3:])
            at = placement(state.pose[:3], state.pose[3:]) if link.parent < 0 else found[link.parent] @ frame
            if link.joint >= 0 and link.joint < len(state.joints):
                at = at @ _gone(Placement, link, state.joints[link.joint])
            found.append(at)
        return found

    def _entity(self, stamp, name, placed):
        from ..robot_world.placements import placement

        shapes = {"cubes": [], "cylinders": [], "spheres": [], "triangles": []}
        for link, at in zip(self.things[name].links, placed):
            for shape in link.shapes:
                pose, size = _pose(at @ placement(shape.frame[:3], shape.frame[3:])), list(shape.size)
                more = {"pose": pose, "color": dict(zip("rgba", shape.colour))}
                if shape.kind == "box":
                    shapes["cubes"].append({**more, "size": dict(zip("xyz", size))})
                elif shape.kind == "cylinder":
                    round_ = {"x": 2 * size[0], "y": 2 * size[0], "z": size[1]}
                    shapes["cylinders"].append({**more, "size": round_, "bottom_scale": 1.0, "top_scale": 1.0})
                elif shape.kind == "sphere":
                    shapes["spheres"].append({**more, "size": dict.fromkeys("xyz", 2 * size[0])})
                elif shape.kind == "mesh":
                    points = [dict(zip("xyz", shape.points[first : first + 3])) for first in range(0, len(shape.points), 3)]
                    shapes["triangles"].append({**more, "points": points, "colors": [], "indices": list(shape.triangles)})
        return entity(stamp, name, **shapes)

    def _frames(self, stamp, robots, placed):
        if not robots:
            return None
        transforms = []
        first = next((name for name, thing in self.things.items() if thing.kind == "robot"), None)
        for name in robots:
            links, before = self.things[name].links, "" if name == first else f"{name}/"
            for link, at in zip(links, placed[name]):
                parent = FRAME if link.parent < 0 else before + links[link.parent].name
                here = at if link.parent < 0 else placed[name][link.parent].inverse() @ at
                pose = _pose(here)
                transforms.append(
                    {
                        "timestamp": stamp,
                        "parent_frame_id": parent,
                        "child_frame_id": before + link.name,
                        "translation": pose["position"],
                        "rotation": pose["orientation"],
                    }
                )
        return {"transforms": transforms}

    def _joints(self, stamp, name):
        made, state = message_class_exact("sensor_msgs/JointState")(), self.states[name]
        made.header.stamp, made.header.frame_id = stamp["sec"] + stamp["nsec"] / 1e9, name
        made.name = [link.name for link in sorted((link for link in self.things[name].links if link.joint >= 0), key=lambda one: one.joint)]
        made.position = list(state.joints)
        return made


def frames_schema_text():
    """The JSON schema of `FRAMES_TYPE`, as bytes of a file."""
    number, text = {"type": "number"}, {"type": "string"}
    moment = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}
    vector, turn = ({"type": "object", "properties": dict.fromkeys(axes, number)} for axes in ("xyz", "xyzw"))
    one = {"timestamp": moment, "parent_frame_id": text, "child_frame_id": text, "translation": vector, "rotation": turn}
    rows = {"type": "array", "items": {"type": "object", "properties": one}}
    return json.dumps({"title": FRAMES_TYPE, "type": "object", "properties": {"transforms": rows}}, separators=(",", ":")).encode()


def _gone(make, link, value):
    """Where a joint has taken its link, from where that is when the joint is at 0."""
    import numpy as np

    axis = np.array(link.axis, float)
    if link.slides is True:
        return make(axis * value, np.array([1.0, 0.0, 0.0, 0.0]))
    return make(np.zeros(3), np.array([np.cos(value / 2), *(axis * np.sin(value / 2))]))


def _pose(placement):
    x, y, z = map(float, placement.position)
    qw, qx, qy, qz = map(float, placement.rotation)
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"x": qx, "y": qy, "z": qz, "w": qw}}
