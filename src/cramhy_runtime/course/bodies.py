"""What the guide says of forgotten parentheses: a definition inside of another one, and names in a body that were meant as calls.

Both are accepted as they are. The inner function is not there until the outer one is called, and a name in a body is a value that
nobody uses.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from .trees import Listed, atoms, bare, lists, read, shown

if TYPE_CHECKING:
    from collections.abc import Set

_DEFINES = {"lisp": ("defun", "def-cram-function"), "hy": ("defn",)}
_BODIES = {
    **dict.fromkeys(("defun", "defn", "def-cram-function", "def-process-module"), 3),
    **dict.fromkeys(("dotimes", "dolist", "for", "let", "let*", "while", "when", "unless"), 2),
    **dict.fromkeys(("top-level", "par", "pursue", "seq", "progn", "do"), 1),
}
"""Where the forms of a body begin."""
_ARITHMETIC = ("+", "-", "*", "/")
_OF_FUNCTIONS = ("lisp-fun", "apply", "funcall", "reduce", "map", "mapcar", "fl-funcall", "function", "import")
_SETTERS = ("setv", "setf", "setq", "defvar", "defparameter")
NO_RETURN = "needs no return here: the last form of a function is its value."


def of_form(text: str, language: str, functions: Set[str] = frozenset(), in_task: bool = False) -> str | None:
    """What to say of a form in which parentheses are missing; ``None`` if nothing in it is a slip.

    functions: the names, in lower case, of the functions that the student knows. in_task: whether a task is shown, so that what is said has
    other numbers than the form.
    """
    tree = read(text)
    own = functions - {name for form in lists(tree) for name in _bound(form)}
    for form in lists(tree):
        told = _of_exact(form) or _of_definition(form, language) or _of_body(form, language, own) or _of_operator(form, in_task)
        if told is not None:
            return f"; {told}"
    return None


def _of_definition(form, language):
    if form.head not in _DEFINES[language] or len(form) < 2:
        return None
    inner = next((each for each in lists(form) if each.head in _DEFINES[language] and len(each) > 1 and not each.quote), None)
    if inner is None or (language == "hy" and not inner.begins_a_line):  # a function inside of another one is usual in Hy
        return None
    return f"{shown(inner[1])} was defined inside {shown(form[1])}: a ) was missing there."


def _of_exact(form):
    """A wait for a number with a fraction: what changes hardly ever is exactly that."""
    for each in lists(form) if form.head == "wait-for" else ():
        number = next((part for part in each if isinstance(part, str) and re.fullmatch(r"-?\d+\.\d+", part)), None)
        if number is not None and each.head in ("=", "eql", "equal", "fl-eql", "fl-="):
            return f"A value that changes passes {number}, and is hardly ever exactly that: use > or <."
    return None


def _bound(form):
    """The names, in lower case, that a form gives to arguments and values."""
    parts = form[1 : _BODIES.get(form.head, 1)]
    return {atom.lower() for part in parts if isinstance(part, Listed) for atom in atoms(part)}


def _of_body(form, language, functions):
    begin = _BODIES.get(form.head)
    if begin is None or form.quote:
        return None
    for place, each in enumerate(form[begin:], begin):
        if not isinstance(each, str):
            continue
        if each.lower() == "return":
            return f"{'Lisp' if language == 'lisp' else 'Hy'} {NO_RETURN}"
        if bare(each).rpartition(".")[2] not in functions or each.startswith((":", "'", "#", '"')):
            continue
        behind = form[place + 1] if place + 1 < len(form) else None
        with_argument = isinstance(behind, Listed) or (isinstance(behind, str) and re.match(r"-?[\d.]", behind))
        return f"{each} stands there without parentheses. A call has parentheses around it, as in ({each}{' 7' if with_argument else ''})"
    return None


def _of_operator(form, in_task):
    """An operator between two arguments of a call, as in ``(left 360 / corners)``."""
    if form.open != "(" or form.quote or form.head in (*_OF_FUNCTIONS, *_ARITHMETIC, "", "<-") or re.search(r"^[\d?]", form.head):
        return None
    places = [place for place, each in enumerate(form) if each in _ARITHMETIC and 1 < place < len(form) - 1]
    if not places or any(isinstance(each, Listed) and each.head == "lambda" for each in form):
        return None
    place = places[0]
    operator = form[place]
    if in_task:
        name = f"{shown(form[1])} " if form.head in _SETTERS else ""
        return f"Each {operator} has parentheses of its own, as in ({form[0]} {name}({operator} 7 9))"
    before, behind = form[1 : place - 1], form[place + 2 :]
    inside = f"({operator} {shown(form[place - 1])} {shown(form[place + 1])})"
    return f"Each {operator} has parentheses of its own: ({' '.join([str(form[0]), *map(shown, before), inside, *map(shown, behind)])})"


__all__ = ["of_form"]
