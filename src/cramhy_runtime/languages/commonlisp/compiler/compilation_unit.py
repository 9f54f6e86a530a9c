"""Compilation units: what the compiler noticed, told when it can be known.

Some things are certain as soon as a form has been compiled: a variable that nobody uses, a declaration that nobody knows. Whether a
function exists is known only at the end of the file or system, because it may be defined below its first call. So the compiler
enters its mentions of functions in a `CompilationUnit`; the outermost unit looks at them when it ends.

What is found is a condition, WARNING or STYLE-WARNING, signalled with the restart ``muffle-warning``, so ``handler-bind`` around
``load`` or ``compile`` sees it. What nobody muffled is shown at the end of the unit in the order of the text. A file, a system,
a form typed at the prompt and ``with-compilation-unit`` are units; inner ones join the outer one (ANSI 3.2.5).
Nothing is compiled only in order to warn: a file whose compiled form was kept is silent. Source of the texts: SBCL.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.condition_types import shown_with
from cramhy_runtime.lisp_core.conditions import Condition, SimpleStyleWarning, SimpleWarning, matches, signal_condition, with_simple_restart
from cramhy_runtime.lisp_core.data import Cons, Symbol, UndefinedFunction, lisp_list, python_list
from cramhy_runtime.lisp_core.dynamic import bind, special, unbind
from cramhy_runtime.lisp_core.equality import eql_key
from cramhy_runtime.lisp_core.packages import COMMON_LISP, sym
from ..packages.package_errors import PACKAGE
from cramhy_runtime.lisp_core.ports import PORTS
from ..syntax.ansi_lambda_lists import standard_shape
from ..syntax.function_shapes import shape_of, wrong_call
from cramhy_runtime.lisp_core.source_places import frame_position, is_user_file
from .follow_up_warnings import inside, without_consequences

CURRENT = special("CRAMHY::*COMPILATION-UNIT*")
MUFFLED = special("CRAMHY::*MUFFLED-CONDITIONS*", ())
"""Types of conditions that ``(declaim (sb-ext:muffle-conditions ...))`` silenced, a tuple."""


class Mention:
    """A place where a function is called or named. ``arguments``: the forms of a call; ``None`` for ``#'f``. ``call``: where the text of
    the call is, (file, line, column, end line, end column), or ``None``.

    position: (file, line, column), ``None``, or a function that returns it, which is called when a warning shows it.
    """

    __slots__ = ("name", "arguments", "_position", "muffled", "call")

    def __init__(self, name, arguments, position, muffled, call=None):
        self.name, self.arguments, self._position, self.muffled, self.call = name, arguments, position, muffled, call

    @property
    def position(self):
        if callable(self._position):
            self._position = self._position()
        return self._position


class CompilationUnit:
    """What has been noticed and not yet been shown. ``kind``: "form", "file" or "explicit" (``with-compilation-unit``)."""

    def __init__(self, kind="form"):
        self.kind = kind
        self.expansions = []  # (form, place, Python frame of the compiler) of the macro calls that are being expanded
        self.mentions = []
        self.types = []
        self.defined = {}  # name → Shape of the function that this unit defines, None if it is not known
        self.places = {}  # name → where it was defined
        self.told = []
        self.texts = {}  # file name → `FormPlaces` of its text, if there are wrong parentheses in it
        self.level = 0  # how many texts joined this unit

    # ------------------------------------------------------------------------------------------------------------ telling

    def tell(self, kind, control, *arguments, position=None, muffled=(), **notes):
        """Signal a warning; it will be shown unless a handler or a declaration muffles it."""
        condition = kind(control, *arguments)
        condition.position, condition.package = position or (self.expansions[-1][1] if self.expansions else None), PACKAGE.value
        for name, value in notes.items():
            setattr(condition, name, value)
        if any(matches(condition, specifier) for specifier in (*muffled, *MUFFLED.value)):
            return

        def signal():
            signal_condition(condition)
            self.told.append(condition)

        with_simple_restart(sym("MUFFLE-WARNING"), "Skip warning.", signal)

    def define(self, name, shape, position):
        """Note that the text being compiled defines the function ``name``, a symbol or ``("setf", symbol)``."""
        if shape is not None or name not in self.defined:
            self.defined[name] = shape
        if position is not None:
            first = self.places.setdefault(name, position)
            return first if first != position and first[0] == position[0] else None
        return None

    # ----------------------------------------------------------------------------------------------------------- settling

    def settle(self, undefined=True, start=0):
        """Look at the mentions from the one numbered ``start``: wrong calls, and functions that are still ``undefined``."""
        missing, left = {}, []
        mentions, self.mentions = self.mentions[start:], self.mentions[:start]
        for mention in mentions:
            known = self.knows(mention.name)
            if known:
                self._check(mention)
            elif undefined:
                missing.setdefault(mention.name, []).append(mention)
            else:
                left.append(mention)
        self.mentions += left
        if undefined:
            types, self.types = self.types, []
            for mention in types:
                if not PORTS.types.known(mention.name):
                    self.tell(
                        SimpleStyleWarning,
                        "undefined type: ~A",
                        shown_with(mention.name, "KEYWORD"),
                        position=mention.position,
                        muffled=mention.muffled,
                        name=mention.name,
                        undefined="type",
                    )
        for name, places in missing.items():
            self._undefined(name, places)

    def knows(self, name):
        """Whether there is a function (macro, special operator) ``name``, or this unit defines one."""
        if name in self.defined:
            return True
        if isinstance(name, tuple):
            return name[1].setf_function is not None
        return name.macro is not None or not isinstance(name.function, UndefinedFunction)

    def _check(self, mention):
        name = mention.name
        if mention.arguments is None or not isinstance(name, Symbol):
            return
        shape = self.defined.get(name) or standard_shape(name) or shape_of(name.function)
        if shape is not None:
            kind = SimpleWarning if name.package is COMMON_LISP else SimpleStyleWarning
            for control, *rest in wrong_call(name, shape, mention.arguments):
                self.tell(kind, control, *rest, position=mention.position, muffled=mention.muffled)

    def _undefined(self, name, mentions):
        first, *others = mentions
        shown = lisp_list(sym("SETF"), name[1]) if isinstance(name, tuple) else name
        also = [mention.position for mention in others if mention.position is not None and mention.position != first.position]
        self.tell(
            SimpleStyleWarning,
            "undefined function: ~A",
            shown_with(shown, "KEYWORD"),
            position=first.position,
            muffled=first.muffled,
            name=shown,
            undefined="function",
            also=also,
            calls=[mention.call for mention in mentions if mention.call is not None],
        )

    def finish(self):
        """Look at all that is known and show what was found, unless this unit is a part of what is still being loaded."""
        if self.level == 1:
            self.settle()
            self.show()

    # ------------------------------------------------------------------------------------------------------------ showing

    def show(self):
        """Show what was told and not muffled, in the order of the text."""
        told, self.told = self.told, []
        if told:
            shown = without_consequences(sorted(told, key=_order), self.in_doubt)
            if shown:
                REPORTING.report(shown)

    def in_doubt(self, position):
        """Whether ``position`` is in a form whose parentheses are wrong."""
        places = self.texts.get(position[0]) if position else None
        return places is not None and places.in_doubt(position[1], position[2] or 0)

    def failed(self, filename, extent):
        """The top-level form at ``extent``, (line, column, end line, end column), has failed, and the failure is told: forget what was
        noticed in it."""
        form = (filename, extent[0], extent[1] - 1, *extent[2:])
        self.told = [condition for condition in self.told if not inside(condition.position, form)]
        self.mentions = [mention for mention in self.mentions if not inside(mention.position, form)]


def _order(condition):
    position = getattr(condition, "position", None) or ("", 0, 0)
    return (position[1], position[2] or 0)


def current():
    """The innermost compilation unit, or ``None``."""
    return CURRENT.value


class compilation_unit:
    """``with compilation_unit(kind) as unit:`` makes a unit, or joins the one there is. What it found is shown at its end.

    A "form", which ``eval`` or ``compile`` compiles while the program runs, joins no file: that can be about something else.
    A "file" (or system) joins no form. override: make a new one in any case, as ``(with-compilation-unit (:override t) ...)``.
    """

    def __init__(self, kind, override=False):
        self.kind, self.override = kind, override
        self.made = False

    def __enter__(self):
        unit = CURRENT.value
        if unit is None or self.override or unit.kind == "form" or (self.kind == "form" and unit.kind == "file"):
            unit = CompilationUnit(self.kind)
            bind(CURRENT, unit)
            self.made = True
        unit.level += 1
        return unit

    def __exit__(self, kind, exception, traceback):
        unit = CURRENT.value
        unit.level -= 1
        if not self.made:
            return
        try:
            if kind is None:
                unit.settle()
        finally:
            unbind()
            unit.show()


class expanding:
    """``with expanding(unit, form, place):`` is around the expansion of the macro call ``form``, so that what fails or warns in it
    knows the call; ``unit`` may be ``None``."""

    __slots__ = ("unit", "entry")

    def __init__(self, unit, form, place):
        self.unit, self.entry = unit, (form, place)

    def __enter__(self):
        if self.unit is not None:
            self.unit.expansions.append((*self.entry, sys._getframe(1)))

    def __exit__(self, kind, exception, traceback):
        if self.unit is not None:
            self.unit.expansions.pop()
        if isinstance(exception, Condition):
            if getattr(exception, "position", None) is None:
                exception.position = self.entry[1]
            if getattr(exception, "expanding", None) is None:
                exception.expanding = self.entry


def expansion_place():
    """The place of the innermost macro call that is being expanded, or ``None``."""
    unit = CURRENT.value
    return unit.expansions[-1][1] if unit is not None and unit.expansions else None


def signalling_position():
    """Where in the user's text the code is that runs now: its innermost frame, or the macro call that is expanded further inside.

    A frame in code that a macro made of nothing the user wrote has column 0; then the one that called it tells more.
    """
    unit = CURRENT.value
    _, place, compiling = unit.expansions[-1] if unit is not None and unit.expansions else (None, None, None)
    frame, made_by_macro = sys._getframe(1), None
    while frame is not None:
        if frame is compiling and place is not None:
            return place
        if is_user_file(frame.f_code.co_filename):
            position = frame_position(frame)
            if position[2] != 0:
                return position
            made_by_macro = made_by_macro or position
        frame = frame.f_back
    return made_by_macro


def mention_type(specifier):
    """Note that the macro call being expanded names types; those that are undefined at the end of the unit are warned of."""
    unit = CURRENT.value
    name = specifier.car if isinstance(specifier, Cons) else specifier
    if isinstance(specifier, Cons) and isinstance(name, Symbol) and name.package is COMMON_LISP:
        for part in python_list(specifier.cdr) if name.name in ("AND", "OR", "NOT") else ():
            mention_type(part)
    elif unit is not None and isinstance(name, Symbol) and not PORTS.types.known(name):
        unit.types.append(Mention(name, None, expansion_place(), ()))


def mention_definitions(names):
    """Note that the macro call being expanded defines functions of these ``names``, symbols or ``("setf", symbol)``.

    Forms in it may call them.
    """
    unit = CURRENT.value
    if unit is not None:
        for name in names:
            unit.define(name, None, None)


def noticing(thunk):
    """(value of ``thunk``, the warnings that compiling in it gave and nobody muffled)."""
    with compilation_unit("form") as unit:
        told, mentions = len(unit.told), len(unit.mentions)
        value = thunk()
        unit.settle(undefined=False, start=mentions)
        return value, unit.told[told:]


def with_compilation_unit(thunk, *, override=None, policy=None, source_plist=None, source_namestring=None):
    """``with-compilation-unit``: the values of ``thunk``; warnings about undefined functions wait for its end."""
    with compilation_unit("explicit", override not in (None, False)):
        return thunk()


def warn_of(kind, control, *arguments):
    """Tell what a macro found wrong with its call while it was expanded: a warning of class ``kind`` with the place of the call."""
    if CURRENT.value is not None:
        CURRENT.value.tell(kind, control, *arguments)


def duplicate_keys(operator, clauses):
    """Warn of keys that occur in two clauses of a ``case`` form: the second never applies."""
    seen = {}
    for clause in clauses:
        bare = clause.car is None or operator == "CASE" and (clause.car is True or clause.car is sym("OTHERWISE"))  # these are no keys
        keys = clause.car if isinstance(clause.car, Cons) else () if bare else (clause.car,)
        for key in keys:
            known = eql_key(key)
            if known in seen and seen[known] is not clause:
                warn_of(
                    SimpleStyleWarning,
                    "Duplicate key ~S in ~S form, occurring in the first clause:~%  ~S, and the second clause:~%  ~S.",
                    key,
                    sym(operator),
                    seen[known],
                    clause,
                )
            seen.setdefault(known, clause)


class _Reporting:
    """What is done with the warnings of a unit: ``report(conditions)``. ``usual`` is what stands above the compiler gives."""

    def __init__(self):
        self.usual = self.report = lambda conditions: None
        self.failed = lambda problem: None


REPORTING = _Reporting()


def report_to(function):
    """Let ``function(conditions)`` have the warnings of units, ``None``: the usual one; returns the one before."""
    before, REPORTING.report = REPORTING.report, function or REPORTING.usual
    return before


def report_errors_to(function):
    """Let ``function(condition)`` hear of the errors that ``compile-file`` meets and goes past; returns the one before."""
    before, REPORTING.failed = REPORTING.failed, function
    return before


def usually_report_to(function):
    """Let ``function(conditions)`` have the warnings where nobody else wants them."""
    REPORTING.usual = REPORTING.report = function


def muffle(types, quiet=True):
    """``(declaim (muffle-conditions ...))``, and with ``quiet`` false its opposite."""
    for specifier in types or ():
        without = tuple(other for other in MUFFLED.value if other is not specifier)
        MUFFLED.value = (*without, specifier) if quiet else without


__all__ = ["CompilationUnit", "compilation_unit", "current", "muffle", "report_errors_to", "report_to", "with_compilation_unit"]
