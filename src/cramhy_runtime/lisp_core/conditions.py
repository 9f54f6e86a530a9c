"""Conditions: signalling before unwinding, handlers, and restarts.

In Common Lisp an error is first *signalled*: handlers run on top of the stack that found the problem, innermost first, and may
leave it by a non-local exit, call a restart, or decline. Only when all have declined does the debugger appear. Python's
``except`` runs when the stack is gone, so it can do none of this; therefore the runtime raises errors through `error` and its
relatives, and keeps a stack of handler clusters per task (trap 1 of cpl.md section 17).

Conditions are Python exceptions all the same: when no debugger is installed, an unhandled one is raised, so a plan called
from Python fails as Python code fails. ``error`` is under `Exception`; ``plan-failure``, a serious condition but no error, is
not, so ``except Exception`` does not swallow failures. An exception of foreign Python code is offered to handlers when it
passes their frame, that is, after its own frames have unwound; `from_python` makes the condition that they see.

The classes are in ``condition_types.py``, restarts in ``restarts.py``. Source: ANSI chapter 9; texts are SBCL's.
"""

from __future__ import annotations

import functools

from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE
from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn
from . import condition_types as types
from .catching import EVERYBODY, Case, Cluster, HandlerExit, handlers_in_force
from .condition_types import *  # noqa: F403  the classes are this module's interface too
from .condition_types import matches
from .data import LispString, MultipleValues, Symbol, UNBOUND, UndefinedFunction, all_values, list_from, truth, values
from .dynamic import binding, special
from . import plain_answers  # noqa: F401  the ports have answers from here on
from .ports import PORTS
from .python_exceptions import from_python
from .packages import CURRENT, ensure_package, find_package_or_error, intern, is_symbol, sym
from .restarts import *  # noqa: F403  they are part of this module's interface, as the classes are
from .restarts import compute_restarts, innermost_restarts, restart_case, with_condition_restarts, with_simple_restart

if TYPE_CHECKING:
    from collections.abc import Callable

DEBUGGER_HOOK = special("*DEBUGGER-HOOK*")
SBCL_HOOK = special(ensure_package("SB-EXT").intern("*INVOKE-DEBUGGER-HOOK*"))
SBCL_HOOK.package.export(SBCL_HOOK)
BREAK_ON_SIGNALS = special("*BREAK-ON-SIGNALS*")

_debugger = Cell(None)
_router = Cell(None)
_root = Cell(None)


def install_debugger(function):
    """Make ``function(condition)`` the debugger of last resort; ``None`` means: raise the condition. Returns the old one."""
    old, _debugger.value = _debugger.value, function
    return old


def install_router(find):
    """Ask ``find()`` at each error for the debugger of the task that runs; where it returns ``None`` the installed one is called."""
    _router.value = find


def _debugger_at_hand():
    return _router.value is not None and _router.value() or _debugger.value


def install_root(handler):
    """Have ``handler(condition)`` called for an error that all handlers declined, before any debugger: the root of a plan's task."""
    _root.value = handler


# ---------------------------------------------------------------------------------------------------------------- handlers


def signal_condition(condition):
    """Offer ``condition`` to the handlers, innermost first. Returns when all have declined."""
    exit_ = handled(condition)
    if exit_ is not None:
        raise exit_


def handled(condition, run=None):
    """As `signal_condition`, but the exit to a ``handler-case`` compiled in place is returned, for the caller to raise: of fewer frames.

    run: the pair of the innermost handlers, if they have declined already.
    """
    if run is not None:
        clusters = run[1]
    else:
        if BREAK_ON_SIGNALS.value is not None and truth(BREAK_ON_SIGNALS.value):
            _break_on_signal(condition)
        condition.signalled = True
        running = ACTIVE.value
        clusters = None if running is None else running.current.handlers
    while clusters is not None:
        cluster, outer = clusters
        if cluster.__class__ is Case:
            exit_ = cluster.exit_for(condition, clusters)
            if exit_ is not None:
                return exit_
        elif isinstance(cluster, Cluster):
            cluster.offer(condition, clusters)
        else:
            _offer(condition, clusters)
        clusters = outer
    return None


