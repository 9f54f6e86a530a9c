"""What the macros of ``hy_src/cramhy/prolog.hy`` and ``cut.hy`` call, as functions of the package CRAMHY."""

from __future__ import annotations

from cramhy_runtime.lisp.data import list_from, python_list, truth
from cramhy_runtime.lisp.faces import define_face

from . import barriers, facts, file_cache, lazy_lists, locks, natives, patterns, rete


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


def lazy_list_of(initial, body, restarts):
    """``initial``: list of the parameters' first values. ``body(cont, next, finish, parameter...)``; ``restarts``: it names some."""
    return lazy_lists.lazy_list(python_list(initial), body, truth(restarts))


def lazy_environment(symbols, thunks, body):
    return lazy_lists.with_lazy_list_dynamic_environment(list(zip(python_list(symbols), python_list(thunks))), body)


def values_of_variables(variables, bindings):
    """The values of pattern variables; an unbound one stands for itself."""
    return list_from([patterns.var_value(variable, bindings) for variable in python_list(variables)])


def strict_values_of_variables(variables, bindings):
    return patterns.with_vars_strictly_bound(python_list(variables), bindings, lambda *found: list_from(found))


def values_of_pattern(pattern, sequence, variables):
    """The values of ``variables`` when ``pattern`` is matched against ``sequence``; errors as with-pat-vars-bound's."""
    return patterns.with_pat_vars_bound(pattern, sequence, lambda value: list_from([value(each) for each in python_list(variables)]))


def with_productions(productions, body):
    """``productions``: a list of lists (name pattern...)."""
    return rete.with_productions([(production.car, production.cdr) for production in python_list(productions)], body)


def with_production_handlers(handlers, body):
    return rete.with_production_handlers([tuple(python_list(handler)) for handler in python_list(handlers)], body)


define_face("CRAMHY", functions={
    "define-prolog-handler": natives.define_handler, "with-productions": with_productions,
    "with-production-handlers": with_production_handlers,
    "fact-collector": fact_collector, "collect-fact": collect_fact, "finish-fact-group": finish_fact_group,
    "fact-outside-group": fact_outside_group, "lazy-list-of": lazy_list_of, "lazy-environment": lazy_environment,
    "delay-thunk": lazy_lists.delay, "lazy-dolist": lazy_lists.lazy_dolist, "values-of-variables": values_of_variables,
    "strict-values-of-variables": strict_values_of_variables, "values-of-pattern": values_of_pattern,
    "file-value": file_cache.file_value,
    "with-lock-held": locks.with_lock_held, "with-hash-table-locked": locks.with_hash_table_locked,
    "with-synchronization-barrier": barriers.with_synchronization_barrier,
})
