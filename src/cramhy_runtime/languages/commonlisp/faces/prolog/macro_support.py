"""What the macros of ``hy_src/cramhy/prolog_operators.hy`` call, as functions of the package CRAMHY."""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import python_list
from ....operators import PROLOG
from ...packages.face_definition import define_face, define_meanings

from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog.builtins import native_predicates as natives, productions, rete
from cramhy_runtime.prolog import tracing
from cramhy_runtime.prolog.terms.origins import origin
from cramhy_runtime.prolog.explanations.undefined import warn_of_misspelled_functors


class FactCollector:
    """The facts of a group while its definition is evaluated: ``<-`` forms may stand in loops and macros."""

    def __init__(self):
        self.facts, self.origins = [], []


def fact_collector():
    return FactCollector()


def collect_fact(collector, fact):
    """``(<- head goal...)`` inside a fact group: ``fact`` is (head goal...)."""
    collector.facts.append(fact)
    collector.origins.append(origin())
    return fact


def finish_fact_group(name, extendable, collector):
    defined = facts.define_fact_group(name, extendable, collector.facts, collector.origins)
    warn_of_misspelled_functors(name, python_list(extendable), [clauses.car for clauses in defined or ()])
    return defined


def fact_outside_group(fact):
    return facts.fact_outside_group(*python_list(fact))


def with_facts_asserted(fact_thunks, body):
    """``fact_thunks``: a list of functions that give the facts."""
    return rete.with_facts_asserted(python_list(fact_thunks), body)


def with_productions(definitions, body):
    """``definitions``: a list of lists (name pattern...)."""
    return productions.with_productions([(definition.car, definition.cdr) for definition in python_list(definitions)], body)


def with_production_handlers(handlers, body):
    return productions.with_production_handlers([tuple(python_list(handler)) for handler in python_list(handlers)], body)


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_meanings(PROLOG, productions, rete, tracing, adapters=sys.modules[__name__])
    define_face("CRAMHY", functions={"define-prolog-handler": natives.define_handler})
