"""The warning about a goal whose functor is not defined: the original's text, the place of the goal, and similar names.

A functor is a symbol with its package, so a symbol of the same name in another package is another functor. The warning comes once for
each place of a goal in a proof, not again when the proof comes back there. A plan asks the same rules in many proofs: of a goal in a rule,
or in a query of a function in a file, the warning comes once for each form that the user evaluates. Source: prolog.md 5.1, section 1.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import SimpleStyleWarning, SimpleWarning, warn
from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.lisp_core.packages import COMMON_LISP, CURRENT
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.utilities.patterns import variable

from ..builtins import control
from ..symbols import sym
from ..engine import database
from ..engine.source_positions import Place
from .failure_reasons import spelled_like
from ..engine.goal_text import show
from ..engine.services import SERVICES
from ..terms.terms import raw


def defined_functors():
    """The functors whose goals can have solutions, except ``t``, which is Python's ``True``."""
    return [*control.CONTROL, *(functor for functor, entry in database.functors.items() if entry.defined and functor is not True)]


def advice(functor):
    """A hint about ``functor``, which is not defined: a sentence without its full stop, or ``None``."""
    if functor is None:
        return "nil is not a goal"
    if not isinstance(functor, Symbol) or variable(functor):
        return f"{show(functor)} is not a functor; (call ?goal) proves a goal that is the value of a variable"
    name, known = show(functor), defined_functors()
    twins = [other for other in known if other.name == functor.name and other is not functor]
    if twins:
        twin = _written(twins[0], qualified=True)
        return f"nobody defines {name}; there is {twin}, another symbol of that name: write it so, or import it"
    near = spelled_like(functor, known)
    if near:
        return f"nobody defines {name}; did you mean {' or '.join(show(symbol) for symbol in near)}?"
    if not isinstance(functor.function, UndefinedFunction):
        return f"{name} is a Lisp function: (lisp-fun {name} ...) is a goal that calls it, (lisp-pred {name} ...) asks whether it is true"
    return None


_told: dict[object, object] = per_image({})
"""Functor → the form that the user evaluated when it was warned of."""
_FORM = sym("-")  # the variable of Common Lisp whose value is the form that is being evaluated


def _first_in_this_form(functor: object) -> bool:
    """Whether ``functor`` was not yet warned of in the form that the user evaluates. From now on, it was."""
    known, _told[functor] = _told.get(functor, _told), _FORM.value
    return known is not _FORM.value


def _forget(functor: object, entry: object) -> None:
    _told.pop(functor, None)


database.watchers.append(_forget)


def warn_undefined(m, goal):
    """Warn of the goal term ``goal``, whose functor is not defined, once for each place in a proof.

    Goals of rules and of functions in files are warned of once in a form that the user evaluates, until the functor is defined.
    """
    functor = None if goal is None else goal.car
    place = Place(m, goal, everywhere=True)
    key = (functor if place.written is None else id(place.written), len(place.clauses))
    if key in m.warned_of():
        return
    m.warned_of().add(key)
    if (place.clauses or place.in_file) and not _first_in_this_form(raw(functor, m.names)):
        return
    warning = SimpleWarning("Trying to prove goal ~a with undefined functor ~s.", raw(goal, m.names), raw(functor, m.names))
    meant = advice(raw(functor, m.names))
    if meant is not None:
        meant = (f"N{meant[1:]}" if meant.startswith("n") else meant) + ("" if meant[-1] == "?" else ".")
    warning.where, warning.hint = place.where, "\n".join(filter(None, [place.rule("It is a goal of"), meant]))
    warn(warning)


def warn_of_misspelled_functors(group, extendable, defined):
    """Style-warn of functors in the new fact group ``group`` that are probably misspelled: in its list ``extendable``, or in its clauses
    (``defined``).

    The list may name functors that are not defined yet, since a program may declare them first. But a name that is almost that of a
    predicate that is there to be extended, or the same name in another package, is usually a mistake. Without the warning the user
    would not notice it: the clauses would exist, and no goal would reach them.
    """
    known = database.functors
    alone = [
        functor
        for functor in dict.fromkeys([*extendable, *defined])
        if functor is not True
        and functor not in control.CONTROL
        and not (functor in known and any(other is not group for other in known[functor].groups()))
    ]
    if not alone:
        return
    ours = {
        functor: entry
        for functor, entry in known.items()
        if entry.native_group is not None and functor.package is not COMMON_LISP and functor.package.built_in
    }
    to_extend = [functor for functor, entry in ours.items() if not entry.native]  # nothing but what users give them
    for functor in alone:
        twins = [other for other in (ours if functor in extendable else to_extend) if other.name == functor.name]
        meant = twins or (spelled_like(functor, ours) if functor in extendable else [])
        if not meant:
            continue
        clause = next(iter(known[functor].clauses), None) if functor in known else None
        warning = SimpleStyleWarning(
            "Fact group ~a ~a ~s, which no other group defines.", group, "extends" if functor in extendable else "has clauses of", functor
        )
        place = describe(clause.position) if clause is not None else None
        warning.where = f"at {place}" if place else None
        warning.hint = f"Did you mean {' or '.join(_written(other, qualified=bool(twins)) for other in meant)}?"
        warn(warning)


def _written(functor, qualified=False):
    """``functor`` as users write it in the current package; always with its package if ``qualified``."""
    package = functor.package
    if package is None or not qualified and CURRENT.value.lookup(functor.name)[0] is functor:
        return functor.name.lower()
    return f"{min(package.names, key=len).lower()}:{functor.name.lower()}"


SERVICES.install(warn_undefined=warn_undefined)
