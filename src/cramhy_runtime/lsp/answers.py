"""What an editor asks of a place in a text: completion, how a call is written, where names are defined and used.

The functions of the session room answer for Common Lisp. For plain Hy the macros of ``(require cramhy *)`` and the words of the text do.
"""

from __future__ import annotations

import builtins
import os
from pathlib import Path
from typing import NamedTuple

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import is_symbol
from cramhy_runtime.languages.commonlisp.tools.describing import description
from cramhy_runtime.languages.hy import shapes
from cramhy_runtime.languages.hy.plan_macros import macros
from cramhy_runtime.languages.operators import operator_of
from cramhy_runtime.session import arglists, completion, fuzzy, lookup
from cramhy_runtime.session.body_arguments import body_start, body_start_of_name
from cramhy_runtime.session.lookup import bare_name

from . import meanings, neighbours, outlines, scopes
from .texts import Text, Token

MOST = 300
MOST_LOOKED_AT = 20_000
"""So many characters before a word are looked at to complete it."""
_DESCRIBED = 4000


class Spot(NamedTuple):
    """A place in a file. path: of the file, or ``None`` for the text itself. start, end: offsets in ``text``."""

    path: str | None
    text: Text
    start: int
    end: int

    @property
    def written(self):
        return self.text.text[self.start : self.end]


def completions(document, offset):
    """([(name, what is known of it)], start of the word)."""
    text = document.text
    if text.quiet(offset):
        return [], offset
    token = text.word(offset)
    word = text.text[token.start : offset] if token is not None else ""
    if document.kind == "hy":
        return _of_hy(text, word), offset - len(word)
    around = text.around(offset)
    start = max(offset - MOST_LOOKED_AT, around[-1].start) if around else offset - len(word)

    def found():
        package = document.package_at(offset)
        names, _ = completion.completions(text.text[start:offset], package)
        known = {name for name, _ in names}
        more = [(match.name.lower(), "") for match in fuzzy.completions(word, package, MOST)] if len(names) < MOST and word else []
        return names[:MOST] + [each for each in more if each[0] not in known][: MOST - len(names[:MOST])]

    return document.in_image(found, []), offset - len(word)


def _of_hy(text, word):
    import hy

    ours = {hy.unmangle(name) for name in macros()}
    written = {token.text for token in text.tokens if token.kind == "word" and token.text != word and not token.text[0].isdigit()}
    names = sorted(name for name in ours | written | set(vars(builtins)) if name.startswith(word) and not name.startswith("_"))
    return [(name, (shapes.hint(name) or "") if name in ours else "") for name in names[:MOST]] if word else []


def symbol_at(document, token):
    """The symbol that a word means; to be called in the image."""
    package = document.package_at(token.start)
    return None if package is None else arglists.symbol_named(token.text.lstrip("#'"), package)


def hover(document, offset):
    """(text, start, end) of what is known of the word at ``offset``, or ``None``."""
    token = document.text.word(offset)
    if token is None or document.kind == "xml":
        return None
    if document.kind == "hy":
        import hy

        hint = shapes.hint(token.text) if hy.mangle(token.text) in macros() else None
        return (hint, token.start, token.end) if hint else None

    def described():
        symbol = symbol_at(document, token)
        if symbol is None:
            return None
        operator = operator_of(symbol)
        if operator is not None:
            return f"{operator.shape}\n\n{operator.documentation}"
        if not isinstance(symbol, Symbol):
            return None
        items = arglists.arglist(symbol)
        call = f"{arglists.call_text(token.text.lower(), [item.lower() for item in items])}\n\n" if items is not None else ""
        return call + description(symbol).strip()[:_DESCRIBED]

    told = document.in_image(described)
    return (told, token.start, token.end) if told else None


def signature(document, offset):
    """(text of the call, its parts, number of the part that is typed or ``None``) of the innermost call that is known."""
    if document.kind in ("hy", "xml"):
        return None
    text = document.text

    def found():
        for form in text.around(offset):
            head = form.items[0] if form.items else None
            if head is None or hasattr(head, "items") or head.kind != "word" or head.end >= offset:
                continue
            symbol = arglists.symbol_named(head.text, document.package_at(offset))
            items = arglists.arglist(symbol) if symbol is not None and is_symbol(symbol) else None
            if items is None:
                continue
            before = [item for item in form.items[1:] if item.start < offset and getattr(item, "kind", "") != "quote"]
            at_new = not before or before[-1].end < offset
            index = len(before) if at_new else len(before) - 1
            words = [item.text for item in before if not hasattr(item, "items")]
            keyword = words[-1][1:] if words and words[-1].startswith(":") else None
            shown = [item.lower() for item in items]
            return arglists.call_text(head.text.lower(), shown), shown, arglists.place_of_argument(items, index, keyword)
        return None

    return document.in_image(found)


