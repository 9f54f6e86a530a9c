"""What is said of a goal that nobody has defined: the original's warning, where the goal stands, and what may be meant.

A functor is a symbol, package and all, so a name of a package that shadows it is another functor. The warning comes once for each
place of a goal in a proof, not again when the proof comes back there. Source: prolog.md 5.1, section 1.
"""

from __future__ import annotations

from cramhy_runtime.lisp.conditions import SimpleWarning, warn
from cramhy_runtime.lisp.data import Symbol, UndefinedFunction
from cramhy_runtime.utilities.patterns import variable

from . import control, database
from .places import Place
from .reasons import spelled_like
from .showing import show
from .terms import raw


def defined_functors():
    """The functors of which goals can have solutions."""
    return [*control.CONTROL, *(functor for functor, entry in database.functors.items() if entry.defined)]


def advice(functor):
    """What may be meant where nobody has defined ``functor``: a sentence without its full stop, or ``None``."""
    if functor is None:
        return "nil is no goal"
    if not isinstance(functor, Symbol) or variable(functor):
        return f"{show(functor)} is no functor; (call ?goal) proves a goal that is the value of a variable"
    name, known = show(functor), defined_functors()
    twins = [other for other in known if other.name == functor.name and other is not functor]
    if twins:
        package = min(twins[0].package.names, key=len).lower() if twins[0].package is not None else "#"
        return f"nobody defines {name}; there is {package}:{twins[0].name.lower()}, another symbol of that name: write it so, or import it"
    near = spelled_like(functor, known)
    if near:
        return f"nobody defines {name}; did you mean {' or '.join(show(symbol) for symbol in near)}?"
    if not isinstance(functor.function, UndefinedFunction):
        return f"{name} is a Lisp function: (lisp-fun {name} ...) is a goal that calls it, (lisp-pred {name} ...) asks whether it is true"
    return None


def warn_undefined(m, goal):
    """Warn of the goal term ``goal``, whose functor nobody has defined; once for each place in a proof."""
    functor = None if goal is None else goal.car
    place = Place(m, goal, everywhere=True)
    key = (functor if place.written is None else id(place.written), len(place.clauses))
    if key in m.warned_of():
        return
    m.warned_of().add(key)
    warning = SimpleWarning("Trying to prove goal ~a with undefined functor ~s.", raw(goal, m.names), raw(functor, m.names))
    meant = advice(raw(functor, m.names))
    if meant is not None:
        meant = (f"N{meant[1:]}" if meant.startswith("n") else meant) + ("" if meant[-1] == "?" else ".")
    warning.where, warning.hint = place.where, "\n".join(filter(None, [place.rule("It is a goal of"), meant]))
    warn(warning)


database.warn_undefined = warn_undefined
