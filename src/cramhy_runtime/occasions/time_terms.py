"""Terms for points and spans of time: ``(at t)``, ``(throughout t1 t2)``, ``(during t1 t2)``.

Times are double-floats in seconds, as in `current_timestamp`. A span includes its start, not its end. A time of another type never
matches, and a warning says so. Source: projection-and-events.md B3.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import SimpleWarning, warn
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.prolog.builtins.native_predicates import deref, test
from cramhy_runtime.prolog.terms.terms import Var, resolve
from .symbols import sym

AT, THROUGHOUT, DURING = sym("CRAM-OCCASIONS-EVENTS::AT"), sym("CRAM-EXECUTION-TRACE::THROUGHOUT"), sym("CRAM-OCCASIONS-EVENTS::DURING")
GROUP = "TIME"


@test("CRAM-OCCASIONS-EVENTS::DURATION-INCLUDES", group=GROUP)
def duration_includes(m, duration, time):
    """``(duration-includes (throughout t1 t2) time)``: whether ``time`` is in that span. An unbound point of time becomes its start."""
    stretch = times_of(m, duration, THROUGHOUT, 2)
    if stretch is None or None in stretch:
        return False
    found = included(m, *stretch, time)
    return found is not None and m.unify(*found)


def included(m, start, end, time):
    """The terms to unify, two by two, so that the term ``time`` is between ``start`` and ``end``; ``None`` if that is impossible."""
    term = deref(time)
    if term.__class__ is Var:
        return term, lisp_list(AT, start)
    if term.__class__ is not Cons:
        return None
    kind = deref(term.car)
    if kind is AT:
        found = times_of(m, term, AT, 1)
        if found is None:
            return None
        point = found[0]
        return (deref(term.cdr).car, start) if point is None else () if start <= point < end else None
    if kind is THROUGHOUT or kind is DURING:
        found = times_of(m, term, kind, 2)
        if found is None or None in found:
            return None
        first, last = found
        fits = start <= first < last <= end if kind is THROUGHOUT else start < last and first < last and first < end
        return () if fits else None
    return None


def times_of(m, term, kind, count):
    """The list of the times in the term ``(kind time...)``, with ``None`` for unbound ones. It is ``None`` if the term is another one."""
    term = deref(term)
    if term.__class__ is not Cons or deref(term.car) is not kind:
        return None
    times, cell = [], deref(term.cdr)
    while cell.__class__ is Cons:
        time = deref(cell.car)
        if time.__class__ is Var:
            times.append(None)
        elif time.__class__ is float:
            times.append(time)
        else:
            if is_real(time) and not isinstance(time, bool):
                warn(
                    SimpleWarning(
                        "[PROLOG WARNING] The time ~s in ~s is not a double-float, so it fits nothing. Write ~s.",
                        time,
                        resolve(term, m.names),
                        float(time),
                    )
                )
            return None
        cell = deref(cell.cdr)
    return times if cell is None and len(times) == count else None
