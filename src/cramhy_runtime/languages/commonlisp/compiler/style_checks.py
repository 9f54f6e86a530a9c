"""What the compiler notices while it reads a program: unused and ignored variables, unknown names and declarations.

Nothing here changes the code that is made. An `Analyzer` calls these methods where it binds variables, meets names and reads
declarations; what they find goes to the compilation unit (see ``compiler/compilation_unit.py``), with the place of the very symbol.
Variables and calls that only the expansion of a built-in macro contains are not the user's business, so they are left out.
Texts are SBCL's.
"""

from __future__ import annotations

from functools import partial

from cramhy_runtime.lisp_core.condition_types import shown_with
from cramhy_runtime.lisp_core.conditions import SimpleStyleWarning, SimpleWarning, error
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from . import compilation_unit
from .compilation_unit import Mention
from ..syntax.declaration_names import EXTENSIONS, is_declared, is_extension
from ..syntax.function_shapes import wrong_call, wrong_call_of_lambda
from cramhy_runtime.lisp_core.packages import COMMON_LISP, sym
from ..standard_names import missing
from cramhy_runtime.lisp_core.dispatch.methods import Shape
from cramhy_runtime.lisp_core.ports import PORTS
from .environment import Variable, function_key

CRAMHY = sym("CRAMHY::X").package

IGNORE, IGNORABLE, SPECIAL, TYPE, OPTIMIZE = map(sym, ("IGNORE", "IGNORABLE", "SPECIAL", "TYPE", "OPTIMIZE"))
QUOTE, TYPEP, NOTINLINE = sym("QUOTE"), sym("TYPEP"), sym("NOTINLINE")
WITHOUT_MEANING = {sym(name) for name in "INLINE NOTINLINE DYNAMIC-EXTENT DECLARATION FTYPE VALUES".split()}
"""Declarations that are known and need nothing done here."""
STANDARD_DECLARATIONS = {symbol.name for symbol in WITHOUT_MEANING} - {"VALUES"} | {"IGNORE", "IGNORABLE", "SPECIAL", "TYPE", "OPTIMIZE"}
QUALITIES = {"SPEED", "SAFETY", "SPACE", "DEBUG", "COMPILATION-SPEED", "INHIBIT-WARNINGS"}


