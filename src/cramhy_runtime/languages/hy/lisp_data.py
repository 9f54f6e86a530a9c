"""Hy models as Lisp data, and Lisp data in Hy code.

Names in designators, facts and quoted arguments are symbols of Lisp, upcased, in the package of the Hy module: its own, which uses the
packages of the plan language, or the one that ``(lisp-package :tut)`` chose. So a plan in Hy and one in Common Lisp speak of the same
process modules, facts and designators.
"""

from __future__ import annotations

import re

import hy
from hy import models

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.packages import common, find_package, find_package_or_error, intern, make_package, named_package, symbol_name
from cramhy_runtime.kernel.images import per_image
from ..commonlisp.syntax.hy_models import atom
from ..operators import BRANCHES, PLAN_LANGUAGE

USED = (
    "CRAM-PROLOG",
    "CRAM-LANGUAGE",
    "CRAM-DESIGNATORS",
    "CRAM-PROCESS-MODULES",
    "CRAM-EXECUTIVE",
    "CRAM-UTILITIES",
    "CRAM-LANGUAGE-DESIGNATOR-SUPPORT",
    "ROSLISP",
    "ROSLISP-UTILS",
    "ROSLISP-UTILITIES",
    "CL-TRANSFORMS",
)
"""The packages that the package of a Hy module uses. Where two of them have different symbols of one name, the first counts."""

DESIGNATORS = ("A", "AN", "ALL")
"""The operators that make designators."""

_chosen: dict[str, str] = per_image({})
"""Module → the package that it chose."""

_constants: dict[str, object] = per_image({})
"""Text → the Lisp object that it means, for the constants of Hy code."""


def package_of(module):
    """The Lisp package of the Hy module of that name; it is made when there is none."""
    return plan_package(package_name(module))


def package_name(module):
    """The name of that package."""
    return _chosen.get(module) or default_package_name(module)


def default_package_name(module):
    """``turtlesim_in_hy.control`` has the package TURTLESIM-IN-HY, as all modules of a Python package; a program HY-USER."""
    if module in ("__main__", "__console__", "builtins"):
        return "HY-USER"
    return module.partition(".")[0].replace("_", "-").upper()


def choose_package(module, name):
    """Let the symbols of a Hy module be those of the package ``name``, which is made if there is none."""
    _chosen[module] = name.upper()
    return plan_package(name.upper())


def plan_package(name):
    """The package ``name``; a new one uses the packages of the plan language."""
    package = named_package(name)
    if package is None:
        package = make_package(name)
        package.use = [used for used in map(find_package, USED) if used is not None]
        package.use.append(find_package_or_error("COMMON-LISP"))
    return package


def symbol_of(text, package):
    """The symbol, or the object NIL or T, that a name of Hy means in ``package``; ``cpl:par`` is one of CRAM-LANGUAGE."""
    prefix, colons, name = text.partition("::") if "::" in text else text.partition(":")
    if colons and prefix and name:
        return intern(name.upper(), find_package_or_error(prefix.upper()).name)
    if text in ("None", "False", "nil"):
        return None
    if text in ("True", "t"):
        return True
    return package.intern(text.upper())


def lisp_data(model, package):
    """The Lisp object that a Hy model means as data: brackets and parentheses are lists, names are symbols of ``package``. A model that was
    made by Hy's own backquote may have lists of Python in it."""
    if isinstance(model, (models.Expression, models.List, models.Tuple)) or type(model) in (list, tuple):
        refuse_code(model)
        items = list(model)
        if len(items) > 2 and items[-2] == models.Symbol(".") and items[0] != models.Symbol("."):
            return list_from([lisp_data(item, package) for item in items[:-2]], lisp_data(items[-1], package))
        return list_from([lisp_data(item, package) for item in items])
    if isinstance(model, models.Symbol):
        return symbol_of(str(model), package)
    data = atom(model)
    if isinstance(data, models.Object):  # a set, a dictionary, an f-string, bytes
        raise ValueError(f"{_plural(model)} are no Lisp data; write a list, a name, a keyword, a string or a number")
    return data


