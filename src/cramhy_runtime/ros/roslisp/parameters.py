"""The functions of roslisp on parameters. They need a known master, but no running node. Source: roslisp.md 8."""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, LispString, list_from
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from .. import graph
from . import master, node
from .errors import close_names, legal, ros_error, rpc_error
from .parameter_values import decode, encode
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..signatures import Text
    from ..parameter_tree import ParameterTree


def _full_name(key: object) -> str:
    if not isinstance(key, (str, LispString)):
        return conditions.type_error(key, "STRING", "\nwhen binding ROSLISP::KEY")
    _require_master()
    return node.fully_qualified_name(legal(str(key), "parameter"))


def _require_master() -> None:
    if master.master_uri() is None:
        conditions.error(SimpleError("Master uri not set"))


def _tree(control: str, *arguments: object) -> ParameterTree:
    """The master's parameters. Another master is the error ``control``, with its address, ``arguments`` and the reason."""
    uri = master.master_uri()
    problem = master.connection_problem(uri)
    if problem is not None:
        ros_error(control, uri, *arguments, problem)
    return graph.active().parameters


def _symbol_name(thing: object) -> str:
    return symbol_name(thing) if is_symbol(thing) else conditions.type_error(thing, "SYMBOL")


def get_param(key: Text, default: object = UNSUPPLIED) -> Any:
    """The value of the parameter ``key``, a string; if it is not set, ``default``, which may be nil.

    Without a default, it is an error, which is logged too.
    """
    return value_of(key, default, decode)


def value_of(key: Text, default: object, decoded: Callable[[Any], Any]) -> Any:
    """What `get_param` returns. ``decoded``: the function that turns a value of the tree into one of the caller's language."""
    name = _full_name(key)
    try:
        return decoded(_tree("Could not contact master~* when getting param ~a: ~a", name).get(name))
    except KeyError:
        if default is not UNSUPPLIED:
            return default
    return ros_error(
        "Param ~a does not exist, and no default supplied",
        name,
        hint=lambda: close_names(
            name,
            graph.active().parameters.names(),
            "(list-params) shows those that there are; a second argument of get-param is a default.",
        ),
    )


def set_param(key: Text, val: object) -> int:
    """Set the parameter ``key``, a string, to ``val``; returns 0. A value without a parameter type is an error."""
    name = _full_name(key)
    tree = _tree("Could not contact master at ~a when setting param ~a", name)
    try:
        tree.set(name, encode(val))
    except TypeError as problem:  # the root, which holds all the others
        rpc_error(f"setParam {name}", -1, str(problem), 0)
    return 0


def has_param(key: Text) -> bool | None:
    """T if the parameter ``key`` is set, even to false; else nil."""
    name = _full_name(key)
    return True if _tree("Could not contact master at ~a for call to hasParam ~a: ~a", name).has(name) else None


def delete_param(key: Text) -> int:
    """Remove the parameter ``key``; returns 0. If it is not set, it is a ``ros-rpc-error``."""
    name = _full_name(key)
    try:
        _tree("Could not contact master at ~a when deleting param ~a: ~a", name).delete(name)
    except KeyError:
        rpc_error(f"deleteParam {name}", -1, f"parameter [{name}] is not set", 0)
    return 0


def list_params(namespace: Text | Cons | None = None) -> Cons | None:
    """The list of parameter names below ``namespace``: a string, a list of symbols ``(foo bar)`` for ``/foo/bar/``, or nil for all."""
    _require_master()
    if namespace is None:
        prefix = "/"
    elif isinstance(namespace, Cons):
        prefix = "/" + "".join(_symbol_name(symbol).lower() + "/" for symbol in namespace)
    else:
        prefix = _full_name(namespace).rstrip("/") + "/"
    names = _tree("Could not contact master at ~a when getting param list: ~a").names()
    return list_from([name for name in names if name.startswith(prefix)])
