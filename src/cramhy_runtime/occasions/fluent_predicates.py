"""Predicates about the values of fluents during an episode. Fluents are known by name, and only if they were traced.

``(fluent ?name)``, ``(holds (fluent-value name ?value) time)``, and ``(fluent-value fluent ?value)`` for a fluent object, now.
Source: projection-and-events.md B4.
"""

from __future__ import annotations

from cramhy_runtime.cpl.fluents.fluents import Fluent
from ..episodes.queries import fluent_durations
from cramhy_runtime.lisp_core.data import Symbol, lisp_list
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group
from cramhy_runtime.prolog.builtins.native_predicates import deref, predicate, test
from cramhy_runtime.prolog.terms.terms import Var
from .current_episode import asked_episode
from .occasions import HOLDS
from .symbols import sym
from .time_terms import included

GROUP = "CRAM-OCCASIONS-EVENTS::FLUENTS"
_NAME, _VALUE, _TIME = sym("CRAM-OCCASIONS-EVENTS::?NAME"), sym("CRAM-OCCASIONS-EVENTS::?VALUE"), sym("CRAM-OCCASIONS-EVENTS::?TIME")

define_fact_group(
    sym(GROUP),
    [HOLDS],
    [
        lisp_list(
            lisp_list(HOLDS, lisp_list(sym("CRAM-OCCASIONS-EVENTS::FLUENT-VALUE"), _NAME, _VALUE), _TIME),
            lisp_list(sym("CRAM-OCCASIONS-EVENTS::FLUENT-VALUE-AT"), _NAME, _VALUE, _TIME),
        )
    ],
)


@predicate("CPL-IMPL::FLUENT", group=GROUP)
def fluent(m, name):
    """``(fluent f)``: true for any symbol; the names of the traced fluents if ``f`` is unbound."""
    known = deref(name)
    if known.__class__ is not Var:
        if isinstance(known, Symbol) or known is None:
            yield
        return
    episode = asked_episode("CPL-IMPL::FLUENT")
    for traced in list(episode.traces) if episode is not None else ():
        if m.unify(known, traced):
            yield


@test("CRAM-OCCASIONS-EVENTS::FLUENT-VALUE", group=GROUP)
def fluent_value(m, thing, value):
    """``(fluent-value f v)``: the present value of a fluent, an object."""
    found = deref(thing)
    return isinstance(found, Fluent) and m.unify(value, found.peek())


@predicate("CRAM-OCCASIONS-EVENTS::FLUENT-VALUE-AT", group=GROUP)
def fluent_value_at(m, name, value, time):
    """The values of the traced fluent ``name`` whose durations include ``time``."""
    episode = asked_episode("CRAM-OCCASIONS-EVENTS::FLUENT-VALUE")
    if episode is None:
        return
    known = deref(name)
    for traced in list(episode.traces) if known.__class__ is Var else [known] if known in episode.traces else ():
        for was, start, end in fluent_durations(traced, episode):
            fit = included(m, start, end, time)
            if fit is not None and m.unify(name, traced, value, was, *fit):
                yield
