"""What is said of an operator, once: how it is written, what that stands for, and what it is for.

From a declaration come the macro of Common Lisp, that of Hy, the message when it is written wrongly, what DESCRIBE and completion
say, and the page ``docs/operators.md``. Where a template cannot say what a call stands for, ``expansion`` is ``None``, and an expander
written by hand in ``hy_src/cramhy`` says it.
"""

from __future__ import annotations

import functools
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from . import grammar

if TYPE_CHECKING:
    from collections.abc import Iterable


IN_PLACE, BRANCHES = "in place", "branches"
"""Marks of rows. The first is for an operator that runs its body where it stands, so that its value is the body's. The second is for one
that raises what a branch failed with."""


class Operator:
    """A macro of one of our packages.

    package: the name of its home. exported: whether users of that package see it; others write ``package::name``. marks: `IN_PLACE` and
    `BRANCHES`, as far as they hold.
    """

    __slots__ = ("name", "package", "exported", "shape", "expansion", "documentation", "marks", "__dict__")

    def __init__(
        self, package: str, shape: str, expansion: str | None, documentation: str, exported: bool = True, marks: Iterable[str] = ()
    ) -> None:
        written = shape[1:].split(None, 1)[0].rstrip(")")
        prefix, _, name = written.rpartition("::")
        self.name = name.upper()
        self.package = prefix.upper() if prefix else package
        self.shape = shape.replace(written, name, 1)
        self.expansion, self.documentation, self.exported = expansion, documentation, exported
        self.marks = frozenset(marks)

    def __repr__(self) -> str:
        return f"<operator {self.package}::{self.name}>"

    @functools.cached_property
    def patterns(self) -> list[list[Any]]:
        """The grammars of what stands behind the name: several where there are several ways to write it."""
        return [grammar.parse(shape)[1:] for shape in self.shape.split(" or ")]

    @property
    def pattern(self) -> list[Any]:
        """The first of these grammars."""
        return self.patterns[0]

    @functools.cached_property
    def options(self) -> list[str]:
        """The names of the keyword options that may stand in a call, at any depth."""
        return sorted({name for pattern in self.patterns for name in grammar.options(pattern)})

    @property
    def meanings(self) -> list[str]:
        """The names of the functions that a call comes to, in lower case: the operator's own, and those of its template."""
        words = (self.expansion or "").replace("(", " ").replace(")", " ").split()
        return [self.name.lower(), *(word[1:] for word in words if word.startswith("%"))]

    @functools.cached_property
    def template(self) -> Any:
        """The template of what a call stands for; ``None`` if an expander says it."""
        return None if self.expansion is None else grammar.parse(self.expansion)


class Table(dict[str, Operator]):
    """The operators of a room, by their names."""

    def __init__(self, package: str, *rows: tuple[str, str | None, str, *tuple[str, ...]]) -> None:
        """rows: (shape, template or None, documentation), and the marks behind them. A shape that begins with ``(-`` is of one
        that is not exported."""
        super().__init__()
        for shape, expansion, documentation, *marks in rows:
            exported = not shape.startswith("(- ")
            operator = Operator(package, shape if exported else "(" + shape[3:], expansion, documentation, exported, marks)
            self[operator.name] = operator
        self.package = package


def hy_shape(operator: Operator) -> str:
    """How the operator is written in Hy: lists that are no calls have brackets."""
    return " or ".join("(" + " ".join([operator.name.lower(), *map(_shape, pattern)]) + ")" for pattern in operator.patterns)


def _shape(item: Any) -> str:
    if isinstance(item, grammar.Many):
        return _shape(item.item) + "..."
    if isinstance(item, grammar.Maybe):
        return "{" + " ".join(map(_shape, item.items)) + "}"
    if isinstance(item, list) and isinstance(item[0], grammar.Word) and item[0].startswith(":"):
        return "(" + " ".join(map(_shape, item)) + ")"
    if isinstance(item, list):
        return "[" + " ".join(map(_shape, item)) + "]"
    return f'"{item}"' if isinstance(item, grammar.Text) else str(item)
