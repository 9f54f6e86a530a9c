"""MuJoCo's model of a physical world, and one step of it.

Joints that a robot uses are driven by servos, the base by three of its own (along x, along y, about z). All other links of machines stand
where their joints say. Items are free bodies. A servo is a spring with critical damping and a limit of force; gravity of the robot's own
links is compensated, as the PR2's springs do.

Law: `read` writes into the things what the steps moved, `write` takes over where things were put. Neither steps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, cos, isfinite, sin
from typing import TYPE_CHECKING

import numpy as np

from ..descriptions import Frame
from ..mujoco_parts import add_shape, body_name, mujoco
from ..placements import Placement, placement
from ..things import Item, Machine
from .contacts import contact_shapes

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Mapping

    from ..descriptions import Joint
    from ..simulated_robot import RobotParts
    from .trajectory import Trajectory

STEP = 0.008  # seconds
BASE = ("base x", "base y", "base turn")
"""What the three joints of a base are called; no description has such names."""
_STANDING, _ITEM, _ROBOT, _FLOOR = 1, 2, 4, 8  # kinds in MuJoCo's masks of collisions
_DENSITY = 300.0  # kg/m^3 of links whose mass is not told; a PR2 weighs about so much
_STIFF = 30.0  # 1/s, how fast a servo follows
_EFFORT = {"revolute": 30.0, "continuous": 30.0, "prismatic": 10_000.0}  # Nm and N of the PR2's arms and torso, where none is told
_BASE_EFFORT = (2_000.0, 2_000.0, 1_000.0)
_LEVER = 0.1  # metres from a finger's joint to its tip
_WEAK_GRIP = 35.0  # N
_JOINTS = {"prismatic": mujoco.mjtJoint.mjJNT_SLIDE, "revolute": mujoco.mjtJoint.mjJNT_HINGE, "continuous": mujoco.mjtJoint.mjJNT_HINGE}
_STILL = 1e-6  # metres and radians: a base that moves less stands still
_SPEED = 0.02  # metres and radians a second: below it an item is at rest


@dataclass
class _Robot:
    """Where the state of a machine with servos is: its base begins at ``base`` in qpos, its joint ``numbers[i]`` is at ``places[i]``."""

    machine: Machine
    base: int
    places: np.ndarray
    numbers: np.ndarray
    x: float = 0.0
    y: float = 0.0
    turn: float = 0.0
    placement: Placement | None = None  # what was read of the base at last


def used_joints(machine: Machine, parts: RobotParts) -> tuple[list[str], dict[str, str]]:
    """(the joints that servos drive, the joints that go with another one and its name): fingers go with the first of their hand."""
    driven, coupled = [parts.torso, parts.pan, parts.tilt], {}
    for arm in parts.arms.values():
        driven += arm.joints
        if arm.fingers:
            driven.append(arm.fingers[0])
            coupled |= dict.fromkeys(arm.fingers[1:], arm.fingers[0])
    known = machine.skeleton.joint_numbers
    driven = [name for name in dict.fromkeys(driven) if name in known]
    for joint in machine.description.moving_joints.values():
        if joint.mimic in driven and joint.name not in driven:
            coupled[joint.name] = joint.mimic
    return driven, {name: leader for name, leader in coupled.items() if name in known}


class Engine:
    """The model of ``things``; ``robots``: the parts of those machines that servos drive, by their names.

    before: an engine whose servos and trajectories go on. timestep: seconds of one step; a subclass for small things has a shorter one.
    """

    timestep = STEP

    def __init__(self, things: Iterable[Item | Machine], robots: Mapping[Hashable, RobotParts], before: Engine | None = None) -> None:
        self.things, self.robots = list(things), dict(robots)
        self.trajectories: list[tuple[Hashable, Trajectory, np.ndarray]] = []
        self._geom_things: list[tuple[Item | Machine, str | None]] = []
        spec = self._spec()
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._find()
        self.write()
        self._tune()
        if before is not None:
            self._go_on_as(before)

    # ------------------------------------------------------------------------------------------------------------------ model

    def _spec(self) -> mujoco.MjSpec:
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        option = spec.option
        option.timestep, option.integrator, option.cone = (
            self.timestep,
            mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
            mujoco.mjtCone.mjCONE_ELLIPTIC,
        )
        option.impratio = 10  # friction is ten times as stiff as contact, so that what is held does not creep
        has_floor = any(shape.kind == "plane" for thing in self.things for shape in thing.all_shapes())
        height = -1000 if has_floor else 0
        options = {"type": mujoco.mjtGeom.mjGEOM_PLANE, "size": [20, 20, 1], "pos": [0, 0, height], "contype": _FLOOR, "conaffinity": _ITEM}
        self._add_geom(spec, spec.worldbody, None, None, **options)
        for number, thing in enumerate(self.things):
            if isinstance(thing, Item):
                self._add_item(spec, number, thing)
            elif thing.name in self.robots:
                self._add_robot(spec, number, thing)
            else:
                self._add_furniture(spec, thing)
        return spec

    def _add_geom(
        self, spec: mujoco.MjSpec, body: mujoco.MjsBody, thing: Item | Machine | None, link: str | None, shape=None, **options
    ) -> None:
        options["name"] = f"geom {len(self._geom_things)}"
        self._geom_things.append((thing, link))
        if shape is None:
            body.add_geom(**options)
        else:
            add_shape(body, shape, spec, **options)

    def _add_item(self, spec: mujoco.MjSpec, number: int, item: Item) -> None:
        free, shapes = item.mass > 0, contact_shapes(item) if item.mass > 0 else item.shapes
        body = spec.worldbody.add_body(name=f"thing {number}", mocap=not free)
        if free:
            body.add_freejoint()
        volumes = [_volume(shape) for shape in shapes]
        for shape, volume in zip(shapes, volumes, strict=True):
            if shape.kind == "plane":
                masks = {"contype": _FLOOR, "conaffinity": _ITEM}
            elif free:
                masks = {"contype": _ITEM, "conaffinity": _ITEM | _STANDING | _ROBOT | _FLOOR}
            else:
                masks = {"contype": _STANDING, "conaffinity": _ITEM | _ROBOT}
            share = item.mass * volume / sum(volumes) if free else 0.0
            self._add_geom(spec, body, item, None, shape, mass=share, friction=[0.9, 0.01, 0.001], condim=4, **masks)

    def _add_furniture(self, spec: mujoco.MjSpec, machine: Machine) -> None:
        """Add shapes to the world itself, which finds contacts with many shapes of one body fast; they stand where they are now."""
        masks = {"contype": _STANDING, "conaffinity": _ITEM | _ROBOT}
        for link in machine.description.links.values():
            if link.shapes:
                at = machine.link(link.name)
                for shape in link.shapes:
                    placed = at @ placement(shape.frame.position, shape.frame.rotation)
                    moved = replace(shape, frame=Frame(tuple(map(float, placed.position)), tuple(map(float, placed.rotation))))
                    self._add_geom(spec, spec.worldbody, machine, link.name, moved, friction=[0.9, 0.01, 0.001], **masks)

    def _add_robot(self, spec: mujoco.MjSpec, number: int, machine: Machine) -> None:
        description, parts = machine.description, self.robots[machine.name]
        driven, coupled = used_joints(machine, parts)
        hands = {link for arm in parts.arms.values() for link in arm.hand}
        prefix = f"{number} "
        root = spec.worldbody.add_body(name=prefix + body_name(description.root), gravcomp=1)
        root.mass, root.inertia, root.explicitinertial = 50.0, [5.0, 5.0, 5.0], True
        for name, kind, axis in zip(BASE, "ppr", ([1, 0, 0], [0, 1, 0], [0, 0, 1]), strict=True):
            root.add_joint(name=prefix + name, type=_JOINTS["prismatic" if kind == "p" else "revolute"], axis=axis)
        bodies = {description.root: root}
        for name in description.order:
            if name != description.root:
                joint = description.joint_above[name]
                bodies[name] = self._add_link(bodies[joint.parent], prefix, joint, machine, joint.name in driven or joint.name in coupled)
            self._add_shapes(spec, bodies[name], machine, name, name in hands)
        for name in (*BASE, *driven):
            actuator = spec.add_actuator(name=prefix + name, target=prefix + name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            actuator.set_to_position(kp=1.0, kv=1.0)
            actuator.forcelimited, actuator.ctrllimited = True, False
            actuator.forcerange = [-1.0, 1.0]
        for name, leader in coupled.items():
            together = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, name1=prefix + name, name2=prefix + leader)
            together.data[:5] = [0.0, 1.0, 0.0, 0.0, 0.0]
            together.solref = [0.02, 1.0]

    def _add_link(self, parent: mujoco.MjsBody, prefix: str, joint: Joint, machine: Machine, moves: bool) -> mujoco.MjsBody:
        frame = joint.frame
        position, rotation = np.array(frame.position), np.array(frame.rotation)
        if joint.moves and not moves:  # a joint that nothing drives stands as it is
            position, rotation = _bent(position, rotation, joint, machine.joint(joint.name))
        body = parent.add_body(name=prefix + body_name(joint.child), pos=position, quat=rotation, gravcomp=1)
        if moves:
            made = body.add_joint(name=prefix + joint.name, type=_JOINTS[joint.kind], axis=joint.axis, armature=0.005)
            if isfinite(joint.lower) and isfinite(joint.upper):
                made.limited, made.range = True, [joint.lower, joint.upper]
        link = machine.description.links[joint.child]
        if not link.shapes:  # what moves weighs something
            body.mass, body.inertia, body.explicitinertial = max(link.mass, 0.01), [1e-5, 1e-5, 1e-5], True
        return body

    def _add_shapes(self, spec: mujoco.MjSpec, body: mujoco.MjsBody, machine: Machine, name: str, hand: bool) -> None:
        link = machine.description.links[name]
        masks = {"contype": _ROBOT, "conaffinity": _ITEM | _STANDING}
        touch = {"friction": [1.2, 0.02, 0.001], "priority": 1, "condim": 4, "solimp": [0.95, 0.99, 0.001, 0.5, 2]} if hand else {}
        for shape in link.shapes:
            weight = {"mass": link.mass / len(link.shapes)} if link.mass else {"density": _DENSITY}
            self._add_geom(spec, body, machine, name, shape, **masks, **touch, **weight)

    def _find(self) -> None:
        """Where the state of each thing is in MuJoCo's arrays."""
        model = self.model
        self._of_geom: list[tuple[Item | Machine | None, str | None]] = [(None, None)] * model.ngeom
        for number, meant in enumerate(self._geom_things):
            self._of_geom[model.geom(f"geom {number}").id] = meant
        self._items: list[tuple[Item, int, int, int]] = []  # thing, mocap or -1, start in qpos, start in qvel
        self.servos: dict[Hashable, dict[str, int]] = {}
        self._joints: dict[Hashable, dict[str, int]] = {}  # places in qpos
        for number, thing in enumerate(self.things):
            if isinstance(thing, Item):
                body = model.body(f"thing {number}")
                mocap = int(model.body_mocapid[body.id])
                joint = int(body.jntadr[0])
                at = (-1, -1) if mocap >= 0 else (int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint]))
                self._items.append((thing, mocap, *at))
            elif thing.name in self.robots:
                driven, coupled = used_joints(thing, self.robots[thing.name])
                self._joints[thing.name] = {name: int(model.joint(f"{number} {name}").qposadr[0]) for name in (*BASE, *driven, *coupled)}
                self.servos[thing.name] = {name: model.actuator(f"{number} {name}").id for name in (*BASE, *driven)}
        self._read_from = []
        for machine in self.things:
            joints = dict(self._joints.get(machine.name, {}))
            if joints:
                base, *_ = [joints.pop(name) for name in BASE]  # one behind the other
                numbers = [machine.skeleton.joint_numbers[name] for name in joints]
                self._read_from.append(_Robot(machine, base, np.array([*joints.values()], int), np.array(numbers, int)))
        self._falling = [(item, start) for item, mocap, start, _ in self._items if mocap < 0]
        self._free = np.array([start + axis for _, mocap, _, start in self._items if mocap < 0 for axis in range(6)], int)

    def _tune(self) -> None:
        """Give the servos stiffness and damping for what hangs on them, and their limits of force."""
        model, data = self.model, self.data
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        for thing in self.things:
            for name, servo in self.servos.get(thing.name, {}).items():
                dof = int(model.jnt_dofadr[model.actuator_trnid[servo, 0]])
                hand = name in self._fingers(thing.name)
                stiff = 20.0 if hand else max(mass[dof, dof], 0.05) * _STIFF**2
                damping = 0.5 if hand else 2 * max(mass[dof, dof], 0.05) * _STIFF
                model.actuator_gainprm[servo, 0] = stiff
                model.actuator_biasprm[servo, :3] = 0.0, -stiff, -damping
                if name in BASE:
                    effort = _BASE_EFFORT[BASE.index(name)]
                else:
                    joint = thing.description.joints[name]
                    effort = joint.effort if isfinite(joint.effort) and joint.effort > 0 else _EFFORT[joint.kind]
                if hand:
                    effort = 2 * _LEVER * _WEAK_GRIP
                model.actuator_forcerange[servo] = -effort, effort

    def _fingers(self, name: Hashable) -> set[str]:
        return {arm.fingers[0] for arm in self.robots[name].arms.values() if arm.fingers}

    # ------------------------------------------------------------------------------------------------------------------ state

    def write(self, only: Item | Machine | None = None) -> None:
        """Take over where things are, at rest; by default all of them. Servos hold robots there."""
        model, data = self.model, self.data
        for item, mocap, start, speed in self._items:
            if only in (None, item):
                if mocap >= 0:
                    data.mocap_pos[mocap], data.mocap_quat[mocap] = item.placement
                else:
                    data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = item.placement
                    data.qvel[speed : speed + 6] = 0
        for machine in self.things:
            if machine.name in self._joints and only in (None, machine):
                self._write_robot(machine)
        mujoco.mj_kinematics(model, data)

    def _write_robot(self, machine: Machine) -> None:
        model, data = self.model, self.data
        x, y, z = machine.placement.position
        model.body_pos[model.jnt_bodyid[self._joint_number(machine, BASE[0])], 2] = z
        now = dict(zip(BASE, (x, y, yaw_of(machine.placement)), strict=True))
        for name, place in self._joints[machine.name].items():
            wanted = now[name] if name in now else machine.joint(name)
            servo = self.servos[machine.name].get(name)
            if servo is not None and wanted != data.qpos[place]:  # a hand that grips goes on gripping when a shoulder is put elsewhere
                data.ctrl[servo] = wanted
            data.qpos[place] = wanted
            data.qvel[model.jnt_dofadr[self._joint_number(machine, name)]] = 0

    def _joint_number(self, machine: Machine, name: str) -> int:
        return int(self.model.joint(f"{self.things.index(machine)} {name}").id)

    def read(self) -> None:
        """Write into the things where they are now. One copy has it all: what is done between steps is slow, since they fill the caches."""
        now = self.data.qpos.copy()
        for item, start in self._falling:
            item.placement = Placement(now[start : start + 3], now[start + 3 : start + 7])
        for robot in self._read_from:
            x, y, turn = now[robot.base : robot.base + 3].tolist()
            if robot.machine.placement is not robot.placement or abs(x - robot.x) + abs(y - robot.y) + abs(turn - robot.turn) > _STILL:
                robot.x, robot.y, robot.turn = x, y, turn
                height = robot.machine.placement.position[2]
                robot.placement = Placement(np.array([x, y, height]), np.array([cos(turn / 2), 0.0, 0.0, sin(turn / 2)]))
                robot.machine.stand(robot.placement)
            robot.machine.take(robot.numbers, now[robot.places])

    def _go_on_as(self, before: Engine) -> None:
        for name, servos in self.servos.items():
            for joint, servo in servos.items():
                old = before.servos.get(name, {}).get(joint)
                if old is not None:
                    self.data.ctrl[servo] = before.data.ctrl[old]
                    self.model.actuator_forcerange[servo] = before.model.actuator_forcerange[old]
        for name, trajectory, _ in before.trajectories:
            if name in self.servos:
                self.follow(name, trajectory)

    def follow(self, name: Hashable, trajectory: Trajectory) -> None:
        """Let the servos of a machine go along a trajectory."""
        self.trajectories.append((name, trajectory, np.array([self.servos[name][joint] for joint in trajectory.joints], int)))

    def leave(self, trajectory: Trajectory) -> None:
        """Let them hold what they have reached."""
        self.trajectories = [entry for entry in self.trajectories if entry[1] is not trajectory]

    def joint(self, name: Hashable, joint: str) -> float:
        """The position of a joint that a servo drives, or of the base."""
        return float(self.data.qpos[self._joints[name][joint]])

    def speed(self, name: Hashable, joint: str) -> float:
        """The velocity of such a joint."""
        return float(self.data.qvel[self.model.jnt_dofadr[self.model.actuator_trnid[self.servos[name][joint], 0]]])

    def set_force(self, name: Hashable, joint: str, newtons: float) -> None:
        """How strongly a gripper's servo may press, at the tips of its fingers."""
        effort = 2 * _LEVER * newtons
        self.model.actuator_forcerange[self.servos[name][joint]] = -effort, effort

    # ------------------------------------------------------------------------------------------------------------------ steps

    def step(self, seconds: float) -> None:
        """Let so much time pass."""
        model, data, step = self.model, self.data, mujoco.mj_step
        count = max(1, round(seconds / self.timestep))
        going = [(trajectory, servos) for _, trajectory, servos in self.trajectories if not trajectory.done]
        if not going:
            step(model, data, count)
            return
        ctrl = data.ctrl
        for _ in range(count):
            for trajectory, servos in going:
                ctrl[servos] = trajectory.after(self.timestep)
            step(model, data)

    def at_rest(self) -> bool:
        """Whether no item moves."""
        if not len(self._free):
            return True
        speeds = self.data.qvel[self._free]
        return max(float(speeds.max()), -float(speeds.min())) < _SPEED

    def touching(self, thing: Item | Machine) -> list[tuple[str | None, Item | Machine | None, str | None]]:
        """The contacts of a thing now: (its link, the other thing or ``None`` for the floor, the other link)."""
        found = []
        for first, second in self.data.contact.geom[: self.data.ncon]:
            one, other = self._of_geom[first], self._of_geom[second]
            if one[0] is thing:
                found.append((one[1], *other))
            elif other[0] is thing:
                found.append((other[1], *one))
        return list(dict.fromkeys(found))


def yaw_of(at: Placement) -> float:
    """How far something is turned about the vertical, radians."""
    w, x, y, z = map(float, at.rotation)
    return atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def _bent(position: np.ndarray, rotation: np.ndarray, joint: Joint, value: float) -> tuple[np.ndarray, np.ndarray]:
    turned, moved, axis = np.zeros(4), np.zeros(3), np.array(joint.axis)
    if joint.kind == "prismatic":
        mujoco.mju_rotVecQuat(moved, axis * value, rotation)
        return position + moved, rotation
    turn = np.zeros(4)
    mujoco.mju_axisAngle2Quat(turn, axis, value)
    mujoco.mju_mulQuat(turned, rotation, turn)
    return position, turned


def _volume(shape) -> float:
    if shape.kind == "box":
        return float(np.prod(shape.size))
    if shape.kind == "cylinder":
        return float(np.pi * shape.size[0] ** 2 * shape.size[1])
    if shape.kind == "sphere":
        return float(4 / 3 * np.pi * shape.size[0] ** 3)
    return 1e-3