def _break_on_signal(condition):
    # bound to nil meanwhile, so that neither the debugger nor a type that is none breaks again (SBCL's texts)
    def stop():
        with binding(BREAK_ON_SIGNALS, None):
            if matches(condition, wanted):
                breaking.append(True)
                break_("~A~%BREAK was entered because of *BREAK-ON-SIGNALS* (now rebound to NIL).", condition)

    def reassign(new=None):
        BREAK_ON_SIGNALS.value = new

    wanted, breaking = BREAK_ON_SIGNALS.value, []
    restart_case(
        [
            (sym("CRAMHY::RESET"), reassign, "Set *BREAK-ON-SIGNALS* to NIL and continue."),
            (
                sym("CRAMHY::REASSIGN"),
                reassign,
                lambda: (
                    "Return from BREAK and assign a new value to *BREAK-ON-SIGNALS*."
                    if breaking
                    else "Assign a new value to *BREAK-ON-SIGNALS* and continue with signal handling."
                ),
                ask_value,
            ),
        ],
        stop,
    )


def _offer(condition, clusters):
    # A handler runs with only the handlers outside its own cluster in force (ANSI 9.1.4).
    cluster, outer = clusters
    if isinstance(cluster, Cluster):
        cluster.offer(condition, clusters)
        return
    for specifier, handler in cluster:
        if matches(condition, specifier):
            task = kernel.current()
            before, task.handlers = task.handlers, outer
            try:
                handler(condition)
            except (types.Condition, Exception) as raised:
                raised_by_handler(raised)
                raise
            finally:
                task.handlers = before


def raised_by_handler(exception):
    """Ask the handlers outside now; those inside, which it passes on its way out, are not to be asked (ANSI 9.1.4)."""
    if isinstance(exception, types.Condition):
        if not exception.signalled:
            signal_condition(exception)
    elif getattr(exception, "__lisp_asked__", None) is not EVERYBODY:
        if not _were_asked(exception, handlers_in_force()):
            signal_condition(from_python(exception))
        try:
            exception.__lisp_asked__ = EVERYBODY
        except AttributeError:
            pass


def handler_bind(clauses, thunk):
    """Call ``thunk`` with ``clauses`` in force, a list of (type specifier, function); returns its values."""
    task = kernel.current()
    before = task.handlers
    task.handlers = clauses, before
    try:
        return thunk()
    except (types.Condition, Exception) as exception:
        offer_late(exception)
        raise
    finally:
        task.handlers = before


def offer_late(exception):
    """Offer ``exception``, which is about to leave the extent of the innermost handlers, to these, unless they were asked before.

    Python code raised it without signalling, or it is foreign: its frames are gone, and now the handlers get their turn.
    """
    clusters = handlers_in_force()
    if isinstance(exception, types.Condition):
        if not exception.signalled:
            _offer(exception, clusters)
    elif not _were_asked(exception, clusters):
        _offer(from_python(exception), clusters)


def handler_case(clauses, thunk, no_error=None):
    """Call ``thunk``; on a condition of a clause's type unwind, and return what the clause's function returns for it.

    ``clauses`` is a list of (type specifier, function of one argument); ``no_error`` gets the values of a normal return.
    """
    token = object()

    def chooser(index):
        def handler(condition):
            raise HandlerExit(token, index, condition)

        return handler

    bound = [(specifier, chooser(index)) for index, (specifier, _) in enumerate(clauses)]
    try:
        result = handler_bind(bound, thunk)
    except HandlerExit as exit_:
        if exit_.token is not token:
            raise
        chosen, exit_.__traceback__ = exit_, None  # that leads to this very frame: a circle
    else:
        if no_error is None:
            return result
        return no_error(*all_values(result))
    return clauses[chosen.index][1](chosen.condition)


def ignore_errors(thunk):
    """``ignore-errors`` for Python rooms: the values of ``thunk``, or nil and the error."""
    return handler_case([(types.Error, lambda condition: MultipleValues((None, condition)))], thunk)


def guarded(thunk: Callable[[], Any], otherwise: Callable[[Any], Any]) -> Any:
    """The value of ``thunk()``; if it signals a serious condition, ``otherwise(condition)``."""
    return handler_case([(types.SeriousCondition, otherwise)], thunk)