class Scrutiny:
    """The part of the `Analyzer` that notices things."""

    def begin_scrutiny(self):
        self.unit = compilation_unit.current()
        if self.unit is not None and self.positions.doubts:
            self.unit.texts[self.filename] = self.positions
        self.source = None  # the innermost list around what is being analysed that the user wrote
        self.muffled = ()
        self.notinline = frozenset()  # functions whose compiler macros are not to be used here

    # -------------------------------------------------------------------------------------------------------------- places

    def symbol_position(self, symbol, form=None):
        """(line, column, end line, end column) of ``symbol`` in the user's text around here, or ``None``."""
        form = self.source if form is None else form
        place = None if form is None else self.positions.of_symbol(symbol, form)
        return place and (*place, place[0], place[1] + len(symbol.name) - 1)

    def at_symbol(self, symbol, form=None):
        """(file, line, column) of ``symbol`` in the user's text around here, or else that of the form that is analysed."""
        form = self.source if form is None else form
        return self.place() if form is None else _place_in(self.positions, self.filename, symbol, form, self.place())

    def at_symbol_when_asked(self, symbol, form=None):
        """A function that returns what `at_symbol` returns now: the text is searched for the symbol when a warning shows the place."""
        form = self.source if form is None else form
        return self.place() if form is None else partial(_place_in, self.positions, self.filename, symbol, form, self.place())

    def at_list(self, form):
        """(file, line, column) of a list that was read, or ``None``."""
        place = self.positions.get(id(form))
        return (self.filename, *place[:2]) if place else None

    def warn(self, kind, control, *arguments, position=None, **notes):
        self.unit.tell(kind, control, *arguments, position=position or self.place(), muffled=self.muffled, **notes)

    # ---------------------------------------------------------------------------------------------------------- variables

    def free_variable(self, symbol, env, assigned=False):
        """Note the use of a variable that is bound nowhere around; one that is not special either is undefined."""
        if symbol.package is COMMON_LISP:
            self._refuse(symbol)
        if self.unit is None or symbol.special or symbol.constant:
            return
        if not assigned and self.at_once and env.scope.parent is None:
            return  # the form itself runs into it, and the error tells
        text = shown_with(symbol, "KEYWORD")
        self.warn(SimpleWarning, "undefined variable: ~A", text, position=self.at_symbol(symbol), name=symbol, undefined="variable")

    def _refuse(self, symbol):
        """Fail when ``symbol`` is one of Common Lisp that is not there."""
        if missing(symbol) is not None:  # its place is looked for only then, which takes a while
            error(missing(symbol, self.at_symbol(symbol)))

    def read_variable(self, variable):
        if variable.ignored and self.unit is not None:
            self.warn(SimpleStyleWarning, "reading an ignored variable: ~S", variable.symbol, position=self.at_symbol(variable.symbol))

    def set_ignored(self, variable):
        if variable.ignored and self.unit is not None:
            self.warn(
                SimpleStyleWarning,
                "~S is being set even though it was declared to be ignored.",
                variable.symbol,
                position=self.at_symbol(variable.symbol),
            )

    def unused(self, variables, form=None):
        """Warn of those of ``variables`` that nothing has used; called at the end of their scope."""
        if self.unit is None:
            return
        for variable in variables:
            if isinstance(variable, Variable) and not (variable.used or variable.ignored or variable.ignorable):
                symbol = variable.symbol
                place = self.symbol_position(symbol, form)
                if place is None and (symbol.package is None or symbol.package is COMMON_LISP or symbol.package.built_in):
                    continue
                self.warn(
                    SimpleStyleWarning,
                    "The variable ~S is defined but never used.",
                    symbol,
                    position=(self.filename, *place[:2]) if place else None,
                    unused=symbol,
                )

    def scope(self, variables, specifiers, forms, env):
        """The node of the body ``forms`` of a form that binds ``variables`` and begins with declarations."""
        around = self.muffled, self.notinline
        note_declarations(self, specifiers, variables, env)
        node = self.body(forms, env)
        self.unused(variables)
        self.muffled, self.notinline = around
        return node

    def mention_type(self, specifier, form=None):
        """Note that a type is named by a constant; one that nobody knows yet is undefined."""
        if self.unit is None or not isinstance(specifier, (Symbol, Cons)) or PORTS.types.known(specifier):
            return
        head = specifier.car if isinstance(specifier, Cons) else specifier
        if isinstance(head, Symbol) and not isinstance(head, Keyword) and not PORTS.types.known(head):
            self.unit.types.append(Mention(head, None, self.at_symbol_when_asked(head, form), self.muffled))

    # --------------------------------------------------------------------------------------------------------------- calls

    def mention(self, name, env, form=None, arguments=None):
        """Note a call of the global function ``name``, or with no ``arguments`` that it is named by ``#'``."""
        unit = self.unit
        if isinstance(name, Symbol) and name.package is COMMON_LISP:
            self._refuse(name)
        if unit is None:
            return
        if name is TYPEP and arguments is not None and len(arguments) > 1 and isinstance(arguments[1], Cons) and arguments[1].car is QUOTE:
            self.mention_type(arguments[1].cdr.car, form)
        if self.at_once and env.scope.parent is None:
            return  # the form itself makes the call, and the error tells
        if arguments is None or form is None or id(form) not in self.positions:
            position, call = self.at_symbol_when_asked(name[1] if isinstance(name, tuple) else name), None
        else:
            position, call = self.place(), (self.filename, *self._at)
        unit.mentions.append(Mention(name, arguments, position, self.muffled, call))

    def mention_definition(self, form):
        """Note that ``form``, a call of one of the functions that definitions expand to, defines the function that it quotes."""
        quoted = form.cdr.car if isinstance(form.cdr, Cons) else None
        if self.unit is not None and form.car.name.startswith("DEFINE-") and isinstance(quoted, Cons) and quoted.car is QUOTE:
            name = quoted.cdr.car
            if isinstance(name, Symbol) or isinstance(name, Cons) and isinstance(name.cdr, Cons):
                self.unit.define(function_key(name), None, None)

    def defines(self, name, shape):
        """Note that a function of this name and shape is being compiled for the global name ``name``."""
        if self.unit is None:
            return
        first = self.unit.define(function_key(name), shape, self.place())
        if first is not None:
            self.warn(SimpleWarning, "Duplicate definition for ~S found in one file.", name, also=[first])

    def local_call(self, name, shape, arguments, env):
        """Judge a call of a function of ``flet`` or ``labels``."""
        if self.unit is None or shape is None or self.at_once and env.scope.parent is None:
            return
        for control, *rest in wrong_call(name, shape, arguments):
            self.warn(SimpleWarning, control, *rest)

    def lambda_call(self, expression, arguments, env):
        """Judge a call of a lambda expression."""
        if self.unit is not None and isinstance(expression.cdr, Cons) and not (self.at_once and env.scope.parent is None):
            for control, *rest in wrong_call_of_lambda(Shape(expression.cdr.car), arguments):
                self.warn(SimpleWarning, control, *rest)


