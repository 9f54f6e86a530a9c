"""What a student has typed, as lists in lists: enough of the syntax of Lisp and Hy to say where a name stands.

A list is a `Listed`, an atom its text. A quote stays at the front of its atom, and is the ``quote`` of its list. A text that does not end,
or has a parenthesis too many, is read as far as it goes.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

_TOKEN = re.compile(r"\"(?:\\.|[^\"\\])*\"?|;[^\n]*|#\\.[\w-]*|#?[(\[{]|[)\]}]|(?:#'|['`,~@])+|[^\s()\[\]{}\";'`,~]+|.", re.S)


class Listed(list[Any]):
    """A list of atoms and lists. ``open``: its bracket. ``quote``: what stands before it. ``begins_a_line``: nothing stands left of it."""

    def __init__(self, open: str = "(", quote: str = "", begins_a_line: bool = False):
        super().__init__()
        self.open, self.quote, self.begins_a_line = open, quote, begins_a_line

    @property
    def head(self) -> str:
        """The atom at the front, in lower case and without its package, or an empty text."""
        return bare(self[0]) if self and isinstance(self[0], str) else ""


def bare(name: str) -> str:
    """A name in lower case without its package."""
    return name.lower().rpartition(":")[2] if not name.startswith((":", '"')) else name.lower()


def read(text: str) -> Listed:
    """The forms of ``text``, in a list."""
    whole = Listed()
    path, quote = [whole], ""
    for match in _TOKEN.finditer(text):
        token = match[0]
        if token.isspace() or token.startswith(";"):
            continue
        if token[-1] in "([{" and token[0] not in '"#' or token in ("#(", "#["):
            made = Listed(token[-1], quote, match.start() == 0 or text[match.start() - 1] == "\n")
            path[-1].append(made)
            path.append(made)
            quote = ""
        elif token in (")", "]", "}"):
            path = path[:-1] if len(path) > 1 else path
        elif token.strip("#'`,~@") == "" and token != "#":
            quote = token
        else:
            path[-1].append(quote + token)
            quote = ""
    return whole


def lists(tree: Listed) -> Iterator[Listed]:
    """All lists in ``tree``, from the outside to the inside."""
    for each in tree:
        if isinstance(each, Listed):
            yield each
            yield from lists(each)


def atoms(tree: Any) -> Iterator[str]:
    """All atoms in ``tree``, from the left to the right."""
    if isinstance(tree, str):
        yield tree
    else:
        for each in tree:
            yield from atoms(each)


def shown(tree: Any) -> str:
    """A list or an atom as it is written in one line."""
    if isinstance(tree, str):
        return tree
    return f"{tree.quote}{tree.open}{' '.join(map(shown, tree))}{ {'(': ')', '[': ']', '{': '}'}[tree.open] }"