def refuse_code(model):
    """Raise ValueError if a model is read as a list, and looks as if it were evaluated: ``~n`` without a backquote, ``?pose.x``."""
    if is_call_of("unquote", model) or is_call_of("unquote-splice", model):
        raise ValueError(f"{written(model)} is evaluated in a template only, behind a backquote: `(a ~b)")
    if is_dotted(model) and len(model) == 3 and find_package(str(model[1]).upper()) is not None:
        raise ValueError(f"{written(model)}: a colon stands between a package of Lisp and a name of it, as in {model[1]}:{model[2]}")
    if is_dotted(model) and str(model[1]) != "None":
        raise ValueError(f"{written(model)} is no Lisp data: attributes are not evaluated in it; give the value a variable first")


def is_dotted(model):
    """Whether a model is an attribute, ``pose.x``."""
    return isinstance(model, models.Expression) and len(model) > 2 and model[0] == models.Symbol(".")


def own_symbol(symbol):
    """``symbol``, or one of that name in no package if it is Lisp's or ours: a function ``list`` of Hy must not be that of Lisp."""
    built_in = symbol.package is not None and symbol.package.built_in
    return Symbol(symbol.name) if built_in else symbol


def refuse_code_in_designator(parts):
    """Raise ValueError if in the parts of a designator, or deeper, stands code: only ``?variables`` are evaluated there."""
    for model in parts:
        code = isinstance(model, (models.FString, models.Dict, models.Set, models.Bytes))
        dotted = is_dotted(model)
        if code or dotted or is_call_of("unquote", model) or is_call_of("unquote-splice", model):
            value = hy.repr(model[1]).removeprefix("'") if is_call_of("unquote", model) else written(model)
            kind = _KINDS.get(type(model), "attribute" if dotted else "~ without a backquote")
            raise ValueError(
                f"{written(model)} is not evaluated in a designator ({kind}): only ?variables are. "
                f"Write (let [?value {value}] ...) around it, and ?value in its place."
            )
        if isinstance(model, models.Sequence):
            refuse_code_in_designator(model)


def refuse_case(model, names=None):
    """Raise ValueError if two names in a list of Lisp data differ by case only: Lisp has one symbol for both."""
    names = {} if names is None else names
    if isinstance(model, models.Symbol):
        other = names.setdefault(str(model).upper(), str(model))
        if other != str(model):
            raise ValueError(f"{other} and {model} differ by case only, and to Lisp they are one name; give one of them another name")
    elif isinstance(model, (models.Expression, models.List, models.Tuple)):
        if not (is_call_of("unquote", model) or is_call_of("unquote-splice", model)):
            for part in model:
                refuse_case(part, names)


_KINDS = {models.FString: "f-string", models.Dict: "dict", models.Set: "set", models.Bytes: "bytes"}


def _plural(model):
    kind = _KINDS.get(type(model), type(model).__name__.lower())
    return kind if kind.endswith("s") else kind + "s"


def written(model):
    """How a user writes ``model``."""
    return hy.repr(model).removeprefix("'")


def inserted(value, package):
    """The Lisp object that a value of Hy stands for inside of Lisp data: lists of Python and Hy's models become lists and symbols of
    Lisp, ``package`` being the name of the package of these symbols; any other object stays."""
    return lisp_data(value, plan_package(package)) if isinstance(value, (models.Object, list, tuple)) else value


# --------------------------------------------------------------------------------------------------------------- backquotes


def is_quoted(model):
    """Whether a model is data as it stands, ``'(a b)``."""
    return is_call_of("quote", model)


def is_backquoted(model):
    """Whether a model is a template, `` `(a ~b)``."""
    return is_call_of("quasiquote", model)


def is_call_of(name, model):
    """Whether ``model`` is ``(name part)``."""
    return isinstance(model, models.Expression) and len(model) == 2 and model[0] == models.Symbol(name)


