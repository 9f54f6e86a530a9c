"""What each of the 978 symbols of COMMON-LISP is here: the page ``docs/common-lisp.md``, made from the running image.

``make docs`` writes the page; a test holds that it is the one that the code makes.
What is there is asked of the symbols themselves; reasons for what is not come from `standard_names.ABSENT`.
"""

from __future__ import annotations

from collections import Counter

from .compiler.analyze import SPECIAL_FORMS
from .compiler.style_checks import QUALITIES, STANDARD_DECLARATIONS
from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, UndefinedFunction
from .syntax.ansi_lambda_lists import lambda_lists
from .evaluation.forms import SPECIAL_OPERATORS
from .syntax.lambda_lists import KEYWORDS
from .syntax.macros import ensure_loaded
from .objects import classes
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.dispatch.method_combination import known_combination
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol
from .standard_names import ABSENT, INSIDE
from .tools import documentation
from .types import types

HEAD = """# The symbols of Common Lisp

{there} of the {total} external symbols of the package COMMON-LISP are there. `make docs` makes this page from the code; what
differs from SBCL in behaviour is in [differences.md](differences.md). A program that uses a symbol that is not there gets the reason
when it is compiled, with its place.

{counts}

## There

"""


def kinds(symbol):
    """What ``symbol`` is, a list of words such as ``"function"``; empty when it is nothing."""
    found, name = [], symbol.name if isinstance(symbol, Symbol) else "T" if symbol else "NIL"
    if symbol in SPECIAL_OPERATORS:
        found.append("special operator")
    elif isinstance(symbol, Symbol) and (symbol.macro is not None or symbol in SPECIAL_FORMS):
        found.append("macro")
    if isinstance(symbol, Symbol) and not isinstance(symbol.function, UndefinedFunction):
        found.append("generic function" if isinstance(symbol.function, GenericFunction) else "function")
    if not isinstance(symbol, Symbol):
        found.append("constant")
    elif symbol.value is not UNBOUND:
        found.append("constant" if symbol.constant else "variable")
    if _names_type(symbol):
        found.append("class" if classes.find_class(symbol, None) is not None else "type")
    if isinstance(symbol, Symbol):
        found += [
            word
            for word, names in (
                ("lambda list keyword", KEYWORDS.values()),
                ("declaration", STANDARD_DECLARATIONS),
                ("optimization quality", QUALITIES),
                ("documentation type", documentation.KINDS),
            )
            if name in names and not (word == "documentation type" and found)
        ]
        if known_combination(symbol) is not None and not {"function", "special operator", "macro"} & set(found):
            found.append("method combination")
    if name in INSIDE and not found:
        found.append(f"{INSIDE[name][0]}, {INSIDE[name][1]}")
    return found


def _names_type(symbol):
    return is_symbol(symbol) and (types.is_known_type(symbol) or isinstance(symbol, Symbol) and symbol.name in types.COMPOUND_NAMES)


def table():
    """(name, symbol, kinds) of every symbol, in the order of the alphabet; the macros are loaded for it."""
    ensure_loaded()
    return [(name, symbol, kinds(symbol)) for name, symbol in sorted(COMMON_LISP.external.items())]


def page():
    """The text of ``docs/common-lisp.md``."""
    rows = table()
    texts = {symbol.name: text for symbol, text in lambda_lists().items()}
    there = [row for row in rows if row[2]]
    absent = [row for row in rows if not row[2]]
    counts = Counter(kind.split(",")[0] for _, _, found in there for kind in found)
    lines = ["| symbol | is |", "|---|---|"]
    for name, _, found in there:
        words = ", ".join(found)
        if "function" in words and name in texts:
            words = words.replace("function", f"function `{texts[name].lower()}`", 1)
        lines.append(f"| `{_cell(name)}` | {_cell(words)} |")
    if absent:
        lines += ["", "## Not there", "", "| symbol | why |", "|---|---|"]
    lines += [f"| `{_cell(name)}` | {_cell(ABSENT.get(name, '?'))} |" for name, _, _ in absent]
    summary = "By kind: " + ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())) + "."
    return HEAD.format(total=len(rows), there=len(there), counts=summary) + "\n".join(lines) + "\n"


def _cell(text):
    return text.lower().replace("|", "\\|") if text.isupper() else text.replace("|", "\\|")
