"""Names: the meaning of ``foo``, ``/foo`` and ``~foo`` to a node, and how its command line changes it.

A *global* name begins with ``/``. A *private* name begins with ``~`` and is below the node's own name. Every other name is
relative to the namespace. As in roslisp, finding out what a name means does not validate or clean it. `check_graph_name` validates the
names of topics, services and parameters, as roscpp does. Source: roslisp.md 3, wiki.ros.org/Names.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable


_LETTERS = set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
_DIGITS = set("0123456789")
_NAME_CHARACTERS = _LETTERS | _DIGITS | {"/", "_"}


class Naming:
    """The names of one node: its namespace (with slashes at both ends), its own global name, remappings, private parameters."""

    def __init__(self, base_name: str, namespace: str = "/"):
        self.base_name = base_name.strip("/")
        self.namespace = as_namespace(namespace)
        self.node_name = self.namespace + self.base_name
        self.remappings: dict[str, str] = {}
        self.private_parameters: list[tuple[str, object, str]] = []  # name, value, the text of it
        self.log_file: str | None = None

    def resolve(self, name: str) -> str:
        """The global name of ``name``, after remapping."""
        full = qualify(name, self.namespace, self.node_name)
        return self.remappings.get(full, full) if self.remappings else full

    def apply_arguments(self, arguments: Iterable[str], read_value: Callable[[str], object]) -> None:
        """Process command-line arguments such as ``a:=b`` in order. ``read_value(text)`` reads a private parameter.

        A remapping is qualified with the names known at its turn (roslisp.md 3.3).
        """
        for argument in arguments:
            left, assignment, right = argument.partition(":=")
            if not assignment:
                continue
            if left == "__ns":
                self.namespace = as_namespace(right)
                self.node_name = self.namespace + self.base_name
            elif left == "__name":
                self.node_name = self.namespace + right.strip("/")
            elif left == "__log":
                self.log_file = right
            elif left.startswith("_"):
                self.private_parameters.insert(0, ("~" + left[1:], read_value(right), right))
            else:
                self.remappings[self._qualify(left)] = self._qualify(right)

    def _qualify(self, name: str) -> str:
        return qualify(name, self.namespace, self.node_name)


def as_namespace(text: str | None) -> str:
    """``text`` with a slash at both ends."""
    text = (text or "").strip("/")
    return f"/{text}/" if text else "/"


def qualify(name: str, namespace: str, node_name: str | None) -> str:
    """The global form of ``name``, without remapping. The empty name is an index error, as in roslisp."""
    if not name:
        return conditions.error("Invalid index 0 for (SIMPLE-ARRAY CHARACTER (0)): the empty string is not a name in ROS.")
    first = name[0]
    if first == "/":
        return name
    if first == "~":
        return f"{node_name or ''}/{name[1:]}"
    return namespace + name


def is_base_name(name: str) -> bool:
    """Whether ``name`` is a letter followed by letters, digits and underscores."""
    return bool(name) and name[0] in _LETTERS and all(character in _NAME_CHARACTERS and character != "/" for character in name)


def check_graph_name(name: str) -> str | None:
    """The text of roscpp's error about an illegal ``name``, or ``None`` if it is legal."""
    if not name:
        return None
    if name[0] not in _LETTERS and name[0] not in "/~":
        return (
            f"Character [{name[0]}] is not valid as the first character in Graph Resource Name [{name}].  Valid characters "
            "are a-z, A-Z, / and in some cases ~."
        )
    for index, character in enumerate(name[1:], 1):
        if character not in _NAME_CHARACTERS:
            return (
                f"Character [{character}] at element [{index}] is not valid in Graph Resource Name [{name}].  Valid characters "
                "are a-z, A-Z, 0-9, / and _."
            )
    return None


def allowed_name(name: str) -> str:
    """A name like ``name`` that `check_graph_name` has nothing against: other characters are underscores, a first digit gets a letter."""
    first = name[:1]
    name = first + "".join(character if character in _NAME_CHARACTERS else "_" for character in name[1:])
    if first in _LETTERS or first in "/~":
        return name
    return f"n{name}" if first in _DIGITS or first == "_" else f"n_{name[1:]}"


def split_arguments(arguments: str | Iterable[object] | None) -> list[str]:
    """Command-line arguments as a list of strings. A single string is split at white space; ``None`` is the empty list."""
    if arguments is None:
        return []
    if isinstance(arguments, str):
        return arguments.split()
    return [str(argument) for argument in arguments]


def plain_value(text: str) -> str | int | float | bool:
    """The value of ``text`` without a given type, as the tools of ROS and roscpp read it: integer, number, true or false, else text."""
    for kind in (int, float):
        try:
            return kind(text.replace("_", "?"))  # Python would read 1_000 as a number
        except ValueError:
            pass
    return {"true": True, "false": False}.get(text.lower(), text)


def read_private_value(text: str) -> object:
    """The value of ``_p:=text``, from the Lisp reader: a number or another object. A symbol or an unreadable text stays text.

    Nothing is evaluated, and programs see no new symbols. Source: roslisp.md 3.3.
    """
    try:
        value = PORTS.user.read(text)
    except Exception:  # not the text of a Lisp object: an address, a path, a word with a colon
        return text
    return text if value is None or value is True or isinstance(value, Symbol) else value
