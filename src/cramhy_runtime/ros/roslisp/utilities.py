"""``roslisp-utilities``: functions to run at the node's start and end, and conversions between ROS and Lisp names.

Init functions run by descending rank, those of equal rank in the order of registration. Source: roslisp.md 11.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import UNSUPPLIED, LispString, Symbol
from cramhy_runtime.lisp_core.functions import function_named
from cramhy_runtime.lisp_core.packages import intern, is_symbol, sym, symbol_name
from .. import graph
from . import logging, node
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


_init_functions: dict[Symbol, tuple[Callable[[], object], float]] = per_image({})
_cleanup_functions: dict[Symbol, Callable[[], object]] = per_image({})


def register_ros_init_function(symbol: Symbol, rank: float = 0) -> Callable[[], object]:
    """Register the present function of ``symbol`` for `startup_ros`, which runs higher ranks first. Returns the function."""
    function = function_named(symbol)
    _init_functions[symbol] = (function, rank if isinstance(rank, (int, float)) and rank is not True else 0)
    return function


def register_ros_cleanup_function(symbol: Symbol) -> Callable[[], object]:
    """Register the present function of ``symbol`` for `shutdown_ros`. Returns the function."""
    function = _cleanup_functions[symbol] = function_named(symbol)
    return function


def forget_registrations() -> None:
    """Empty both registries, for tests and for a session that starts over."""
    _init_functions.clear()
    _cleanup_functions.clear()


def startup_ros(
    *, master_uri: object = UNSUPPLIED, cmd_line_args: object = UNSUPPLIED, name: str = "cram_hl", anonymous: bool = True
) -> None:
    """Start a node and run the init functions; returns NIL. A running node is shut down first. Arguments: see `start_ros_node`."""
    if graph.active().lisp_node is not None:
        shutdown_ros()
    options = {key: value for key, value in (("master_uri", master_uri), ("cmd_line_args", cmd_line_args)) if value is not UNSUPPLIED}
    node.start_ros_node(name, anonymous=anonymous, **options)
    for function, _ in sorted(_init_functions.values(), key=lambda entry: -entry[1]):
        _announce("ROS init", function)
        function()


def shutdown_ros() -> None:
    """Run the cleanup functions, then shut the node down."""
    for function in list(_cleanup_functions.values()):
        _announce("ROS cleanup", function)
        function()
    return node.shutdown_ros_node()


def _announce(what: str, function: object) -> None:
    logging.ros_log(logging.INFO, intern("ROSNODE", "ROSLISP-UTILITIES"), f"{what} ~a.", function)


# ------------------------------------------------------------------------------------------------------------------- names


def _package(package: Any) -> Any:
    return package if package is not None else sym("*PACKAGE*").value


def _string(thing: object) -> str:
    return str(thing) if isinstance(thing, (str, LispString)) else conditions.type_error(thing, "STRING")


def _symbol_name(thing: object) -> str:
    return symbol_name(thing) if is_symbol(thing) else conditions.type_error(thing, "SYMBOL")


def lispify_ros_name(string: str, package: object = None) -> Symbol:
    """``"HelloWorld"`` → ``HELLO-WORLD``: put a dash before each capital that follows a small letter or a digit.

    The symbol is in ``package``, by default the current one. The empty string is an error.
    """
    text = _string(string)
    if not text:
        return conditions.error("Invalid index 0 for (SIMPLE-ARRAY CHARACTER (0)): the empty string has no Lisp name.")
    parts = [text[0]]
    for before, character in zip(text, text[1:]):
        if character.isupper() and not before.isupper() and before.isalnum():
            parts.append("-")
        parts.append(character)
    return intern("".join(parts).upper(), _package(package))


def rosify_lisp_name(symbol: Symbol) -> str:
    """``HELLO-WORLD`` → ``"HelloWorld"``."""
    return "".join(part.capitalize() for part in _symbol_name(symbol).split("-"))


def lispify_ros_underscore_name(string: str, package: object = None) -> Symbol:
    """``"foo_bar"`` → ``FOO-BAR``, a symbol in ``package``, by default the current one."""
    return intern(_string(string).replace("_", "-").upper(), _package(package))


def rosify_underscores_lisp_name(symbol: Symbol) -> str:
    """``FOO-BAR`` → ``"foo_bar"``; a name with a small letter stays as it is."""
    name = _symbol_name(symbol)
    return name if any(character.islower() for character in name) else name.replace("-", "_").lower()
