"""Restarts: the ways to go on that code offers to handlers and to the user in the debugger.

A restart is found by its name, innermost first, on the stack that signals; invoking it usually unwinds to the form that offered it.
They are kept as a stack of clusters per task, like handlers, so a task sees its own and none of its parent's. Source: ANSI 9.1.4.2;
texts are SBCL's.
"""

from __future__ import annotations

from . import condition_types as types
from .data import MultipleValues, Symbol, truth
from .dynamic import binding, special
from .ports import PORTS
from .packages import is_symbol, printed, sym

_restarts = special(Symbol("*RESTART-CLUSTERS*"), None)
_everywhere = []


class Restart:
    """A way to go on, offered to handlers and shown by the debugger.

    ``function`` takes the arguments of ``invoke-restart``; ``report`` is a string or a function of no arguments or a stream.
    """

    def __init__(self, name, function, report=None, interactive=None, test=None):
        self.name = name
        self.function = function
        self.report_function = report
        self.interactive = interactive
        self.test = test
        self.conditions = ()

    def belongs_to(self, condition):
        """Whether it can be offered for ``condition``: associated with it or with none, and its test says so."""
        if condition is not None and self.conditions and not any(condition is own for own in self.conditions):
            return False
        return self.test is None or truth(self.test(condition))

    def report(self):
        """The text that the debugger shows."""
        report = self.report_function
        if report is None:
            return self.name.name if self.name is not None else ""
        if callable(report):
            return report()
        return str(report)

    def __repr__(self):
        return f"#<RESTART {printed(self.name)}>"


class RestartExit(BaseException):
    """Unwinds to the form that established a restart."""

    def __init__(self, token, index, arguments):
        self.token, self.index, self.arguments = token, index, arguments


def restart_bind(restarts, thunk):
    """Call ``thunk`` with the `Restart` objects ``restarts`` available, the first one innermost."""
    with binding(_restarts, (restarts, _restarts.value)):
        return thunk()


def restart_case(clauses, thunk):
    """Call ``thunk`` with restarts that unwind to here.

    ``clauses`` is a list of (name, function, report, interactive, test); the function's values are returned when its restart
    is invoked.
    """
    token = object()

    def unwinder(index):
        def unwind(*arguments):
            raise RestartExit(token, index, arguments)

        return unwind

    restarts = [Restart(clause[0], unwinder(index), *clause[2:]) for index, clause in enumerate(clauses)]
    try:
        return restart_bind(restarts, thunk)
    except RestartExit as exit_:
        if exit_.token is not token:
            raise
        chosen, exit_.__traceback__ = exit_, None  # that leads to this very frame: a circle
    return clauses[chosen.index][1](*chosen.arguments)


def with_simple_restart(name, report, thunk):
    """``with-simple-restart``: the values of ``thunk``, or nil and T when the restart ``name`` was invoked."""
    return restart_case([(name, lambda: MultipleValues((None, True)), report)], thunk)


def compute_restarts(condition=None):
    """The restarts that can be invoked now, innermost first."""
    found, clusters = [], _restarts.value
    while clusters is not None:
        cluster, clusters = clusters
        found += [restart for restart in cluster if restart.belongs_to(condition)]
    return found + [restart for restart in _everywhere if restart.belongs_to(condition)]


def offer_everywhere(restart):
    """Make ``restart`` the outermost one, of all stacks; its test says where it can be used."""
    _everywhere.append(restart)


def innermost_restarts():
    """The cluster of restarts that was offered last."""
    return _restarts.value[0]


def with_condition_restarts(condition, restarts, thunk):
    """``with-condition-restarts``: while ``thunk`` runs, ``restarts`` are those of ``condition`` and of no other."""
    for restart in restarts:
        restart.conditions = (condition, *restart.conditions)
    try:
        return thunk()
    finally:
        for restart in restarts:
            restart.conditions = restart.conditions[1:]


RESTART_DESIGNATOR = "(OR (AND SYMBOL (NOT NULL)) RESTART)"


def find_restart(designator, condition=None):
    """The innermost restart of that name, or the `Restart` itself; ``None`` when there is none."""
    if not isinstance(designator, Restart) and not is_symbol(designator):
        return PORTS.signals.type_error(designator, RESTART_DESIGNATOR, "\nwhen binding SB-KERNEL::IDENTIFIER")
    for restart in compute_restarts(condition):
        if restart is designator or (restart.name is designator and designator is not None):
            return restart
    return None


def invoke_restart(designator, *arguments):
    """``cl:invoke-restart``: call the restart's function, which usually does not return."""
    return _active(designator).function(*arguments)


def _active(designator):
    """The restart that ``designator`` names, which must be active."""
    if not isinstance(designator, Restart) and not is_symbol(designator):
        return PORTS.signals.type_error(designator, RESTART_DESIGNATOR, "\nwhen binding RESTART")
    restart = find_restart(designator)
    return PORTS.signals.error(types.SimpleControlError("No restart ~S is active.", designator)) if restart is None else restart


def invoke_restart_interactively(designator):
    restart = _active(designator)
    arguments = restart.interactive() if restart.interactive else ()
    return restart.function(*(arguments or ()))


def _standard_restart(name):
    symbol = sym(name)

    def invoke(*arguments):
        condition = arguments[-1] if arguments and isinstance(arguments[-1], types.Condition) else None
        values = arguments[:1] if name in ("USE-VALUE", "STORE-VALUE") else ()
        restart = find_restart(symbol, condition)
        if restart is not None:
            return restart.function(*values)
        if name in ("ABORT", "MUFFLE-WARNING"):
            PORTS.signals.error(types.SimpleControlError("No restart ~S is active.", symbol))
        return None

    invoke.__name__ = name.lower().replace("-", "_")
    return invoke


abort = _standard_restart("ABORT")
continue_ = _standard_restart("CONTINUE")
muffle_warning = _standard_restart("MUFFLE-WARNING")
use_value = _standard_restart("USE-VALUE")
store_value = _standard_restart("STORE-VALUE")
