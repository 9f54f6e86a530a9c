"""Policies: a condition that is watched while a body runs, and what to do when it is met.

A policy has four optional clauses: ``init`` must give true or nothing starts; ``check`` is called again and again beside the body;
when it is met the body is evaporated, ``recover`` runs, and the form fails with ``policy-check-condition-met``; ``clean-up`` runs
at every end. Source: cpl.md section 9. Repaired: a policy without ``check`` just runs its body, where the original kills it; a
failing ``recover`` does not skip ``clean-up``; the conditions reach handlers in parent tasks, as errors do.

A clause is a function of the use's `Store` and the policy's parameters; the macro makes the local functions ``policy-get`` and
``policy-setf`` from the store.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any

from ..lisp import condition_types as types
from ..lisp.condition_types import shown
from ..lisp.conditions import error
from ..lisp.data import UNSUPPLIED, list_from, one, python_list, truth
from ..lisp.packages import is_symbol, symbol_name
from .failure_types import PolicyCheckConditionMet, PolicyInitFailed, PolicyNotFound
from .failures import fail, fail_with_advice
from .hooks import on_with_policy_begin, on_with_policy_end
from .operators import pursue
from .symbols import sym
from .current import inside_plan
from .waiting import sleep

POLL = 0.01  # s between two checks
_named = {}


class Policy:
    """A policy; ``init``, ``check``, ``recover`` and ``clean_up`` are functions or ``None``, ``parameters`` a Lisp list of names."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY"

    def __init__(self, name, parameters=UNSUPPLIED, description=None, init=None, check=None, recover=None, clean_up=None):
        self.counted = parameters is not UNSUPPLIED  # Python's functions count their arguments themselves
        self.name, self.parameters, self.description = name, parameters if self.counted else None, description
        self.init, self.check, self.recover, self.clean_up = init, check, recover, clean_up


class Store:
    """The small memory that the clauses of one use of a policy share."""

    def __init__(self):
        self.values = {}

    def get(self, symbol):
        return self.values.get(symbol)

    def set(self, symbol, value):
        self.values[symbol] = value
        return value


def make_policy(name: Any, parameters: Any = UNSUPPLIED, description: str | None = None, **clauses: Any) -> Policy:
    """A policy object; clauses are ``init``, ``check``, ``recover`` and ``clean_up``."""
    return Policy(name, parameters, description, **clauses)


def define_policy(name, parameters=UNSUPPLIED, description=None, **clauses):
    """Make a policy, keep it under ``name`` and in the variable ``name``; returns it."""
    policy = _named[name] = make_policy(name, parameters, description, **clauses)
    name.special = True
    name.value = policy
    return policy


def named_policy(name):
    """The policy called ``name``; it is a failure ``policy-not-found`` if there is none."""
    policy = _named.get(name)
    if policy is not None:
        return policy
    return fail_with_advice(f"DEFINE-POLICY makes a policy with a name. There are {', '.join(map(shown, _named))}.",
                            PolicyNotFound(name=name))


def _check_use(policy, count):
    """What ``with-policy`` is given must be a policy, and as many parameters as it has."""
    if not isinstance(policy, Policy):
        error(types.TypeError_(policy, sym("CPL-IMPL::POLICY")), hint="WITH-POLICY takes a policy, WITH-NAMED-POLICY the name of one.")
    names = [symbol_name(name) for name in python_list(policy.parameters) if is_symbol(name)]
    if policy.counted and count != len(names) and not any(name.startswith("&") for name in names):
        error(types.SimpleProgramError("invalid number of arguments: ~S", count),
              hint=f"The parameters of the policy {shown(policy.name)} are {shown(policy.parameters)}.")


def with_policy(policy, arguments, body, forms=None):
    """``(with-policy policy (form...) body...)``: values of ``body()`` under ``policy``; for the arguments see `in_force`."""
    with in_force(policy, arguments, forms) as check:
        return body() if check is None else pursue(check, body)


@contextmanager
def in_force(policy, arguments, forms=None):
    """The block runs under ``policy``, beside the function that it gets: that of the check, which returns when it is met.

    ``arguments()`` evaluates the parameter forms to a Python sequence, again at each call of a clause; ``forms`` are the forms
    themselves, a Lisp list, which the conditions show.
    """
    inside_plan("PURSUE")
    if forms is None:
        forms = list_from(arguments())
    _check_use(policy, len(python_list(forms)))
    store = Store()

    def clause(function):
        return one(function(store, *arguments()))

    if policy.init is not None and not truth(clause(policy.init)):
        fail(PolicyInitFailed(name=policy.name, parameters=forms))
    run_id = on_with_policy_begin.first(policy.name, None)
    met = succeeded = False

    def check():
        nonlocal met
        while not truth(clause(policy.check)):
            sleep(POLL)
        met = True

    try:
        yield None if policy.check is None else check
        succeeded = not met
    finally:
        try:
            if met and policy.recover is not None:
                clause(policy.recover)
        finally:
            if policy.clean_up is not None:
                clause(policy.clean_up)
        on_with_policy_end(run_id, True if succeeded else None)
    if met:
        fail(PolicyCheckConditionMet(name=policy.name, parameters=forms))


def with_policies(policies, body):
    """``(with-policies ((policy (form...))...) body...)``: nested, the first outermost; ``policies``: (policy, arguments, forms)."""
    if not policies:
        return body()
    (policy, arguments, forms), *rest = policies
    return with_policy(policy, arguments, lambda: with_policies(rest, body), forms)


def _timeout_met(store, time):
    sleep(time)
    return True


TIMEOUT_POLICY = define_policy(sym("CPL-IMPL::TIMEOUT-POLICY"), list_from([sym("CPL-IMPL::TIME")]),
                               "Ends its body after TIME seconds.", check=_timeout_met)
