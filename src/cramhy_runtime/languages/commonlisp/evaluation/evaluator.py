"""Evaluating forms: compile, make Python of it, run.

`evaluate` serves the REPL, ``eval``, macros and ``#.``: the constants of a form are put into the globals of its code. The
loader compiles whole files with `Unit`, whose code can be kept. Top-level ``progn``, ``eval-when``, ``locally`` and
``macrolet`` are taken apart first, so that a macro defined in one of their forms is known to the next (ANSI 3.2.3.1).
"""

from __future__ import annotations

import functools

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.lisp_core.function_codes import note_code
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ..compiler.environment import EXECUTE, SITUATIONS
from ..compiler.support import NAMESPACE
from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, lisp_list, list_from, one
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import COMMON_LISP, COMMON_LISP_USER, sym
from ..reader.form_places import FormPlaces
from .circular_code import refuse_circular_code
from .plain_calls import code_of_plain_call
from ..compiler.compilation_unit import compilation_unit, current, expanding
from ..syntax.body_parts import body_parts
from ..syntax.lambda_lists import destructure, gensym
from ..syntax.macros import expand_fully, macroexpand_1

PACKAGE = special("*PACKAGE*", COMMON_LISP_USER)
COMMON_LISP.export(PACKAGE)


@functools.cache
def compiler():
    """The compiler's classes, imported when something is first compiled: a cached program starts without it."""
    from . import compiler_parts

    return compiler_parts


