"""Parameters: the tree of values that the master keeps, and roslisp's functions on it.

Values are kept as Python's: text, numbers, booleans, lists, dictionaries. On the way back to Lisp a float is a single-float,
a list is a list, false is NIL (roslisp.md 8). The functions need no running node, only a known master.
"""

from __future__ import annotations

from fractions import Fraction

from ..lisp import conditions
from ..lisp.condition_types import SimpleError, shown
from ..lisp.data import UNSUPPLIED, Cons, LispString, Symbol, list_from
from ..lisp.packages import symbol_name
from . import names
from .errors import ros_error, rpc_error


class ParameterTree:
    """Values by global name; a dictionary stands for the names below it."""

    def __init__(self):
        self.root = {}

    def get(self, name):
        """The value, or `KeyError`."""
        value = self.root
        for part in _parts(name):
            if not isinstance(value, dict):
                raise KeyError(name)
            value = value[part]
        return value

    def has(self, name):
        try:
            self.get(name)
        except KeyError:
            return False
        return True

    def set(self, name, value):
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

    def delete(self, name):
        """Remove the value, or `KeyError`. The root cannot go, but it can be emptied."""
        parts = _parts(name)
        if not parts:
            self.root = {}
            return
        space = self.get("/" + "/".join(parts[:-1]))
        if not isinstance(space, dict):
            raise KeyError(name)
        del space[parts[-1]]

    def names(self):
        """The names of all values that are no dictionaries, sorted."""
        return sorted(_leaves(self.root, ""))


def _parts(name):
    return [part for part in name.split("/") if part]


def _leaves(space, prefix):
    for key, value in space.items():
        if isinstance(value, dict) and value:
            yield from _leaves(value, f"{prefix}/{key}")
        else:
            yield f"{prefix}/{key}"


def encode(value):
    """A Lisp value as the master keeps it: symbols become their names, lists and vectors arrays."""
    if value is None or value is False:
        return False
    if value is True or isinstance(value, (int, str)):
        return value
    if isinstance(value, LispString):
        return str(value)
    if isinstance(value, (float, Fraction)):
        return float(value)
    if isinstance(value, Symbol):
        return symbol_name(value)
    if isinstance(value, (Cons, list, tuple)):
        return [encode(element) for element in value]
    if isinstance(value, dict):
        return {str(key): encode(element) for key, element in value.items()}
    return conditions.error(
        SimpleError("~a", f"A parameter can be a string, number, boolean, list or vector of these, but not {shown(value)}.")
    )


def decode(value):
    """A value of the master as Lisp sees it."""
    if value is False:
        return None
    if isinstance(value, (list, tuple)):
        return list_from([decode(element) for element in value])
    return value


def _tree():
    from . import graph

    return graph.active().parameters


def _full_name(key):
    from . import node

    if not isinstance(key, (str, LispString)):
        return conditions.type_error(key, "STRING", "\nwhen binding ROSLISP::KEY")
    if node.master_uri() is None:
        return conditions.error(SimpleError("Master uri not set"))
    return node.fully_qualified_name(str(key))


def get_param(key, default=UNSUPPLIED):
    """The value of the parameter; ``default`` (nil counts) when it is not set; else an error that is logged too."""
    name = _full_name(key)
    try:
        return decode(_tree().get(name))
    except KeyError:
        if default is not UNSUPPLIED:
            return default
    return ros_error("Param ~a does not exist, and no default supplied", name)


def set_param(key, val):
    """Set the parameter; 0."""
    _tree().set(_full_name(key), encode(val))
    return 0


def has_param(key):
    """T when the parameter is set, even to false."""
    return True if _tree().has(_full_name(key)) else None


def delete_param(key):
    """Remove the parameter; 0. One that is not set is a ``ros-rpc-error``."""
    name = _full_name(key)
    try:
        _tree().delete(name)
    except KeyError:
        return rpc_error(f"deleteParam {name}", -1, f"parameter [{name}] is not set", 0)
    return 0


def list_params(namespace=None):
    """The list of the names below a namespace: a string, or a list of symbols ``(foo bar)`` for ``/foo/bar/``."""
    if namespace is None:
        prefix = "/"
    elif isinstance(namespace, Cons):
        prefix = "/" + "".join(symbol_name(symbol).lower() + "/" for symbol in namespace)
    else:
        prefix = _full_name(namespace).rstrip("/") + "/"
    return list_from([name for name in _tree().names() if name.startswith(prefix)])


def upload(node):
    """Set the private parameters of the node's command line."""
    for name, value, _ in reversed(node.naming.private_parameters):
        node.graph.parameters.set(names.qualify(name, node.naming.namespace, node.name), encode(value))
