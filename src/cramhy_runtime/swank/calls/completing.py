"""Calls while the user types: completion and arglists."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNBOUND, Symbol
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.printing import attempt_to_print, prin1_to_string
from cramhy_runtime.languages.commonlisp.collections.characters import CHARACTER_NAMES
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_LENGTH, PRINT_LEVEL
from cramhy_runtime.session import arglists, completion, fuzzy
from cramhy_runtime.session.completion import keywords_of_symbol

from ..rpcs import rpc, text
from ..wire import Name
from .packages import package_named

MARKER = "swank::%cursor-marker%"
LONGEST_VALUE = 100  # characters of the value of a variable in the echo area


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
    around = Around(form)
    value = _value_of_variable(around.word, call.package)
    if value is not None:
        return [value, None]  # it may change: Emacs must not keep it
    for head, before in around.calls:
        items = around.local.get(head.upper()) or _arglist(head, call.package)
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


def _arglist(name, package):
    symbol = arglists.symbol_named(name, package)
    return None if symbol is None else arglists.arglist(symbol)


def _value_of_variable(word, package):
    """``*SPEED* => 5`` for the name of a global variable, else ``None``."""
    symbol = arglists.symbol_named(word, package) if word else None
    if not isinstance(symbol, Symbol) or symbol.value is UNBOUND or not symbol.special or arglists.is_callable(symbol):
        return None
    with binding(PRINT_LENGTH, 10, PRINT_LEVEL, 4):
        shown = attempt_to_print(prin1_to_string, symbol.value)
    text = " ".join(f"{symbol.name} => {shown}".split())
    return text if len(text) <= LONGEST_VALUE else text[: LONGEST_VALUE - 3] + "..."


def _innermost(form):
    return next(iter(Around(form).calls), None)


class Around:
    """The lists around the cursor. form: as Emacs sends it, lists of texts with the marker where the cursor is.

    calls: [(name, arguments before and at the cursor)] of the lists that can be calls, the innermost first. local: {name: arglist} of the
    functions of ``flet`` and ``labels`` around it. word: the text that ends at the cursor, or ``None``.
    """

    def __init__(self, form):
        self.calls, self.local, self.word = [], {}, None
        chain = []  # (list, which of its elements leads to the cursor), the outermost first
        while isinstance(form, list):
            at = next((index for index, item in enumerate(form) if _leads_to_cursor(item)), None)
            if at is None:
                break
            chain.append((form, at))
            form = form[at]
        for depth, (items, at) in enumerate(chain):
            head = items[0]
            if not isinstance(head, str) or isinstance(head, Name) or not head:
                continue
            if _bare(head) in LOCAL_FUNCTIONS and len(items) > 1 and isinstance(items[1], list):
                self.local.update(_local_functions(items[1]))
            if not _is_no_call(chain[:depth]):
                self.calls.insert(0, (str(head), items[1 : at + isinstance(items[at], list)]))
        if chain and chain[-1][1] > 0:
            items, at = chain[-1]
            word = items[at - 1]
            self.word = str(word) if isinstance(word, str) and not isinstance(word, Name) else None


def _leads_to_cursor(item):
    if isinstance(item, list):
        return any(map(_leads_to_cursor, item))
    return isinstance(item, Name) and item.lower() == MARKER


def _bare(name):
    return name.rpartition(":")[2].upper()


LOCAL_FUNCTIONS = {"FLET", "LABELS", "MACROLET"}
BINDINGS = {*LOCAL_FUNCTIONS, *"LET LET* PROG PROG* DO DO* SYMBOL-MACROLET HANDLER-BIND RESTART-BIND WITH-FAILURE-HANDLING".split()}
"""Operators whose first argument is a list of lists that are no calls."""
CLAUSES = {*"CASE ECASE CCASE TYPECASE ETYPECASE CTYPECASE HANDLER-CASE RESTART-CASE".split()}
"""Operators whose arguments behind the first are lists that are no calls."""
LAMBDA_LISTS = {"DEFUN": 2, "DEFMACRO": 2, "DEFMETHOD": 2, "DEFGENERIC": 2, "LAMBDA": 1, "DEF-CRAM-FUNCTION": 2, "DEFTYPE": 2}


def _is_no_call(outer):
    """Whether a list in ``outer``, the lists around it with the positions that lead to it, is a binding, a clause or a lambda list."""

    def stands_in(level, operators, first=1):
        if len(outer) < level:
            return False
        items, at = outer[-level]
        name = _bare(items[0]) if isinstance(items[0], str) else None
        return at == operators.get(name) if isinstance(operators, dict) else name in operators and at >= first

    if stands_in(1, LAMBDA_LISTS) or stands_in(1, CLAUSES, 2):
        return True
    if len(outer) > 1 and outer[-2][1] == 1 and stands_in(2, BINDINGS):
        return True
    return len(outer) > 2 and outer[-1][1] == 1 and outer[-3][1] == 1 and stands_in(3, LOCAL_FUNCTIONS)


def _local_functions(definitions):
    """{name: arglist} of the ``definitions`` of ``flet``, as Emacs sends them."""
    return {
        str(each[0]).upper(): [_text_of(item).upper() for item in each[1] or ()]
        for each in definitions
        if isinstance(each, list) and len(each) > 1 and isinstance(each[0], str) and isinstance(each[1], (list, type(None)))
    }


def _text_of(item):
    return f"({' '.join(map(_text_of, item))})" if isinstance(item, list) else str(item)


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
