"""What the Tab key offers at a prompt of Lisp: symbols, operators with how they are written, keywords of the call at hand, and in a string
names of files."""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.packages import KEYWORD, find_package, symbol_name
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.hy.brackets import open_brackets
from cramhy_runtime.languages.operators import operator_of
from .arglists import lambda_list_in_call
from .boot import boot

_WORD = re.compile(r"""[^\s()'"`,;]*$""")
_HEAD = re.compile(r"""\(([^\s()\[\]{}'"`,;]+)\s""")


def completions(text, package=None):
    """(name, what is known of it) for each symbol that the last word of ``text`` may become, and the length of that word.

    text: what has been typed of a form up to the cursor. package: the current one, unless another is given. A word with a prefix,
    ``cpl:pa``, is completed with names of that package. ``:na`` is completed with keywords of the call that it stands in, or, where
    these are not known, with all keywords.
    """
    boot()  # the first key at a prompt may be TAB
    word = _WORD.search(text.rpartition("#'")[2]).group()
    package = package or evaluator.PACKAGE.value
    prefix, colons, short = word.rpartition(":")
    if colons and not prefix:
        known = keywords_at_hand(text, lambda name: keywords_of_symbol(_find(name, package)))
        names = KEYWORD.external if known is None else known
        return sorted((f":{name.lower()}", "") for name in names if name.startswith(short.upper())), len(word)
    home = find_package(prefix.rstrip(":").upper()) if colons else package
    if home is None or not word:
        return [], len(word)
    found = {}
    for table in _tables(home, inside=not colons or prefix.endswith(":")):
        for name, symbol in table.items():
            if name.startswith(short.upper()):
                found.setdefault(word[: len(word) - len(short)] + name.lower(), _known(symbol))
    return sorted(found.items()), len(word)


def _tables(package, inside):
    yield package.external
    if inside:
        yield package.internal
        for used in package.use:
            yield used.external


def _known(symbol):
    """How an operator is written and what it does, or ``""``."""
    operator = operator_of(symbol)
    return "" if operator is None else f"{operator.shape}  {operator.documentation}"


# ---------------------------------------------------------------------------------------------------------------- keywords


class Keywords(list):
    """The names of the keywords that a call takes. ``of_operator``: an operator's, which takes apart the list behind its name, too."""

    def __init__(self, names, of_operator=False):
        super().__init__(names)
        self.of_operator = of_operator


def keywords_at_hand(text, keywords_of):
    """The `Keywords` that may stand at the end of ``text``; ``None`` if nothing is known of the calls around it.

    keywords_of: a function of the name of an operator or a function, which gives its `Keywords`, or ``None`` if it does not know that name.
    The innermost call that is known counts. What an operator takes apart itself, ``(with-task-suspended (task :reason ...))``, is no call.
    """
    lines = re.sub(r"#\\.", "  ", text).split("\n")
    inner = None  # those of the list that begins right behind the name
    for _, line, column in reversed(open_brackets("\n".join(lines))):
        rest = "\n".join([lines[line - 1][column - 1 :], *lines[line:]])
        head = _HEAD.match(rest)
        keywords = keywords_of(head[1]) if head else None
        if inner is not None and not (keywords and keywords.of_operator and rest[head.end() :].lstrip() == inner[1]):
            return inner[0]
        if keywords is not None:
            inner = keywords, rest
    return inner and inner[0]


def keywords_of_symbol(symbol):
    """The `Keywords` that a call of ``symbol`` takes; ``None`` if it is neither an operator, a macro nor a function."""
    operator = operator_of(symbol)
    if operator is not None:
        return Keywords(operator.options, of_operator=True)
    macro = getattr(symbol, "macro", None)
    function = getattr(symbol, "function", None)
    if macro is None and (function is None or isinstance(function, UndefinedFunction)):
        return None
    return _keywords_in(lambda_list_of(macro) if macro is not None else lambda_list_in_call(symbol, function))


def _keywords_in(lambda_list):
    """The `Keywords` that a lambda list names."""
    found, after_key = Keywords([]), False
    while isinstance(lambda_list, Cons):
        item, lambda_list = lambda_list.car, lambda_list.cdr
        name = item.car if isinstance(item, Cons) else item
        name = name.car if isinstance(name, Cons) else name  # ((:key variable) default)
        if isinstance(item, Symbol) and item.name.startswith("&"):
            after_key = item.name == "&KEY"
        elif after_key and isinstance(name, (Symbol, Keyword)):
            found.append(symbol_name(name))
    return found


def _find(name, package):
    """The symbol that ``name`` means in ``package``, or ``None``."""
    prefix, colons, short = name.upper().rpartition(":")
    home = find_package(prefix.rstrip(":")) if colons else package
    return None if home is None else home.lookup(short)[0]
