"""How a call of an operator is written: its grammar, and the template of what it stands for.

    (par-loop (variable list) form...)              the grammar
    (%par-loop list (lambda (variable) form...))    the template

In both, a word is a part of the call, and ``x...`` is any number of parts. In a grammar ``[x]`` may be left out, ``[x y]...`` is any number
of such groups, ``[:key x]`` are keyword options in any order, ``(call) or (call)`` are two ways to write it, ``"text"`` is a literal string
that the template calls ``text``, and ``(x y)...`` are lists of that shape, which only an expander written by hand can take apart. In a
template a list with dots behind it is repeated: ``(lambda () form)...`` is a function for each of the forms. Words that are no part of the
call are symbols, and ``%name`` is one of the package CRAMHY, where the functions are that give the operators their meaning.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.data import Cons, Keyword, list_from
from cramhy_runtime.kernel.typing_names import Any

_TOKEN = late_pattern(r"""\(|\)|\[|\]|'|\.\.\.|"[^"]*"|[^\s()\[\]'".]+(?:\.(?!\.)[^\s()\[\]'".]*)*""")
_MISSING = object()

WRONG_NUMBER = "it has the wrong number of parts, or a part is not a list."


class WrongShape(ValueError):
    """A call is not written as the grammar says."""


class UnknownOption(WrongShape):
    """A keyword option that the operator does not have. ``key``: it; ``known``: the names of those that there are."""

    def __init__(self, key: Any, known: list[str]) -> None:
        super().__init__(f"it has no option {key}.")
        self.key, self.known = key, known


class Word(str):
    """A part of a call, or of a template."""

    __slots__ = ()


class Text(str):
    """A literal string."""

    __slots__ = ()


class Parts(list):
    """What ``x...`` stands for; other lists in a call are its vectors."""


class Many:
    """``item`` any number of times."""

    def __init__(self, item: Any) -> None:
        self.item = item


class Maybe:
    """A part that may be left out."""

    def __init__(self, items: list[Any]) -> None:
        self.items = items


def parse(text: str) -> Any:
    """What a grammar or a template says: `Word`, `Text`, `Many`, `Maybe`, and lists of these."""
    tokens = _TOKEN.findall(text)
    items = _items(iter(tokens), None)
    return items[0] if len(items) == 1 else items


def _items(tokens: Iterator[str], closer: str | None) -> list[Any]:
    items: list[Any] = []
    quotes = 0
    for token in tokens:
        if token == closer:
            return items
        if token == "...":
            items[-1] = Many(items[-1])
            continue
        if token == "'":
            quotes += 1
            continue
        item: Any
        if token == "(":
            item = _items(tokens, ")")
        elif token == "[":
            item = Maybe(_items(tokens, "]"))
        elif token[0] == '"':
            item = Text(token[1:-1])
        else:
            item = Word(token)
        for _ in range(quotes):
            item = [Word("quote"), item]
        quotes = 0
        items.append(item)
    return items


# --------------------------------------------------------------------------------------------------------------- matching


def match(pattern: list[Any], parts: Any) -> dict[str, Any]:
    """The parts of a call by their names in the grammar; ``x...`` gives `Parts`.

    pattern: the grammar's list without the operator. parts: the call's, a Lisp list. Raises `WrongShape`.
    """
    found: dict[str, Any] = {}
    if parts is not None and not isinstance(parts, Cons):
        raise WrongShape(WRONG_NUMBER)
    if _match(pattern, parts, found) is not None:
        raise WrongShape(WRONG_NUMBER)
    return found


def _match(pattern: list[Any], parts: Any, found: dict[str, Any]) -> Any:
    """Enter into ``found`` what ``pattern`` says of the first ``parts``; the rest of them."""
    options = _options(pattern)
    if options:
        pattern = [item for item in pattern if not _key(item)]
        return _match_options(options, _match(pattern, parts, found), found)
    for place, item in enumerate(pattern):
        if parts is not None and not isinstance(parts, Cons):
            raise WrongShape(WRONG_NUMBER)
        if isinstance(item, Many):
            _match_many(item.item, parts, found)
            return None
        if isinstance(item, Maybe):
            if _is_there(item, parts, pattern[place + 1 :]):
                parts = _match(item.items, parts, found)
            else:
                found.update(dict.fromkeys(_words(item.items)))
            continue
        if parts is None:
            raise WrongShape(WRONG_NUMBER)
        _match_one(item, parts.car, found)
        parts = parts.cdr
    return parts


def _match_many(item: Any, parts: Any, found: dict[str, Any]) -> None:
    if isinstance(item, Maybe):  # groups of parts
        while parts is not None:
            parts = _match(item.items, parts, found)
        return
    rest = Parts(parts or ())
    if isinstance(item, Word):
        found[item] = rest
        return
    for part in rest:
        _match_one(item, part, found) if isinstance(item, Text) else match(item, part)


def _is_there(item: Maybe, parts: Any, behind: list[Any]) -> bool:
    """Whether a part that may be left out is there. A string with nothing behind it is the value of a body, not its documentation."""
    if parts is None:
        return False
    if isinstance(item.items[0], Text):
        return isinstance(parts.car, str) and (not behind or parts.cdr is not None)
    return not (behind and isinstance(behind[0], Text) and isinstance(parts.car, str))


def _match_one(item: Any, part: Any, found: dict[str, Any]) -> None:
    if isinstance(item, list):
        found.update(match(item, part))
    elif isinstance(item, Text):
        if not isinstance(part, str):
            raise WrongShape(f"{item} must be a literal string.")
        found[item] = part
    elif item.startswith(":"):
        if not isinstance(part, Keyword) or part.name != item[1:].upper():
            raise WrongShape(f"{item} must stand there.")
    else:
        found[item] = part


def _key(item: Any) -> str | None:
    if isinstance(item, Maybe) and isinstance(item.items[0], Word) and item.items[0].startswith(":"):
        return item.items[0][1:].upper()
    return None


def _options(pattern: list[Any]) -> dict[str, Any]:
    """Key → the word, or the list of words, for its value."""
    return {key: item.items[1] for item in pattern if (key := _key(item))}


def options(pattern: Any) -> Iterator[str]:
    """The names of the keyword options in a grammar, at any depth. ``[:option value...]`` stands for options of any name."""
    if isinstance(pattern, list):
        yield from (key for key, value in _options(pattern).items() if not isinstance(value, Many))
        for item in pattern:
            yield from options(item)
    elif isinstance(pattern, Maybe):
        yield from options(pattern.items)
    elif isinstance(pattern, Many):
        yield from options(pattern.item)


def _match_options(options: dict[str, Any], parts: Any, found: dict[str, Any]) -> None:
    """Enter the keyword options of which all ``parts`` consist."""
    found.update(dict.fromkeys(_words(list(options.values()))))
    rest = list(parts or ())
    if len(rest) % 2:
        raise WrongShape("each of its options is a keyword and a value.")
    for key, value in zip(rest[::2], rest[1::2]):
        if not isinstance(key, Keyword) or key.name not in options:
            raise UnknownOption(key, list(options))
        _match_one(options[key.name], value, found)


def _words(items: list[Any]) -> Iterator[str]:
    for item in items:
        if isinstance(item, (Word, Text)):
            yield item
        elif isinstance(item, Many):
            yield from _words([item.item])
        else:
            yield from _words(item.items if isinstance(item, Maybe) else item)


# ----------------------------------------------------------------------------------------------------------------- templates


def fill(template: Any, found: dict[str, Any], symbol: Callable[[str], Any]) -> Any:
    """The Lisp form that a template gives with the parts ``found``. symbol: what makes a symbol of a word that is no part."""
    if isinstance(template, Text):
        return str(template)
    if isinstance(template, Word):
        value = found.get(template, _MISSING)
        if value is _MISSING:
            return symbol(template)
        return list_from(value) if type(value) is Parts else value
    forms: list[Any] = []
    for item in template:
        if isinstance(item, Many):
            forms += _repeated(item.item, found, symbol)
        else:
            forms.append(fill(item, found, symbol))
    return list_from(forms)


def _repeated(item: Any, found: dict[str, Any], symbol: Callable[[str], Any]) -> list[Any]:
    if isinstance(item, Word):
        return list(found[item])
    name = next(word for word in _words([item]) if type(found.get(word)) is Parts)
    return [fill(item, {**found, name: part}, symbol) for part in found[name]]
