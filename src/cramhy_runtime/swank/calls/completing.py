"""Calls while the user types: completion and arglists."""

from __future__ import annotations

from cramhy_runtime.languages.commonlisp.collections.characters import CHARACTER_NAMES
from cramhy_runtime.session import arglists, completion, fuzzy
from cramhy_runtime.session.completion import keywords_of_symbol

from ..rpcs import rpc, text
from ..wire import Name
from .packages import package_named

MARKER = "swank::%cursor-marker%"


def _package(call, name):
    return package_named(name) if isinstance(name, str) else call.package


def _cased(name, like):
    """``name`` in small letters, or in capitals where the user types capitals."""
    return name.upper() if like.isupper() else name.lower()


@rpc("simple-completions completions")
def completions(call, prefix, package=None):
    word = text(prefix)
    names = sorted(_cased(name, word) for name, _ in completion.completions(word, _package(call, package))[0])
    if not names:  # parts of words: (m-v-b) means multiple-value-bind
        names = sorted(_cased(name, word) for name in fuzzy.by_parts(word, _package(call, package)))
    return [names, _longest_common(names) or word]


def _longest_common(names):
    if not names:
        return ""
    first, last = min(names), max(names)
    length = next((at for at, (one, other) in enumerate(zip(first, last, strict=False)) if one != other), min(len(first), len(last)))
    return first[:length]


@rpc("fuzzy-completions")
def fuzzy_completions(call, prefix, package=None, *, limit=None, time_limit_in_msec=None):
    word = text(prefix)
    most = limit if isinstance(limit, int) and limit > 0 else 300
    found = fuzzy.completions(word, _package(call, package), most)
    shown = [[_cased(match.name, word), f"{match.score:.2f}", match.chunks, match.flags] for match in found]
    return [shown, None]


@rpc("fuzzy-completion-selected")
def fuzzy_completion_selected(call, *_):
    return None


@rpc("completions-for-keyword")
def completions_for_keyword(call, prefix, form=None):
    """The keywords that the call around the cursor takes, by the way down to it that Emacs sends."""
    word, head, taken = text(prefix), _innermost(form), None
    if head is not None:
        symbol = arglists.symbol_named(head[0], call.package)
        taken = None if symbol is None else keywords_of_symbol(symbol)
    if not taken:
        return completions(call, word)
    start = word.lstrip(":").upper()
    names = sorted(_cased(f":{name}", word) for name in taken if name.startswith(start))
    return [names, _longest_common(names) or word]


@rpc("completions-for-character")
def completions_for_character(call, prefix):
    word = text(prefix)
    names = sorted(name.capitalize() for name in CHARACTER_NAMES if name.lower().startswith(word.lower()))
    return [names, _longest_common(names) or word]


# -------------------------------------------------------------------------------------------------------------------- arglists


@rpc("operator-arglist")
def operator_arglist(call, name, package=None):
    symbol = arglists.symbol_named(text(name), _package(call, package))
    items = None if symbol is None else arglists.arglist(symbol)
    return None if items is None else arglists.call_text(text(name).lower(), items).lower()


@rpc("autodoc")
def autodoc(call, form, *, print_right_margin=None):
    """The arglist of the innermost known call around the cursor, with the argument at the cursor marked; or the value of a variable."""
    for head, before in _calls_around(form):
        symbol = arglists.symbol_named(head, call.package)
        items = None if symbol is None else arglists.arglist(symbol)
        if items is None:
            continue
        index, keyword = len(before) - 1, None
        if index >= 1 and isinstance(before[-2], str) and before[-2].startswith(":"):
            keyword = before[-2][1:]
        elif before and isinstance(before[-1], str) and before[-1].startswith(":"):
            keyword = before[-1][1:]
        place = arglists.place_of_argument(items, index, keyword) if index >= 0 else None
        return [arglists.call_text(head.lower(), [item.lower() for item in items], place, "===> ", " <==="), True]
    return [Name(":not-available"), True]


def _innermost(form):
    return next(_calls_around(form), None)


def _calls_around(form):
    """(name, arguments before and at the cursor) of the lists around the cursor, the innermost first. form: as Emacs sends it, lists of
    texts with the marker where the cursor is."""
    path = []

    def walk(part):
        if not isinstance(part, list):
            return isinstance(part, Name) and part.lower() == MARKER
        for index, item in enumerate(part):
            if walk(item):
                before = part[1:index]
                if isinstance(item, list):
                    before = part[1 : index + 1]
                path.append((part[0], before))
                return True
        return False

    walk(form)
    for head, before in path:
        if isinstance(head, str) and not isinstance(head, Name) and head:
            yield str(head), before


@rpc("complete-form")
def complete_form(call, form):
    head = _innermost(form)
    symbol = None if head is None else arglists.symbol_named(head[0], call.package)
    items = None if symbol is None else arglists.arglist(symbol)
    if items is None:
        return Name(":not-available")
    rest = [item.lower() for item in items if item not in ("&OPTIONAL", "&REST", "&BODY")][max(0, len(head[1]) - 1) :]
    return " ".join(rest) + ")"


@rpc("find-symbols-completions flex-completions")
def flex_completions(call, prefix, package=None):
    """SLY's completion: as `fuzzy_completions`, with the numbers that SLY wants."""
    found = fuzzy.completions(text(prefix), _package(call, package), 300)
    return [[[match.name.lower(), match.score, match.chunks, match.flags, None] for match in found], None]