# --------------------------------------------------------------------------------------------------------------- signalling


def make_condition(datum, arguments=(), default=types.SimpleError):
    """The condition that the designator ``datum`` with ``arguments`` stands for (ANSI 9.1.2.1)."""
    if datum.__class__ is str:
        if default.__init__ is not types.SimpleCondition.__init__:
            return default(datum, *arguments)
        condition = default.__new__(default)  # without its constructor, which takes twice the time
        condition.format_control, condition.format_arguments = datum, arguments
        return condition
    if datum.__class__ is Symbol:
        cls = PORTS.classes.find(datum, False)
        if isinstance(cls, type) and issubclass(cls, types.Condition):
            return PORTS.classes.make(cls, *arguments)
    if isinstance(datum, types.Condition):
        return type_error(list_from(arguments), "NULL") if arguments else datum
    if isinstance(datum, type) and issubclass(datum, types.Condition):
        return _instance(datum, arguments)
    if isinstance(datum, str) or isinstance(datum, LispString) or callable(datum) and not is_symbol(datum):
        return default(datum if callable(datum) else str(datum), *arguments)
    if is_symbol(datum):
        cls = PORTS.classes.find(datum, False)
        if not (isinstance(cls, type) and issubclass(cls, types.Condition)):
            return error(
                types.SimpleTypeError("~S does not designate a condition class.", datum, datum=datum, expected_type=sym("CONDITION"))
            )
        return _instance(cls, arguments)
    return type_error(datum, "(OR STRING FUNCTION SYMBOL CONDITION SB-PCL::CONDITION-CLASS)", "\nwhen binding SB-KERNEL::DATUM")


def _instance(cls, arguments):
    return PORTS.classes.make(cls, *arguments)


def designated(datum):
    """``datum``, a designator for ``signal`` or ``warn``, which have a text of their own for others."""
    if (
        datum.__class__ is Symbol
        or isinstance(datum, (str, types.Condition))
        or is_symbol(datum)
        or callable(datum)
        or isinstance(datum, LispString)
    ):
        return datum
    return error(types.SimpleTypeError("~S does not designate a condition class.", datum, datum=datum, expected_type=sym("SYMBOL")))


def signal(datum, *arguments):
    """``cl:signal``: offer the condition to the handlers; nil when all decline."""
    signal_condition(make_condition(designated(datum), arguments, types.SimpleCondition))


def error(datum: object, *arguments: object, hint: str | Callable[[], str] | None = None) -> NoReturn:
    """``cl:error``: signal, then enter the debugger. Never returns normally.

    hint: becomes the condition's; Python code only can give it.
    """
    condition = make_condition(datum, arguments)
    if hint is not None:
        condition.hint = hint
    signal_error(condition)


def signal_error(condition: types.Condition) -> NoReturn:
    """What `error` does with its condition."""
    exit_ = handled(condition)
    if exit_ is not None:
        raise exit_
    nobody_handled(condition)


def nobody_handled(condition: types.Condition) -> NoReturn:
    """What `error` does with a condition that all handlers declined."""
    if ACTIVE.value is None:
        raise condition  # there is no task, and no debugger
    if _root.value is not None:
        _root.value(condition)
    invoke_debugger(condition)


def error_in_case(task, run, datum, *arguments):
    """``error`` in the very function whose ``handler-case`` runs as ``run``, in ``task``.

    Returns (the clause, the condition) if a clause fits: the function goes there, and nothing is to be unwound. Else it does what `error`
    does.
    """
    condition = make_condition(datum, arguments)
    if task.handlers is not run or BREAK_ON_SIGNALS.value is not None:
        return signal_error(condition)
    condition.signalled = True
    index = run[0].clause_for(condition)
    if index >= 0:
        return index, condition
    exit_ = handled(condition, run)
    if exit_ is not None:
        raise exit_
    return nobody_handled(condition)


def cerror(continue_format, datum, *arguments):
    """``cl:cerror``: as `error`, with a restart CONTINUE that makes it return nil."""
    if is_symbol(continue_format) or not (isinstance(continue_format, (str, LispString)) or callable(continue_format)):
        type_error(continue_format, "(OR STRING FUNCTION)", "\nwhen binding SB-KERNEL::CONTINUE-STRING")
    condition = datum if isinstance(datum, types.Condition) else make_condition(datum, arguments)
    _continuable(continue_format, condition, arguments)