class Unit:
    """A text being compiled: its file name, its globals, its constants and the places of its forms.

    stored: whether the code must be able to run in another process; then constants are made by code.
    as_source: whether ``eval-when`` at top level counts as in ``load`` of a source, where nothing is compiled for later; a part of a
    system is compiled and loaded at once, so all situations count.
    """

    def __init__(self, filename="<form>", positions=None, namespace=None, stored=False, as_source=False):
        from ..compiler.constants import Constants

        self.filename = filename
        self.positions = positions if positions is not None else FormPlaces()
        self.namespace = namespace if namespace is not None else new_namespace(filename)
        self.stored = stored
        self.at_once = not stored
        self.situations = EXECUTE if as_source or not stored else SITUATIONS
        self.constants = Constants()
        self.names = {}
        self.alone, self.source = False, None
        self.circular = False  # whether a circle stands in a call of a user's macro

    def statements(self, form):
        """The statements (core forms) that one top-level form is compiled to. They leave its values in the global ``Lresult``."""
        backend = compiler()
        analyzer = backend.Analyzer(self.filename, self.positions, at_once=self.at_once, macro_expander=macro_expander)
        analyzer._at = self.positions.get(id(form))
        analyzer.circle_check = self.check_expansion if self.circular else None
        try:
            node = analyzer.toplevel(form, self.names)
            statements = backend.generated(self.constants, node)
        except RecursionError:
            too_deep(analyzer.place())
        self.names.clear()
        if self.stored:
            return [*self.constants.take_forms(), *statements]
        self.namespace.update(self.constants.take_objects())
        return statements

    def code(self, statements):
        """The code object of core statements."""
        try:
            tree = compiler().python_tree(statements)
            try:
                return compiler().compiled(tree, self.filename)
            except SyntaxError as problem:
                if "nested blocks" not in str(problem):
                    raise
                return compiler().compiled(compiler().flatten(tree), self.filename)
        except RecursionError:
            pass
        except SyntaxError as problem:  # "too many statically nested blocks"
            if "nested" not in str(problem):
                raise
        return too_deep()

    def compile(self, form):
        """The code object of one top-level form."""
        return self.code(self.statements(form))

    def run(self, code):
        """Run compiled code; its values."""
        note_code(code)
        exec(code, self.namespace)
        return self.namespace.pop("Lresult", None)

    def evaluate(self, form):
        """Compile and run one form; top-level forms with forms inside go one by one."""
        result = None
        self.refuse_circle(form)
        with compilation_unit("form") as notes:
            code = code_of_plain_call(form, self) if form.__class__ is Cons else None
            if code is not None:
                notes.finish()
                return self.run(code)
            for part in self.toplevel_parts(form):
                code = self.compile(part)
                if self.alone:  # nothing that follows in the form can define what this part uses
                    notes.finish()
                result = self.run(code)
        return result

    def refuse_circle(self, form):
        """Signal an error when ``form`` is code that contains itself."""
        self.circular = refuse_circular_code(form, self._place)

    def check_expansion(self, expansion):
        """Signal an error when what a macro made of a form with a circle is code that contains itself."""
        refuse_circular_code(expansion, self._place)

    def _place(self, part):
        return (self.filename, *self.positions[id(part)][:2]) if id(part) in self.positions else None

    def toplevel_parts(self, form, alone=True):
        """The forms that ``form`` consists of as a top-level form, each after the one before it has been dealt with.

        While a part is being dealt with, ``self.alone`` says whether it is the only one.
        """
        place = self.positions.get(id(form))
        form = expand_fully(form, self._expand_at_top_level, place and (self.filename, *place[:2]))[0]
        if isinstance(form, Cons) and isinstance(form.car, Symbol):
            head = form.car
            if head is PROGN:
                if form.cdr is None:
                    yield None
                for part in form.cdr or ():
                    yield from self.toplevel_parts(part, False)
                return
            if head is EVAL_WHEN and isinstance(form.cdr, Cons) and isinstance(form.cdr.car, Cons):
                if not SITUATIONS.issuperset(form.cdr.car):
                    yield form  # the compiler says what is wrong with it
                elif not self.situations.isdisjoint(form.cdr.car):
                    yield from self.toplevel_parts(Cons(PROGN, form.cdr.cdr), False)
                return
            if head in (MACROLET, SYMBOL_MACROLET, LOCALLY) and isinstance(form.cdr, Cons):
                yield from self._scoped_parts(form)
                return
        self.alone = alone
        yield form

    def _expand_at_top_level(self, form):
        if isinstance(form, Cons) and isinstance(form.car, Symbol) and form.car not in _TAKEN_APART and not compiler().is_special(form.car):
            return self.expand(form)
        return form, False

    def _scoped_parts(self, form):
        """The forms in a top-level ``macrolet``, ``symbol-macrolet`` or ``locally``: each again with what surrounds it."""
        head, rest = form.car, form.cdr
        around = [head] if head is LOCALLY else [head, rest.car]
        forms = list(rest if head is LOCALLY else rest.cdr or ())
        while forms and isinstance(forms[0], Cons) and forms[0].car is DECLARE:
            around.append(forms.pop(0))
        if len(forms) < 2 and not (forms and isinstance(forms[0], Cons) and forms[0].car is PROGN):
            self.alone = False
            yield form
            return
        for part in forms:
            inner = list(part.cdr or ()) if isinstance(part, Cons) and part.car is PROGN else [part]
            for item in inner:
                scoped = list_from([*around, item])
                self.positions.inherit(scoped, form)
                self.alone = False
                yield scoped

    def expand(self, form):
        with expanding(current(), form, self._place(form)):
            expansion, expanded = macroexpand_1(form)
        if expanded:
            if self.circular:
                self.check_expansion(expansion)
            self.positions.inherit(expansion, form)
        return expansion, expanded


def too_deep(position=None):
    error(CompileError("The form is nested too deeply to be compiled.", position=position))


def new_namespace(filename):
    """Globals for compiled code."""
    return {"__name__": "cramhy_code", "__file__": filename, "__builtins__": __builtins__, **NAMESPACE}


