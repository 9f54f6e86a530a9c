"""Policies: a condition that is watched while a body runs, and what to do when it is met.

A policy has four optional clauses. If ``init`` does not return true, the body does not start. ``check`` is called again and again beside
the body; when it returns true, the body is evaporated, ``recover`` runs, and the form fails with ``policy-check-condition-met``.
``clean-up`` runs at every end. Source: cpl.md section 9. Repaired: a policy without ``check`` just runs its body, where the original kills
it. A failing ``recover`` does not skip ``clean-up``. The conditions reach handlers in parent tasks, as errors do.

Each clause is a function of a `Store`, made for each use of the policy, and of the policy's parameters. The macro makes the local
functions ``policy-get`` and ``policy-setf`` from the store.
"""

from __future__ import annotations

from contextlib import contextmanager
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.unstarted import callable_part, plain_function
from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.condition_types import shown
from cramhy_runtime.lisp_core.conditions import as_name, error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, list_from, one, python_list, truth
from cramhy_runtime.lisp_core.packages import is_symbol, redefined, symbol_name
from ..failures.failure_types import PolicyCheckConditionMet, PolicyInitFailed, PolicyNotFound
from ..failures.handling import fail, fail_with_advice
from ..hooks import on_with_policy_begin, on_with_policy_end
from .operators import pursue
from ..symbols import sym
from ..current import inside_plan
from ..tasks.waiting import sleep

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator

    from ..signatures import Clause, Name, Thunk

T = TypeVar("T")
POLL = 0.01  # s between two checks
_named: dict[Any, Policy] = per_image({})


class Policy:
    """A policy. ``init``, ``check``, ``recover`` and ``clean_up`` are functions or ``None``; ``parameters`` is a Lisp list of names."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY"

    def __init__(
        self,
        name: Name,
        parameters: object = UNSUPPLIED,
        description: str | None = None,
        init: Clause | None = None,
        check: Clause | None = None,
        recover: Clause | None = None,
        clean_up: Clause | None = None,
    ):
        self.counted = parameters is not UNSUPPLIED  # Python's functions count their arguments themselves
        self.name, self.parameters, self.description = name, parameters if self.counted else None, description
        clauses = self.init, self.check, self.recover, self.clean_up = init, check, recover, clean_up
        for name, clause in zip(("init", "check", "recover", "clean_up"), clauses):
            if clause is not None:
                plain_function(
                    callable_part(clause, "make_policy", f"the clause {name}", f"name, {name}=drive"), f"the clause {name} of a policy"
                )


class Store:
    """Values that the clauses of one use of a policy share."""

    def __init__(self) -> None:
        self.values: dict[Hashable, Any] = {}

    def get(self, symbol: Hashable) -> Any:
        """The value stored under ``symbol``, or nil."""
        return self.values.get(symbol)

    def set(self, symbol: Hashable, value: T) -> T:
        """Store ``value`` under ``symbol``, and return it."""
        self.values[symbol] = value
        return value


def make_policy(
    name: Name,
    parameters: object = UNSUPPLIED,
    description: str | None = None,
    *,
    init: Clause | None = None,
    check: Clause | None = None,
    recover: Clause | None = None,
    clean_up: Clause | None = None,
) -> Policy:
    """A new policy. Each clause is a function of a `Store`, which the clauses of one use share, and of the policy's parameters.

    name: a string or symbol. parameters: a Lisp list of their names; left out, the functions check their arguments themselves.
    init: if it does not return true, the body is not run. check: called every 0.01 s beside the body; when it returns true, the body is
    evaporated. recover: called after that. clean_up: called at every end. Source: cpl.md 9.1.
    """
    return Policy(name, parameters, description, init, check, recover, clean_up)


def define_policy(name, parameters=UNSUPPLIED, description=None, **clauses):
    """Make a policy, keep it under ``name`` and in the variable ``name``, and return it."""
    policy = _named[name] = make_policy(name, parameters, description, **clauses)
    redefined(name)
    name.special = True
    name.value = policy
    return policy


def named_policy(name):
    """The policy called ``name``. If there is none, fail with ``policy-not-found``."""
    policy = _named.get(as_name(name))
    if policy is not None:
        return policy
    return fail_with_advice(
        f"DEFINE-POLICY makes a policy with a name. There are {', '.join(map(shown, _named))}.", PolicyNotFound(name=name)
    )


def _check_use(policy, count):
    """Signal an error unless ``policy`` is a policy with ``count`` parameters."""
    if not isinstance(policy, Policy):
        error(types.TypeError_(policy, sym("CPL-IMPL::POLICY")), hint="WITH-POLICY takes a policy, WITH-NAMED-POLICY the name of one.")
    names = [symbol_name(name) for name in python_list(policy.parameters) if is_symbol(name)]
    if policy.counted and count != len(names) and not any(name.startswith("&") for name in names):
        error(
            types.SimpleProgramError("invalid number of arguments: ~S", count),
            hint=f"The parameters of the policy {shown(policy.name)} are {shown(policy.parameters)}.",
        )


def with_policy(policy, arguments, body, forms=None):
    """``(with-policy policy (form...) body...)``: call ``body()`` under ``policy`` and return its values. See `in_force`."""
    with in_force(policy, arguments, forms) as check:
        return body() if check is None else pursue(check, body)


@contextmanager
def in_force(policy: Policy, arguments: Callable[[], Any], forms: Any = None) -> Iterator[Thunk[object] | None]:
    """``with in_force(policy, arguments) as check:`` runs the block under ``policy``.

    ``check`` is a function that returns when the policy's check is met; the block runs it beside its own work. It is ``None`` if the
    policy has no check. ``arguments()`` evaluates the parameter forms to a Python sequence, again at each call of a clause. ``forms``
    are the forms themselves, a Lisp list, which the conditions show.
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
    """``(with-policies ((policy (form...))...) body...)``: nested `with_policy`, the first policy outermost.

    ``policies`` is a list of (policy, arguments, forms).
    """
    if not policies:
        return body()
    (policy, arguments, forms), *rest = policies
    return with_policy(policy, arguments, lambda: with_policies(rest, body), forms)


def _timeout_met(store, time):
    sleep(time)
    return True


TIMEOUT_POLICY = define_policy(
    sym("CPL-IMPL::TIMEOUT-POLICY"), list_from([sym("CPL-IMPL::TIME")]), "Ends its body after TIME seconds.", check=_timeout_met
)