def note_declarations(analyzer, specifiers, variables, env):
    """Take note of the declarations at the head of a body that binds ``variables`` (`Variable` objects and symbols) in ``env``."""
    by_symbol = {variable.symbol: variable for variable in variables if isinstance(variable, Variable)}
    for specifier in specifiers:
        if not isinstance(specifier, Cons):
            _tell_unrecognized(analyzer, specifier)
            continue
        head, rest = specifier.car, list(_elements(specifier.cdr))
        if head is IGNORE or head is IGNORABLE:
            for name in rest:
                if not isinstance(name, Symbol) or name not in variables:  # else the LET* of &AUX will know it
                    _note_ignore(analyzer, head, name, by_symbol, env, specifier)
        elif head is NOTINLINE:
            analyzer.notinline |= {name for name in rest if isinstance(name, Symbol)}
        elif is_extension(head, "MUFFLE-CONDITIONS"):
            analyzer.muffled = (*analyzer.muffled, *rest)
        elif is_extension(head, "UNMUFFLE-CONDITIONS"):
            analyzer.muffled = tuple(item for item in analyzer.muffled if item not in rest)
        elif analyzer.unit is None or head is SPECIAL or head in WITHOUT_MEANING or is_extension(head, *EXTENSIONS) or is_declared(head):
            continue
        elif head is OPTIMIZE:
            _note_optimize(analyzer, specifier, rest)
        elif head is TYPE:
            _note_type(analyzer, rest[0] if rest else None, [name for name in rest[1:] if name not in variables], env, specifier)
        elif (isinstance(head, (Symbol, Cons)) or head is True) and PORTS.types.known(head):
            _note_type(analyzer, head, [name for name in rest if name not in variables], env, specifier)
        else:
            _tell_unrecognized(analyzer, specifier)


def _note_ignore(analyzer, head, name, by_symbol, env, specifier):
    if isinstance(name, Cons):  # (function f)
        return
    variable = by_symbol.get(name)
    if variable is not None:
        if head is IGNORE:
            variable.ignored = True
        else:
            variable.ignorable = True
    elif analyzer.unit is not None and env.variable(name) is None:
        analyzer.warn(
            SimpleStyleWarning,
            "~S declaration for an unknown variable: ~S",
            head,
            name,
            position=analyzer.at_symbol(name, specifier) if isinstance(name, Symbol) else None,
        )


def _note_optimize(analyzer, specifier, qualities):
    for quality in qualities:
        name = quality.car if isinstance(quality, Cons) else quality
        if getattr(name, "name", None) not in QUALITIES:
            analyzer.warn(
                SimpleWarning, "Ignoring unknown optimization quality ~S in: ~S", name, specifier, position=analyzer.at_list(specifier)
            )


def _note_type(analyzer, specifier, names, env, form):
    analyzer.mention_type(specifier, form)
    for name in names:
        if isinstance(name, Symbol) and env.variable(name) is None:
            analyzer.free_variable(name, env, assigned=True)


def _tell_unrecognized(analyzer, specifier):
    if analyzer.unit is not None:
        analyzer.warn(SimpleWarning, "unrecognized declaration ~S", specifier, position=analyzer.at_list(specifier))


def _place_in(positions, filename, symbol, form, otherwise):
    """(file, line, column) of ``symbol`` in ``form``, which was read from the file; ``otherwise`` if it does not stand there."""
    place = positions.of_symbol(symbol, form)
    return (filename, *place) if place else otherwise


def _elements(lst):
    while isinstance(lst, Cons):
        yield lst.car
        lst = lst.cdr


def tuple_of(form):
    """The argument forms of a call."""
    return tuple(_elements(form.cdr))