def _continuable(continue_format, condition, arguments):
    with_simple_restart(sym("CONTINUE"), lambda: types.formatted(continue_format, arguments), lambda: error(condition))


def warn(datum, *arguments):
    """``cl:warn``: signal a warning; unless muffled, print ``WARNING: text`` to ``*error-output*``. Returns nil."""
    condition = make_condition(designated(datum), arguments, types.SimpleWarning)
    if not isinstance(condition, types.Warning_):
        if isinstance(datum, types.Condition):
            return type_error(condition, "WARNING")
        return error(types.SimpleTypeError("~S does not designate a WARNING class", datum, datum=datum, expected_type=sym("WARNING")))

    def report_it():
        signal_condition(condition)

        PORTS.output.warning(condition)

    with_simple_restart(sym("MUFFLE-WARNING"), "Skip warning.", report_it)


def style_warn(control, *arguments):
    warn(types.SimpleStyleWarning(control, *arguments))


def enter_debugger(condition):
    """Call ``sb-ext:*invoke-debugger-hook*``, ``*debugger-hook*``, then the installed debugger.

    Returns when none leaves by a restart, as where nobody is asked.
    """
    for variable in (SBCL_HOOK, DEBUGGER_HOOK):
        hook = variable.value
        if truth(hook):
            with binding(variable, None):
                (hook.function if isinstance(hook, Symbol) else hook)(condition, hook)
    debugger = _debugger_at_hand()
    if debugger is not None:
        debugger(condition)


def invoke_debugger(condition: types.Condition) -> NoReturn:
    """``cl:invoke-debugger``; without a debugger, ``condition`` itself is raised."""
    enter_debugger(condition)
    condition.restarts = compute_restarts(condition)
    condition.signalled = True
    raise condition


def break_(control="break", *arguments):
    """``cl:break``: enter the debugger directly, with a restart CONTINUE."""

    def stop():
        with binding(DEBUGGER_HOOK, None):  # a break is for the user, not for a program's hook
            invoke_debugger(make_condition(control, arguments, types.SimpleCondition))

    with_simple_restart(sym("CONTINUE"), "Return from BREAK.", stop)


def signal_with_restarts(operator, *arguments):
    """Signal by ``operator`` (ERROR, CERROR, SIGNAL or WARN) a condition to which the innermost cluster of restarts belongs."""
    if operator == "CERROR":
        continue_format, datum, *rest = arguments
        condition = make_condition(datum, rest)
        signaller = functools.partial(_continuable, continue_format, condition, rest)
    else:
        datum, *rest = arguments
        function, default = {
            "ERROR": (error, types.SimpleError),
            "SIGNAL": (signal, types.SimpleCondition),
            "WARN": (warn, types.SimpleWarning),
        }[operator]
        condition = make_condition(datum, rest, default)
        signaller = functools.partial(function, condition)
    return with_condition_restarts(condition, innermost_restarts(), signaller)


# ------------------------------------------------------------------------------------------- errors that the runtime signals


def type_error(datum: object, expected: object, context: str = "") -> NoReturn:
    """Signal a type-error: ``datum`` is not of type ``expected`` (printed form of a type); ``context`` is appended."""
    condition = types.TypeError_(datum, expected)
    condition.context = context
    return error(condition)


def as_name(thing):
    """``thing`` as the key of a table of names. A vector, which a ``dict`` of Python refuses, is a type-error."""
    return thing if thing.__class__.__hash__ is not None else type_error(thing, "SYMBOL")


def unbound_variable(symbol):
    """Signal that ``symbol`` has no value. Restarts: CONTINUE (look again), USE-VALUE, STORE-VALUE; returns the value."""

    def again():
        return symbol.value if symbol.value is not UNBOUND else unbound_variable(symbol)

    def store(value):
        symbol.value = value
        return value

    return restart_case(
        [
            (sym("CONTINUE"), again, lambda: f"Retry using {types.shown(symbol)}."),
            (sym("USE-VALUE"), lambda value: value, "Use specified value.", ask_value),
            (sym("STORE-VALUE"), store, "Set specified value and use it.", ask_value),
        ],
        lambda: error(types.UnboundVariable(symbol)),
    )


