"""``assert``: a test that must hold, and the question for new values of its places when it does not (ANSI 9.2).

The test is evaluated with its arguments in variables when it is a function call, so that the report can say what they were:
``The assertion (= X 2) failed with X = 1.``
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import SimpleError, error, types
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, Symbol, lisp_list, list_from, truth
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from ..streams.stream_functions import y_or_n_p
from .forms import SPECIAL_OPERATORS, constantp
from ..syntax.lambda_lists import gensym, support
from ..syntax.macros import macro_function
from .setf_places import macro

QUOTE = sym("QUOTE")


@macro("ASSERT")
def _assert(form, environment):
    """``(assert test [(place...) [datum argument...]])``"""
    test, *rest = list(form.cdr)
    places = list(rest[0] or ()) if rest else []
    bindings, infos, tested = [], [], test
    if _is_call(test, environment):
        arguments = []
        for argument in test.cdr or ():
            if _varies(argument):
                variable = gensym("ARGUMENT")
                bindings.append(lisp_list(variable, argument))
                infos.append(lisp_list(sym("CONS"), lisp_list(QUOTE, argument), variable))
                argument = variable
            arguments.append(argument)
        tested = Cons(test.car, list_from(arguments))
    again = gensym("AGAIN")
    failed = lisp_list(
        support("ASSERTION-FAILED"),
        lisp_list(QUOTE, test),
        Cons(sym("LIST"), list_from(infos)),
        lisp_list(QUOTE, list_from(places)),
        *rest[1:],
    )
    asked = [lisp_list(sym("SETF"), place, lisp_list(support("ASSERTION-PROMPT"), lisp_list(QUOTE, place), place)) for place in places]
    retry = lisp_list(sym("PROGN"), failed, *asked, lisp_list(sym("GO"), again))
    check = lisp_list(sym("LET"), list_from(bindings), lisp_list(sym("IF"), tested, None, retry))
    return lisp_list(sym("TAGBODY"), again, check)


def _is_call(test, environment):
    """Whether ``test`` calls a function by its name."""
    if not isinstance(test, Cons) or not isinstance(test.car, Symbol) or not isinstance(test.cdr, Cons):
        return False
    return macro_function(test.car, environment) is None and test.car not in SPECIAL_OPERATORS


def _varies(form):
    return not truth(constantp(form)) and (isinstance(form, Cons) or is_symbol(form))


def assertion_failed(test, infos, places, datum=UNSUPPLIED, *arguments):
    """Signal that ``test`` failed, with a restart CONTINUE that returns. infos: a list of (argument form . value)."""
    if datum is not UNSUPPLIED:
        condition = conditions.make_condition(datum, arguments)
    elif infos is None:
        condition = SimpleError("The assertion ~S failed.", test)
    else:
        pairs = [item for info in infos for item in (info.car, info.cdr)]
        condition = SimpleError("The assertion ~S failed with ~{~S = ~S~^, ~}.", test, list_from(pairs))
    report = "Retry assertion"
    if places is not None:
        values = "value" if places.cdr is None else "values"
        report += f" with new {values} for {', '.join(types.shown(place) for place in places)}"
    return conditions.restart_case([(sym("CONTINUE"), lambda: None, report + ".")], lambda: error(condition))


def assertion_prompt(place, value):
    """The value that the user wants ``place`` to have: asked for when an assertion is retried."""
    question = f"The old value of {types.shown(place)} is {types.shown(value)}.\nDo you want to supply a new value? "
    if not truth(y_or_n_p("~A", question)):
        return value
    return PORTS.user.form("Type a form to be evaluated: ")
