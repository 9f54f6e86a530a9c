"""Parameters with the values of Python: they come back as they went in. Source: roslisp.md 8, rospy's ``get_param``.

In Lisp, false and an empty list are both NIL, and a dictionary is a struct (``roslisp/parameter_values.py``).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNSUPPLIED
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from .. import wire
from ..roslisp import parameters

if TYPE_CHECKING:
    from ..signatures import Parameter


def get_param(key: str, default: object = UNSUPPLIED) -> Any:
    """The value of the parameter ``key``: a bool, number, text, list or dict. If it is not set, ``default``, as it is.

    Each call returns lists and dicts of its own. Errors: a parameter that is not set, if there is no default.
    """
    return parameters.value_of(key, default, _copied)


def set_param(key: str, value: object) -> int:
    """Set the parameter ``key`` to a bool, number, text, list or dict; returns 0.

    A tuple becomes a list, and numbers and arrays of numpy become numbers and lists. Errors: a TypeError for None, and for a dict with
    keys that are no texts; a failure for values of other classes, and for an integer that 32 bits cannot hold.
    """
    return parameters.set_param(key, _plain(value, key))


def has_param(key: str) -> bool:
    """Whether the parameter ``key`` is set, even to False."""
    return parameters.has_param(key) is True


def _copied(value: Parameter) -> Any:
    if isinstance(value, (list, tuple)):
        return [_copied(element) for element in value]
    if isinstance(value, dict):
        return {name: _copied(element) for name, element in value.items()}
    return value


def _plain(value: Any, key: object) -> Any:
    if value is None:
        raise TypeError(f"The parameter {key} cannot be None: ROS has no such value. Write False or an empty text, or call delete_param.")
    if isinstance(value, (list, tuple)):
        return [_plain(element, key) for element in value]
    if isinstance(value, dict):
        wrong = next((name for name in value if not isinstance(name, str)), None)
        if wrong is not None:
            raise TypeError(f"The parameter {key} has the name {wrong!r} in a dict. The names of parameters are texts: {str(wrong)!r}.")
        return {name: _plain(element, key) for name, element in value.items()}
    if hasattr(value, "dtype") and hasattr(value, "tolist"):
        return value.tolist()
    return wire.plain(value)
