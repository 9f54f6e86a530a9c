"""Prolog as text: reading goals, proving them, and showing the answers the way Lisp prints them."""

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.packages import STANDARD_NAMES
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package, make_package, sym

for name in STANDARD_NAMES.split():
    if name not in ("nil", "t"):
        COMMON_LISP.export(COMMON_LISP.intern(name.upper()))

from cramhy_runtime.session import boot  # noqa: E402  after the names of Common Lisp are there
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string  # noqa: E402
from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string  # noqa: E402
from cramhy_runtime.prolog.engine import fact_groups as facts  # noqa: E402
from cramhy_runtime.prolog import query  # noqa: E402
from cramhy_runtime.utilities.lazy_lists import force_ll  # noqa: E402

boot()  # so that what tests read are the symbols of Prolog
HERE = find_package("PROLOG-TESTS-HERE") or make_package("PROLOG-TESTS-HERE", use=["COMMON-LISP", "CRAM-PROLOG"])
_PACKAGE = sym("*PACKAGE*")
_PRETTY = sym("*PRINT-PRETTY*")


def read(text):
    """The Lisp data that ``text`` is."""
    outer, _PACKAGE.value = _PACKAGE.value, HERE  # no `binding`: tests read before there is a kernel
    try:
        form = read_from_string(text)
    finally:
        _PACKAGE.value = outer
    return form[0] if isinstance(form, tuple) else form


def show(data):
    """``data`` as Lisp prints it."""
    with binding(_PACKAGE, HERE, _PRETTY, None):
        return prin1_to_string(data)


def ask(text, binds="nil"):
    """All answers to the goal ``text``, printed."""
    return show(force_ll(query.prolog(read(text), read(binds))))


def first(text):
    """The result of asking for one answer only."""
    return query.prolog(read(text))


def group(name, *clauses, extendable="()"):
    """Define a fact group; each clause is the text of (head goal...). Returns what def-fact-group returns, printed."""
    return show(facts.define_fact_group(read(name), read(extendable), [read(clause) for clause in clauses]))


def function(name):
    """Decorator: define a Lisp function in the test package."""

    def define(code):
        read(name).function = code
        return code

    return define


class RegisteredWarnings:
    """``with RegisteredWarnings() as given:`` collects the texts of warnings and muffles them."""

    def __enter__(self):
        from cramhy_runtime.lisp_core.conditions import Warning_, muffle_warning

        texts = []

        def note(condition):
            texts.append(condition.report())
            muffle_warning(condition)

        self.task = kernel.current()
        self.task.handlers = [(Warning_, note)], self.task.handlers
        return texts

    def __exit__(self, *exc):
        self.task.handlers = self.task.handlers[1]


def error_text(thunk, kind=conditions.Error):
    """The report of the error that ``thunk`` signals."""
    return conditions.handler_case([(kind, lambda condition: condition.report())], thunk)
