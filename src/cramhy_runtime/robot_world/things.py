"""The things of a world: items, which are rigid and fall, and machines, which have joints and stand where they are put.

A thing knows what it is made of and where it is; what happens between things is the world's (``world.py``). A machine is a robot or
furniture: both have a description. Items that a machine holds go with the link that holds them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .placements import Placement

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping
    from typing import Self

    from .descriptions import Description, Shape
    from .skeleton import Skeleton
    from .world import World

Colour = tuple[float, float, float, float]
GREY: Colour = (0.5, 0.5, 0.5, 1.0)


class Thing:
    """What is in a world."""

    lisp_name = "ROBOT-WORLD::THING"
    name: Hashable
    placement: Placement
    world: World | None = None

    def copy(self) -> Self:
        """The same thing at the same place, in no world."""
        new = self.__class__.__new__(self.__class__)
        new.__dict__.update(self.__dict__)
        new.world = None
        return new

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}>"


@dataclass(eq=False, repr=False)
class Item(Thing):
    """A rigid object.

    name: what the world knows it by. shapes: what it is made of, in its own frame. placement: where it is in the world. mass: kilograms; 0
    is for what never moves by itself. types: what it is, the most special first (``("bottle",)``). drawn: it is a drawing only; it touches
    nothing, and hides nothing from a camera. stays: it does not fall, as if it had no mass.
    """

    name: Hashable
    shapes: tuple[Shape, ...]
    placement: Placement
    mass: float = 0.2
    colour: Colour = GREY
    types: tuple[Hashable, ...] = ()
    drawn: bool = False
    stays: bool = False

    def all_shapes(self) -> list[Shape]:
        """What it is made of."""
        return list(self.shapes)


@dataclass
class Grip:
    """That a link holds an item: where the item is in the frame of the link. loose: it does not keep the item from moving with another
    link. grasp: how it is held, as a plan calls it."""

    link: str
    offset: Placement
    loose: bool = False
    grasp: Hashable = None


@dataclass(eq=False, repr=False)
class Machine(Thing):
    """A robot, or furniture.

    name: what the world knows it by. skeleton: computes where its links are. placement: where its root is in the world. joints: their
    positions, in the order of ``skeleton.joints``. holds: the grips of each item that it holds. fixed: it is furniture, which does not
    touch the floor that it stands on, nor other furniture.
    """

    name: Hashable
    skeleton: Skeleton
    placement: Placement
    joints: np.ndarray
    colour: Colour = (0.8, 0.8, 0.8, 1.0)
    holds: dict[Hashable, list[Grip]] = field(default_factory=dict)
    fixed: bool = False
    _links: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def description(self) -> Description:
        return self.skeleton.description

    def copy(self) -> Self:
        """The same machine with the same joints, and with the same grips of what it holds."""
        new = super().copy()
        new.holds = {item: list(grips) for item, grips in self.holds.items()}
        return new

    def all_shapes(self) -> list[Shape]:
        """What all its links are made of."""
        return [shape for link in self.description.links.values() for shape in link.shapes]

    def stand(self, placement: Placement) -> None:
        """Put the root there."""
        self.placement, self._links = placement, None

    def bend(self, values: Mapping[str, float]) -> None:
        """Set the joints of these names, whatever their limits. Errors: KeyError, for a joint that there is not."""
        self.joints, self._links = self.skeleton.positions(values, self.joints), None

    def take(self, numbers: np.ndarray, positions: np.ndarray) -> None:
        """Set joints by their numbers in ``skeleton.joints``."""
        self.joints, self._links = self.joints.copy(), None
        self.joints[numbers] = positions

    def joint(self, name: str) -> float | None:
        """The position of a joint; ``None`` for one that does not move or is not there."""
        number = self.skeleton.joint_numbers.get(name)
        return None if number is None else float(self.joints[number])

    def links(self) -> tuple[np.ndarray, np.ndarray]:
        """(positions, rotations) of all bodies in the world, by the numbers of ``skeleton.links``."""
        if self._links is None:
            self._links = self.skeleton.placed(self.placement, self.joints)
        return self._links

    def link(self, name: str) -> Placement:
        """Where a link is in the world. Errors: KeyError, for a link that there is not."""
        positions, rotations = self.links()
        number = self.skeleton.links[name]
        return Placement(positions[number], rotations[number])
