"""What the macros of ``hy_src/cramhy/prolog.hy`` call, as functions of the package CRAMHY."""

from __future__ import annotations

from cramhy_runtime.lisp.data import python_list
from cramhy_runtime.lisp.faces import define_face

from . import facts, natives, rete


class FactCollector:
    """The facts of a group while its definition is evaluated: ``<-`` forms may stand in loops and macros."""

    def __init__(self):
        self.facts = []


def fact_collector():
    return FactCollector()


def collect_fact(collector, fact):
    """``(<- head goal...)`` inside a fact group: ``fact`` is (head goal...)."""
    collector.facts.append(fact)
    return fact


def finish_fact_group(name, extendable, collector):
    return facts.define_fact_group(name, extendable, collector.facts)


def fact_outside_group(fact):
    return facts.fact_outside_group(*python_list(fact))


def with_productions(productions, body):
    """``productions``: a list of lists (name pattern...)."""
    return rete.with_productions([(production.car, production.cdr) for production in python_list(productions)], body)


def with_production_handlers(handlers, body):
    return rete.with_production_handlers([tuple(python_list(handler)) for handler in python_list(handlers)], body)


define_face("CRAMHY", functions={
    "define-prolog-handler": natives.define_handler, "with-productions": with_productions,
    "with-production-handlers": with_production_handlers,
    "fact-collector": fact_collector, "collect-fact": collect_fact, "finish-fact-group": finish_fact_group,
    "fact-outside-group": fact_outside_group,
})