PROGN = sym("PROGN")
EVAL_WHEN = sym("EVAL-WHEN")
MACROLET, SYMBOL_MACROLET, LOCALLY, DECLARE = sym("MACROLET"), sym("SYMBOL-MACROLET"), sym("LOCALLY"), sym("DECLARE")
_TAKEN_APART = (PROGN, EVAL_WHEN, MACROLET, SYMBOL_MACROLET, LOCALLY)

_session = Cell(None, fresh=True)


def session_unit():
    """The unit for forms that come from no file."""
    if _session.value is None:
        _session.value = Unit("<form>")
    return _session.value


def evaluate(form, filename=None, positions=None):
    """``eval``: all values of ``form`` in the null lexical environment.

    filename and positions: where the form came from, for errors and tracebacks.
    """
    quick = _atom(form)
    if quick is not NotImplemented:
        return quick
    unit = session_unit()
    if filename is None:
        return unit.evaluate(form)
    outer = unit.filename, unit.positions
    unit.filename, unit.positions = filename, positions if positions is not None else FormPlaces()
    try:
        return unit.evaluate(form)
    finally:
        unit.filename, unit.positions = outer


def _atom(form):
    """The value of a form that needs no compiler."""
    if isinstance(form, Cons):
        if form.car is QUOTE and isinstance(form.cdr, Cons) and form.cdr.cdr is None:
            return form.cdr.car
        return NotImplemented
    if isinstance(form, Keyword) or not isinstance(form, Symbol):
        return None if form is False else form
    return NotImplemented


QUOTE = sym("QUOTE")


def compile_lambda(form, environment=None, text=None):
    """The function of a lambda expression; ``environment`` gives the local macros that it may use.

    text: what knows the file name and the positions of the text that it stands in: an analyzer, or a `Unit`.
    """
    unit = session_unit()
    unit.refuse_circle(form)
    backend = compiler()
    text = text or unit
    analyzer = backend.Analyzer(text.filename, text.positions, macro_expander=macro_expander)
    analyzer.source, analyzer._at = text.source, text.positions.get(id(text.source))
    analyzer.circle_check = unit.check_expansion if unit.circular else None
    node = analyzer.toplevel(form) if environment is None else backend.toplevel_with_macros(analyzer, form, environment)
    statements = backend.generated(unit.constants, node)
    unit.namespace.update(unit.constants.take_objects())
    return one(unit.run(backend.compiled(backend.python_tree(statements), text.filename)))


def macro_lambda(name, lambda_list, body, definer="DEFMACRO", default=None):
    """The lambda expression ``(lambda (form environment) ...)`` of a macro, and its documentation.

    definer: what defines it (``MACROLET``, ``DEFTYPE``), for errors. default: the form of optional parameters that give none.
    """
    form, environment = gensym("FORM"), gensym("ENVIRONMENT")
    whole_first = isinstance(lambda_list, Cons) and getattr(lambda_list.car, "name", None) == "&WHOLE"
    arguments = lambda_list
    prefix = []
    if whole_first:
        prefix = [(lambda_list.cdr.car, form)]
        arguments = lambda_list.cdr.cdr
    bindings = prefix + destructure(arguments, lisp_list(sym("CDR"), form), f"{definer} {prin1_to_string(name)}", environment, default)
    documentation, declarations, forms = body_parts(body)
    block = Cons(sym("BLOCK"), Cons(name.cdr.car if isinstance(name, Cons) else name, list_from(forms)))
    let = lisp_list(sym("LET*"), list_from([lisp_list(symbol, value) for symbol, value in bindings]), *declarations, block)
    return lisp_list(sym("LAMBDA"), lisp_list(form, environment), let), documentation


def macro_expander(name, lambda_list, body, environment=None, text=None):
    """The expander function of a local macro. ``text``: see `compile_lambda`."""
    function, _ = macro_lambda(name, lambda_list, body, "MACROLET")
    compiled = compile_lambda(function, environment, text)

    def expander(form, env):
        return one(compiled(form, env))

    expander.source = compiled
    return expander