# ------------------------------------------------------------------------------------------------------------------- places


def definitions(document, offset):
    """The `Spot`s where the word at ``offset`` is defined: in this text as it stands, and in files as they are on the disk."""
    token = document.text.word(offset)
    if token is None or document.kind == "xml":
        return []
    local = scopes.local(document.text, token) if not token.text.startswith(":") else None
    if local:
        return [Spot(None, document.text, local[0].start, local[0].end)]
    found = _defined(document, token, [(None, document.text)])
    if found or document.kind == "hy":
        return found
    places = document.in_image(lambda: lookup.definitions(token.text, document.package_at(token.start)), [])
    beside = set(map(str, neighbours.files(document)))
    for place in [each for each in places if each.file in beside] or places:  # not those of another copy of the system
        if os.path.isfile(place.file) and os.path.realpath(place.file) != os.path.realpath(document.filename):
            text = Text(Path(place.file).read_text(encoding="utf-8", errors="replace"))
            start = text.offset_of_reader(place.line, place.column)
            if all((each.path, each.start) != (place.file, start) for each in found):
                found.append(Spot(place.file, text, start, start + 1))
    return found or _in_system(document, token)


def _in_system(document, token):
    return _defined(document, token, neighbours.texts(document))


def _defined(document, token, texts):
    """The `Spot`s of the top-level forms in ``texts``, (path, `Text`), that define what ``token`` means."""
    bare = bare_name(token.text)
    named = [
        Spot(path, text, start, end)
        for path, text in texts
        for _, name, _, _, start, end in outlines.definitions(text)
        if bare_name(name) == bare
    ]
    return _meant(document, token, named) if named else []


def _meant(document, token, spots):
    """Those of the ``spots`` whose word means what ``token`` of the document means."""
    if document.kind == "hy":
        return spots

    def chosen():
        words = meanings.Meanings([document.text, *(text for _, text in neighbours.texts(document))])
        wanted = words.of(document.text, token)
        return [spot for spot in spots if words.of(spot.text, Token("word", spot.start, spot.end, spot.written)) == wanted]

    return document.in_image(chosen, spots)


def references(document, offset, others):
    """The `Spot`s of all words that mean the same as the one at ``offset``: in its form if it is local, else in the system's files."""
    token = document.text.word(offset)
    if token is None or document.kind == "xml":
        return []
    local = scopes.local(document.text, token)
    if local is not None:
        return [Spot(None, document.text, each.start, each.end) for each in local]
    return _everywhere(document, token, [(None, document.text), *neighbours.texts(document, others)])


def _everywhere(document, token, texts):
    bare = bare_name(token.text)
    return _meant(document, token, [Spot(path, text, each.start, each.end) for path, text in texts for each in scopes.free(text, bare)])


def renaming(document, offset, others):
    """The `Spot`s that a renaming of the word at ``offset`` changes, without prefixes; ``None`` if its definition is not the user's."""
    token = document.text.word(offset)
    if token is None or token.text.startswith((":", "#", "&")):
        return None
    if scopes.local(document.text, token) is None and not _defined(
        document, token, [(None, document.text), *neighbours.texts(document, others)]
    ):
        return None
    return [spot._replace(start=spot.start + spot.written.rfind(":") + 1) for spot in references(document, offset, others)]


def body_starts(document):
    """The function that `indentation.indented` asks; to be called in the image."""
    package, known = document.package_at(len(document.text.text)), {}

    def ask(name):
        if package is None:
            return None
        if name not in known:
            symbol = arglists.symbol_named(name, package)
            count = body_start(symbol) if isinstance(symbol, Symbol) else None
            defined = isinstance(symbol, Symbol) and arglists.is_callable(symbol)
            known[name] = count if count is not None or defined else body_start_of_name(name)
        return known[name]

    return ask
