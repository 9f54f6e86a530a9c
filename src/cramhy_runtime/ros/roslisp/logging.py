"""Logging as in roslisp: levels per topic, a line on standard output, and a message on ``/rosout``.

``(ros-info (turtle) "text")`` prints ``[(TURTLE) INFO] 1292688669.674: text`` on a line of its own. The topic is a path in a
tree: a level set for ``(a)`` holds for ``(a b)`` too, unless that has its own. Levels belong to the session, not to the node.
The macros evaluate their arguments only if `enabled` is true. Source: roslisp.md 4.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleCondition, SimpleError, SimpleWarning
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.printing import format_to_string, guarded, shown
from cramhy_runtime.lisp_core.output import standard_output
from cramhy_runtime.lisp_core.packages import intern, string_designator, symbol_name
from cramhy_runtime.lisp_core.printing import princ_to_string
from .. import graph, rosout, wire
from ..rosout import DEBUG, ERROR, FATAL, INFO, LEVEL_CODES, LEVEL_NAMES, WARN
from . import log_file
from .clock import ros_time
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..graph import Node

    Path = tuple[str, ...]


__all__ = ["DEBUG", "ERROR", "FATAL", "INFO", "WARN"]


def topic_path(topic: Any) -> Path:
    """A log topic as a tuple of upper-case names. ``topic``: a list or tuple, one symbol or string, or nil for the root."""
    if topic is None:
        return ()
    if isinstance(topic, (Cons, tuple, list)):
        return tuple(string_designator(part).upper() for part in topic)
    return (string_designator(topic).upper(),)


def _levels() -> dict[Path, int]:
    return graph.active().debug_levels


def level_of(path: Path) -> int:
    """The level (1, 2, 4, 8, 16) in force for the topic ``path``, a tuple of names."""
    levels = _levels()
    if not levels:
        return INFO
    while path:
        if path in levels:
            return levels[path]
        path = path[:-1]
    return levels.get((), INFO)


def enabled(level: int, topic: object) -> bool:
    """Whether a message of ``level`` (1, 2, 4, 8, 16) on ``topic`` (list, symbol or nil) is printed."""
    return level >= level_of(topic_path(topic))


def ros_log(level: int, topic: object, control: str, *arguments: object) -> int | None:
    """Log the format ``control`` with ``arguments``, if the topic's level allows ``level``.

    Returns the number of ``/rosout`` subscribers, or nil if nothing is logged or no node runs. An argument that cannot be printed does not
    end the plan that logs it: see `shown`. Source: roslisp.md 4.
    """
    if not enabled(level, topic):
        return None
    text = guarded(
        lambda: format_to_string(control, *arguments),
        lambda _: shown(SimpleCondition(control, *arguments), lambda: format_to_string(control, *arguments)),
    )
    return _print(level, topic, text)


def log_text(level: int, topic: object, text: str) -> int | None:
    """Log a finished ``text`` from the runtime itself, as `ros_log`. ``topic``: as there, or a tuple of symbol names in ROSLISP."""
    if not enabled(level, topic):
        return None
    if isinstance(topic, tuple):
        topic = list_from([intern(name, "ROSLISP") for name in topic])
    return _print(level, topic, text)


def log_about(level: int, topic: str | tuple[str, ...], text: str) -> int | None:
    """Log a finished text of a Python program. ``topic``: a name, or a path of names."""
    if not enabled(level, topic):
        return None
    return _print(level, list_from([Symbol(name, None) for name in topic_path(topic)]), text)


def _print(level: int, topic: Any, text: str) -> int | None:
    shown_topic = princ_to_string(topic if topic is None or isinstance(topic, Cons) else lisp_list(topic))
    stream = standard_output()
    stream.fresh_line()
    line = f"[{shown_topic} {LEVEL_NAMES[level]}] {float(ros_time()):.3f}: {text}"
    stream.write(line)
    stream.fresh_line()
    complaint = log_file.write(line + "\n")
    if complaint is not None:
        conditions.warn(SimpleWarning("~a", complaint))
    here = graph.active()
    lisp_node = here.lisp_node
    if lisp_node is None:
        here.log.append((level, None, text))
        return None
    return rosout.report(lisp_node, level, text)


# -------------------------------------------------------------------------------------------------------------- the levels


def level_code(level: int | Symbol | str) -> int:
    """The number of a level, given as keyword, number, or upper-case string. Anything else is an error."""
    if level.__class__ is int:
        return level
    if isinstance(level, Symbol):
        code = LEVEL_CODES.get(symbol_name(level))
        name = symbol_name(level)
    else:
        code = LEVEL_CODES.get(str(level)) if isinstance(level, (str, LispString)) else None
        name = "NIL"
    if code is None:
        return conditions.error(SimpleError("~a", f"Could not get symbol code for {name} for ROS message type <LOG>"))
    return code


def set_debug_level(name: object, level: int | Symbol | str) -> int | None:
    """Set the level of the log topic ``name``, a list or symbol. If a node runs, its parameter ``~debug/…/level`` is set too.

    Returns 0 if a node runs, else nil.
    """
    path, code = topic_path(name), level_code(level)
    _levels()[path] = code
    here = graph.active().lisp_node
    if here is None:
        return None
    here.graph.parameters.set(
        here.resolve("~debug/" + "".join(part.lower() + "/" for part in path) + "level"), LEVEL_NAMES.get(code, str(code)).lower()
    )
    return 0


def set_debug_levels(*names_and_levels: Any) -> int | None:
    """Set several levels: ``NAME1 LEVEL1 …``. The macro ``set-debug-levels`` calls it with quoted names."""
    result = None
    for index in range(0, len(names_and_levels), 2):
        result = set_debug_level(names_and_levels[index], names_and_levels[index + 1])
    return result


def debug_level(name: object) -> int:
    """The number of the level in force for a log topic. ``name``: a reversed list of keywords, ``(:tcp :roslisp)``."""
    if isinstance(name, Cons):
        return level_of(tuple(reversed(topic_path(name))))
    return level_of(())


def print_debug_levels() -> None:
    """Print the table of levels, with the topics reversed as in the original."""
    levels = {(): INFO, **_levels()}
    lines = []
    for path, code in levels.items():
        shown = f"({' '.join(reversed(path))})" if path else "NIL"
        lines.append(f"{shown} : {LEVEL_NAMES.get(code, code)}")
    stream = standard_output()
    stream.write("[" + "\n ".join(lines) + "]")


def read_levels(here: Node) -> None:
    """Set the levels from the node's parameters below ``~debug/``; for the node's start and ``~reset_debug_levels``."""
    prefix = here.resolve("~debug/").rstrip("/") + "/"
    for name in here.graph.parameters.names():
        if name.startswith(prefix) and name.endswith("/level"):
            path = tuple(part.upper() for part in name[len(prefix) :].split("/")[:-1])
            word = str(here.graph.parameters.get(name)).upper()
            if word in LEVEL_CODES:
                here.graph.debug_levels[path] = LEVEL_CODES[word]
            else:
                log_text(WARN, ("ROSLISP", "ROSOUT"), f"Skipping setting debug level of {name} to unknown level {word}")


wire.on_misfit.append(lambda text: log_text(ERROR, ("ROSLISP",), text))