def undefined_function(symbol, arguments, keywords):
    """Signal that ``symbol`` has no function; the restarts of SBCL decide what the call returns."""

    def again():
        function = symbol.function if isinstance(symbol, Symbol) else UndefinedFunction(symbol)
        return function(*arguments, **keywords)

    def use(function):
        return (function.function if isinstance(function, Symbol) else function)(*arguments, **keywords)

    return restart_case(
        [
            (sym("CONTINUE"), again, lambda: f"Retry calling {types.shown(symbol)}."),
            (sym("USE-VALUE"), use, "Call specified function.", ask_value),
            (sym("RETURN-VALUE"), values, "Return specified values.", ask_value),
            (sym("RETURN-NOTHING"), values, "Return zero values."),
        ],
        lambda: error(types.UndefinedFunction(symbol)),
    )


def ask_value():
    """The arguments of a restart that wants one value: what the user types."""
    return (PORTS.user.form("Enter a form to be evaluated: "),)


def package_error(package, text):
    return error(types.PackageError(package, text))


def package_does_not_exist(name, hint=None):
    """Signal that ``name`` designates no package (or is a deleted one); the restarts give a package. hint: what to try, or ``None``."""
    current = CURRENT.value
    restarts = [
        (sym("CONTINUE"), lambda: current, lambda: f"Use the current package, {current.name}."),
        (sym("RETRY"), lambda: find_package_or_error(name), "Retry finding the package."),
        (sym("USE-VALUE"), find_package_or_error, "Specify a different package", ask_value),
    ]
    return restart_case(restarts, lambda: error(types.PackageDoesNotExist(name), hint=hint))


def program_error(control, *arguments):
    return error(types.SimpleProgramError(control, *arguments))


def unknown_key(key, known):
    """Signal the program-error of a call with a keyword argument that the function does not take, SBCL's text; ``known``: those that it
    takes."""
    return error(
        types.SimpleProgramError("unknown &KEY argument: ~S", key),
        hint=f"The function takes {', '.join(map(repr, known)) or 'no keywords'}.",
    )


def wrong_argument_count(given, hint=None):
    """Signal the program-error of a call with ``given`` arguments, SBCL's text; ``hint`` may say how many there are to be."""
    return error(types.SimpleProgramError("invalid number of arguments: ~S", given), hint=hint)


def signal_exception(exception):
    """Signal the condition for a foreign ``exception`` where it came into Lisp. Handlers run, the debugger opens if there is one.

    Returns when nobody wanted it: then the exception is to be raised again, so that Python code above sees its own. On its way up
    it may come into Lisp again; handlers that were asked are not asked once more.
    """
    if _were_asked(exception, handlers_in_force()):
        return
    condition = from_python(exception)
    signal_condition(condition)
    if _root.value is not None:
        _root.value(condition)
    if _debugger_at_hand() is not None or truth(DEBUGGER_HOOK.value):
        invoke_debugger(condition)
    note_asked(exception)


def note_asked(exception):
    """The handlers in force have heard of ``exception``: it may be raised, and they are not asked as it passes them."""
    try:
        exception.__lisp_asked__ = (handlers_in_force(),)
    except AttributeError:
        pass


def _were_asked(exception, clusters):
    """Whether the handlers ``clusters`` have seen the condition of ``exception`` before."""
    asked = getattr(exception, "__lisp_asked__", None)
    if asked is None:
        return False
    if asked is EVERYBODY:
        return True
    asked = asked[0]
    while asked is not clusters and asked is not None:
        asked = asked[1]
    return asked is clusters


class _Signals:
    """How data, packages and restarts, which stand below this module, signal errors."""

    error = staticmethod(error)
    type_error = staticmethod(type_error)
    undefined_function = staticmethod(undefined_function)
    package_error = staticmethod(package_error)
    package_does_not_exist = staticmethod(package_does_not_exist)
    intern = staticmethod(intern)


PORTS.install(signals=_Signals())