def template_form(model, package, functor=None):
    """A Hy form for the Lisp data that a template means: what stands behind ``~`` is evaluated, what stands behind ``~@`` is spliced in.

    functor: in the template of a goal, the Hy form for the functor of the goal around; ``NO_FUNCTOR`` where there is none.
    """
    if is_call_of("unquote", model):
        return insertion("inserted" if functor is None else "in-goal", model[1], package, functor)
    if not _has_insertions(model):
        return constant_form(lisp_data(model, package))
    items, tail = list(model), None
    if functor is not None:
        functor = _functor_of(items, package, functor)
    if len(items) > 2 and items[-2] == models.Symbol(".") and items[0] != models.Symbol("."):
        items, tail = items[:-2], items[-1]
    parts = [_part(item, package, functor) for item in items]
    if tail is None:
        return models.Expression([call_of("lisp-list"), *parts])
    return models.Expression([call_of("lisp-list-ending"), template_form(tail, package, functor), *parts])


NO_FUNCTOR = models.Symbol("None")


def _functor_of(items, package, outer):
    """The Hy form for the functor of a list in a goal: its first symbol. What a function gets is the function's at any depth."""
    if not isinstance(items[0], models.Symbol):
        return outer if _is_functions(outer) else NO_FUNCTOR
    found = symbol_of(str(items[0]), package)
    return outer if _is_functions(outer) or not isinstance(found, Symbol) else constant_form(found)


def _is_functions(functor):
    return any(str(part).endswith(("|LISP-FUN|", "|LISP-PRED|")) for part in functor) if isinstance(functor, models.Expression) else False


def _part(item, package, functor):
    if is_call_of("unquote-splice", item):
        spliced = insertion("spliced" if functor is None else "spliced-in-goal", item[1], package, functor)
        return models.Expression([models.Symbol("unpack-iterable"), spliced])
    return template_form(item, package, functor)


def insertion(function, code, package, *functor):
    """A Hy form that evaluates ``code`` and makes Lisp data of its value, by the function of `calls` that is named."""
    return models.Expression([call_of(function), code, models.String(package.name), *(each for each in functor if each is not None)])


def _has_insertions(model):
    if isinstance(model, (models.Expression, models.List, models.Tuple)):
        return is_call_of("unquote", model) or is_call_of("unquote-splice", model) or any(map(_has_insertions, model))
    return False


# --------------------------------------------------------------------------------------------------------------- constants


def is_simple(data):
    """Whether ``data`` is an object that Hy can write itself."""
    return data is None or data is True or type(data) in (str, int, float)


def constant_form(data):
    """A Hy form for the Lisp object ``data``; the same object each time it is evaluated in an image."""
    if is_simple(data):
        return models.as_model(data)
    find = _CONSTANT if _is_shared(data) else call_of("constant")
    return models.Expression([find, models.String(text_of(data))])


def _is_shared(data):
    """Whether all images share an object: each has its own symbols of the users' packages."""
    while isinstance(data, Cons):
        if not _is_shared(data.car):
            return False
        data = data.cdr
    return not isinstance(data, Symbol) or common(data)


_OURS, _CONSTANT = (models.Expression(map(models.Symbol, (".", "hy", "R", "cramhy", name))) for name in ("_ours", "_constant"))
"""The macros of `module_names`."""


BRANCHING = frozenset(name for name, operator in PLAN_LANGUAGE.items() if BRANCHES in operator.marks)
"""The functions of CRAMHY that raise what a branch failed with: in Hy it is the exception that the branch raised."""

