"""Parameters: the master's tree of values, which are text, numbers, booleans, lists, and dictionaries for the names below.

As with ``roscore``, three are set from the start: the distribution and the version of ROS, and an id of the run.

``roslisp/parameter_values.py`` converts Lisp values. Source: wiki.ros.org/ROS/Parameter_Server_API.
"""

from __future__ import annotations
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator
    from .signatures import Parameter, ParameterValue


DISTRIBUTION, VERSION = "noetic", "1.15.15"


class ParameterTree:
    """Values by global name. A dictionary holds the names below its own."""

    def __init__(self, run: float | None = None):
        """``run``: when the run began, in seconds since 1970, for its id. Without it, the tree is empty."""
        self.root: dict[str, Any] = (
            {} if run is None else {"rosdistro": f"{DISTRIBUTION}\n", "rosversion": f"{VERSION}\n", "run_id": _run_id(run)}
        )

    def get(self, name: str) -> Parameter:
        """The value of the parameter ``name``. Raises `KeyError` if it is not set."""
        value: Any = self.root
        for part in _parts(name):
            if not isinstance(value, dict):
                raise KeyError(name)
            value = value[part]
        return value

    def has(self, name: str) -> bool:
        """Whether the parameter ``name`` is set."""
        try:
            self.get(name)
        except KeyError:
            return False
        return True

    def set(self, name: str, value: ParameterValue) -> None:
        """Set the parameter ``name``; dictionaries on the way are made. The root must be a dictionary, else `TypeError`."""
        parts = _parts(name)
        if not parts:
            if not isinstance(value, dict):
                raise TypeError("cannot set root of parameter tree to non-dictionary")
            self.root = value
            return
        space = self.root
        for part in parts[:-1]:
            below = space.get(part)
            if not isinstance(below, dict):
                below = space[part] = {}
            space = below
        space[parts[-1]] = value

    def delete(self, name: str) -> None:
        """Remove the parameter ``name``. Raises `KeyError` if it is not set. Removing the root empties it."""
        parts = _parts(name)
        if not parts:
            self.root = {}
            return
        space = self.get("/" + "/".join(parts[:-1]))
        if not isinstance(space, dict):
            raise KeyError(name)
        del space[parts[-1]]

    def names(self) -> list[str]:
        """The names of all values that are not dictionaries, sorted."""
        return sorted(_leaves(self.root, ""))


def _run_id(run: float) -> str:
    """A UUID of the time ``run`` (RFC 4122, version 1). The same start gives the same id, so runs in virtual time do not differ."""
    ticks = int(run * 10**7) + 0x01B2_1DD2_1381_4000  # tenths of microseconds, counted from 1582
    return f"{ticks & 0xFFFFFFFF:08x}-{ticks >> 32 & 0xFFFF:04x}-{ticks >> 48 | 0x1000:04x}-8000-010000000000"


def _parts(name: str) -> list[str]:
    return [part for part in name.split("/") if part]


def _leaves(space: dict[str, Any], prefix: str) -> Iterator[str]:
    for key, value in space.items():
        if isinstance(value, dict) and value:
            yield from _leaves(value, f"{prefix}/{key}")
        else:
            yield f"{prefix}/{key}"
