"""Tests that are nets: ``(if (< *distance* 0.5) ...)``, whose first branch is always taken.

``<`` of the plan language makes a net when an argument is a fluent, and a net is an object, so it is true. What ``if``, ``and`` and ``or``
do with it is right by Common Lisp (cpl.md 1.2), and never what was meant. The compiler cannot know what a variable will hold, but it sees
what a global one holds now. And in ``(wait-for (and (< x 1) (> y 2)))`` nobody waits for the first net, whatever the variables are.

This module does not know fluents: the face of the plan language tells it what makes nets (`make_nets`) and who waits (`wait_for_nets`).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import SimpleStyleWarning
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.packages import sym

AND, OR = sym("AND"), sym("OR")
_COMBINATIONS = {AND: ("FL-AND", "last"), OR: ("FL-OR", "first")}
_makers, WAITING = {}, set()


def make_nets(functions, is_fluent):
    """Note that each of ``functions`` makes a net when ``is_fluent`` is true of an argument."""
    _makers.update(dict.fromkeys(functions, is_fluent))


def wait_for_nets(*names):
    """Note that the functions of these symbols wait for their first argument, a fluent."""
    WAITING.update(names)


def _maker(form):
    """What tells fluents from other objects, if ``form`` is a call of a function that makes nets of them; else ``None``."""
    return _makers.get(form.car.function) if form.__class__ is Cons and form.car.__class__ is Symbol and _makers else None


def is_net(form, env):
    """Whether ``form`` certainly makes a net: a call with a global variable that holds a fluent, or with such a call."""
    is_fluent = _maker(form)
    return is_fluent is not None and any(
        is_net(argument, env) or _is_global(argument, env) and is_fluent(argument.value) for argument in _arguments(form)
    )


def _arguments(form):
    """The arguments of a call, as far as ``form`` is a list."""
    found, rest = [], form.cdr
    while rest.__class__ is Cons:
        found.append(rest.car)
        rest = rest.cdr
    return found


def _is_global(argument, env):
    return argument.__class__ is Symbol and argument.special and env.variable(argument) is None


def look_at_tests(analyzer, operator, tests, env):
    """Warn of each of ``tests``, forms that ``operator`` takes for true or false, that is a net."""
    for test in tests:
        if is_net(test, env):
            place = analyzer.positions.get(id(test))
            analyzer.warn(
                SimpleStyleWarning,
                "The test ~S of ~S makes a net, and a net is always true.",
                test,
                _as_written(analyzer, operator),
                position=(analyzer.filename, *place[:2]) if place else None,
                hint="(value net) is what the net holds now; (wait-for net) waits until that is true. fl-and, fl-or and not combine nets.",
            )


def _as_written(analyzer, operator):
    """The operator that the user wrote, such as ``when``, whose expansion contains ``operator``."""
    source = analyzer.source
    return source.car if source.__class__ is Cons and source.car.__class__ is Symbol and source.car.macro is not None else operator


def look_at_wait(analyzer, form, env):
    """Warn of ``(wait-for (and (< x 1) (> y 2)))``: the net of a form that ``and`` or ``or`` passes by is lost.

    form: a call of one of `WAITING`.
    """
    if form.cdr.__class__ is not Cons:
        return
    fluent = form.cdr.car
    if fluent.__class__ is not Cons or fluent.car not in _COMBINATIONS:
        return
    forms = _arguments(fluent)
    lost = [each for each in forms[:-1] if _maker(each) and not is_net(each, env)]  # of a net the warning is above
    if lost and not any(map(_reads, forms)):
        maker, one = _COMBINATIONS[fluent.car]
        analyzer.warn(
            SimpleStyleWarning,
            "~S makes no net: if ~S makes one, ~S waits for the ~A of the nets alone.",
            fluent.car,
            lost[0],
            _as_written(analyzer, form.car),
            one,
            hint=f"({maker.lower()} ...) makes a net of nets.",
        )


def _reads(form):
    """Whether a value is read in ``form``, so that it may be no net."""
    return form.__class__ is Cons and (
        form.car.__class__ is Symbol and form.car.name in ("VALUE", "PEEK-VALUE") or any(map(_reads, _arguments(form)))
    )