GOALS = ("PROLOG", "RETE-ASSERT", "RETE-RETRACT", "RETE-HOLDS", "RETE-PROVE")
"""Functions whose first argument is a goal, a fact or a pattern of facts, or a list of them."""
GIVE_LISTS = {
    "CRAM-PROLOG": ("PROLOG", "RETE-HOLDS", "RETE-PROVE"),
    "CRAM-UTILITIES": (
        "FORCE-LL",
        "LAZY-APPEND",
        "LAZY-CDR",
        "LAZY-FILTER",
        "LAZY-FLATTEN",
        "LAZY-MAPCAN",
        "LAZY-MAPCAR",
        "LAZY-RESTS",
        "LAZY-SKIP",
        "LAZY-TAKE",
    ),
    "CRAM-DESIGNATORS": ("DESIG-PROP-VALUES", "GET-ALL-DESIGNATORS"),
}
"""Package → the functions that give a list: ``nil`` is an empty one for Hy."""
TAKE_LISTS = {"CRAM-UTILITIES": ("LAZY-CAR", "LAZY-ELT", "LAZY-FOLD", "LAZY-LIST-P")}
"""Package → the functions that only take lists."""


def is_about_lists(package, name):
    """Whether Hy calls the function ``name`` of ``package`` by `list_function`."""
    return name in GIVE_LISTS.get(package, ()) or name in TAKE_LISTS.get(package, ())


FOR_PYTHON = {
    ("CRAM-LANGUAGE", "WAIT-FOR"): "wait-for",
    ("CRAM-LANGUAGE-IMPLEMENTATION", "WAIT-FOR"): "wait-for",
    ("ROSLISP", "CALL-SERVICE"): "call-service",
    ("ROSLISP", "PUBLISH"): "publish-message",
    ("ROSLISP", "SUBSCRIBE"): "subscribe-to",
    ("ROSLISP", "GET-PARAM"): "get-param",
    ("ROSLISP", "SET-PARAM"): "set-param",
    ("ROSLISP", "HAS-PARAM"): "has-param",
}
"""Functions that ask more of their arguments, or give other values, in Hy and Python than in Lisp → their names in ``calls``."""


def call_of(name):
    """A Hy form for what `calls` calls ``name``."""
    return _ours("calls", name)


def _ours(*path):
    return models.Expression([_OURS, *map(models.Symbol, path)])


def function_form(package, name):
    """A Hy form for the function that a symbol of a package of ours names now, or for the one that Python has in its place."""
    if (package, name) in FOR_PYTHON:
        return call_of(FOR_PYTHON[package, name])
    if name != name.upper() or "_" in name or "." in name or "." in package:
        return models.Expression([call_of("function"), models.String(package), models.String(name)])
    if is_about_lists(package, name):
        return _ours("calls", "lists", package.lower(), name.lower())
    if package == "CRAMHY" and name in BRANCHING:
        return _ours("branching", name.lower())
    symbol = _ours("symbols", package.lower(), name.lower())
    return models.Expression([models.Symbol("."), symbol, models.Symbol("function")])


def text_of(data):
    """``data`` in Lisp's syntax, whole: floats with all digits, symbols with their packages."""
    if isinstance(data, Cons):
        parts = []
        while isinstance(data, Cons):
            parts.append(text_of(data.car))
            data = data.cdr
        if data is not None:
            parts += [".", text_of(data)]
        return "(" + " ".join(parts) + ")"
    if data is None:
        return "NIL"
    if data is True:
        return "T"
    if isinstance(data, str):
        return '"' + data.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(data, Keyword):
        return ":" + _bars(data.name)
    if isinstance(data, Symbol):
        return _bars(data.package.name) + "::" + _bars(symbol_name(data))
    return repr(data)


def _bars(name):
    return "|" + name.replace("\\", "\\\\").replace("|", "\\|") + "|"


def constant(text):
    """The Lisp object that ``text`` means, the same one each time in an image."""
    found = _constants.get(text, _constants)
    if found is _constants:
        found = _constants[text] = _read(text)
    return found


def _read(text):
    from ..commonlisp.reader.reader import Reader  # a program whose constants are all simple needs no reader

    return Reader(_with_packages(text), filename="<constant>").read()


def _with_packages(text):
    for name in re.findall(r"\|([^|]*)\|::", text):
        plan_package(name)
    return text
