"""Fluents: cells whose changes others can observe, and nets of cells computed from cells.

A fluent is CRAM's means of communication between branches: a robot's pose, a flag, "the goal is near". Changing a fluent *pulses*
it. A pulse wakes the tasks that wait for the fluent, recomputes the nets over it, and calls its callbacks. All of this happens in the
task that assigns, before the assignment returns. An operator applied to a fluent, ``(< distance 0.5)``, makes a net, which is a fluent
again; see ``operators.py``. Waiting is in ``tasks/waiting.py``.

One task runs at a time, so there are no locks. Inputs refer to their nets weakly: a net that is not used any more disappears, and its
input forgets it at the next pulse. ``languages/commonlisp/faces/cpl/user_methods.py`` enters the methods that users define on ``value``,
``pulse`` and so on.

Source: cpl.md section 2. Repaired: a net whose first computation fails leaves nothing behind on its inputs. An error in one observer
no longer keeps the pulse from the others. A net whose function lets other tasks run never keeps an old value. ``fl-value-changed``
always applies its key.
"""

from __future__ import annotations

import itertools
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, TypeVar, overload, subscripted
from weakref import WeakKeyDictionary, ref

from cramhy_runtime import kernel
from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.kernel.tasks import shield

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import SimpleTypeError, error, program_error
from cramhy_runtime.lisp_core.data import OWN_ANSWERS, TRUE_CLASSES, MultipleValues, Symbol, lisp_list, one, plain_truth, truth
from cramhy_runtime.lisp_core.equality import eql
from cramhy_runtime.lisp_core import functions
from cramhy_runtime.lisp_core.source_places import circumstance, locate
from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.classes import find_class_or_error
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import prin1_to_string, princ_to_string
from ..failures.failure_types import CompositeFailure
from ..hooks import on_make_fluent_hook
from ..symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    from ..signatures import Dependent, Name, Same
    from .notation import Notation
else:
    Notation = Generic

T = TypeVar("T", default=Any)
T_co = TypeVar("T_co", covariant=True, default=Any)
A = TypeVar("A")
F = TypeVar("F", bound="Fluent[object]")
C = TypeVar("C", bound="Callable[..., object]")
_count = itertools.count(1)
_class_watchers: list[Callable[[type[Fluent[object]]], object]] = []


def when_class_made(function):
    """Decorator: call ``function(cls)`` with each class of fluents that is made from now on."""
    _class_watchers.append(function)
    return function


class Fluent(Notation[T_co]):
    """The base of all fluents: a name, a pulse counter, callbacks, the nets computed from it, and the tasks that wait for it.

    ``value`` reads the fluent (and may consume a pulse, see ``pulse_fluents.py``); ``peek`` reads without side effects. Python's operators
    on fluents are in ``python_operators.py``, and their types in ``notation.pyi``.
    """

    __slots__ = ("_name", "number", "pulses", "waiters", "callbacks", "nets", "sheltered", "__weakref__")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::FLUENT"
    prefix = "FLUENT-"
    careful = False
    foreign = False  # whether reading it calls functions of the user
    __class_getitem__ = subscripted

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls._fluent_value = _slots_read_by.get(cls.read, Fluent._fluent_value)  # type: ignore[method-assign]  # a slot is a property, too
        for watcher in _class_watchers:
            watcher(cls)

    def __init__(self, name: Name | None = None):
        self._name = name
        self.number = next(_count)
        self.pulses = 0
        self.waiters: dict[kernel.Task[object], bool] | tuple[()] = ()
        self.callbacks: dict[Hashable, Callable[[Any], object]] | None = None
        self.nets: list[ref[Dependent]] | tuple[()] = ()
        self.sheltered = False  # while its nets are told, no request to end arrives

    @property
    def name(self) -> Name:
        """The name, a symbol or string. A fluent that was made without one is called ``FLUENT-<n>``."""
        if self._name is None:
            self._name = Symbol(f"{self.prefix}{self.number}")
        return self._name

    def read(self) -> T_co:
        """Signal that there is no method for ``value``: a class of a user has not defined one."""
        return no_applicable_method("CRAM-LANGUAGE-IMPLEMENTATION:VALUE", None, self)

    peek = read
    if not TYPE_CHECKING:
        value = property(lambda self: self.read(), doc="The current value; reading may consume a pulse.")

    @property
    def _fluent_value(self) -> T_co:
        """What `read` returns. Where `read` only returns a slot, this is that slot: to read it takes no call."""
        return self.read()

    def pulse(self) -> None:
        """Tell the observers, without changing the value. Tasks go on waiting if the value is nil."""
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(self.peek())

    def _notify(self, value: Any) -> None:
        if not self.nets and not self.callbacks:  # as a rule only tasks wait
            if value is True or value is not None and value is not False and (value.__class__ in TRUE_CLASSES or truth(value)):
                for task in self.waiters:
                    task.kernel.unpark(task)
        elif self.callbacks or self.sheltered:
            with shield(kernel.current()):
                self._tell(value)
        else:
            self._tell(value)

    def _tell(self, value: Any) -> None:
        callbacks = self.callbacks and list(self.callbacks.items())
        problem: BaseException | None = None
        if self.waiters and truth(value):
            for task in self.waiters:
                task.kernel.unpark(task)
        if self.nets:
            stale = False
            for reference in tuple(self.nets):
                net = reference()
                if net is None:
                    stale = True
                    continue
                try:
                    net.input_pulsed()
                except BaseException as raised:  # the others must hear of the pulse before it goes on
                    problem = raised if problem is None else _graver(problem, raised)
            if stale:
                self.nets = [reference for reference in self.nets if reference() is not None]
        if callbacks:
            for name, callback in reversed(callbacks):
                try:
                    _call_back(callback, value, name, self)
                except BaseException as raised:
                    problem = raised if problem is None else _graver(problem, raised)
        if problem is not None:
            raise problem

    def awaited(self) -> str:
        """A text for reports: what a task that waits for this fluent waits for."""
        return f"the fluent {prin1_to_string(self)}"

    def attach(self, net: Dependent) -> None:
        """Tell ``net`` of pulses from now on, as long as something else refers to it."""
        if net.careful:
            self.sheltered = True
        nets = self.nets
        if not nets:
            self.nets = [ref(net)]
            return
        count = len(nets)
        if count >= 32 and not count & (count - 1):  # an input that never pulses must not collect dead nets for ever
            nets[:] = [reference for reference in nets if reference() is not None]
        nets.append(ref(net))

    def living_nets(self) -> list[Dependent]:
        """The nets over this fluent that are still in use."""
        return [net for net in (reference() for reference in self.nets) if net is not None]

    def __repr__(self):
        return f"#<FLUENT {getattr(self.name, 'name', self.name)}>"


_slots_read_by: dict[Callable[..., Any], Any] = {}
"""A method `read` → the slot that it returns."""


def reads_slot(cls: Any, name: str) -> None:
    """Note that ``cls.read`` returns the slot ``name`` and does nothing else."""
    _slots_read_by[cls.read] = cls._fluent_value = vars(cls)[name]


@circumstance(lambda here: f"in the callback {princ_to_string(here['name'])} of {_shown(here['fluent'])}")
def _call_back(function, value, name, fluent):
    function(value)


def _graver(first, second):
    """Which of two exceptions of observers is raised: an error rather than an exit, else the first. The other error is noted in it."""
    if not isinstance(second, (Condition, Exception)):
        return first
    if not isinstance(first, (Condition, Exception)):
        return first if isinstance(first, (kernel.Cancelled, kernel.Interrupted, kernel.Abandoned)) else second
    condition, other = from_python(first), from_python(second)
    locate(other, second)
    if isinstance(condition, CompositeFailure):
        circumstance.add(condition, f"Another observer failed, too: {other}")
    else:
        condition.beside = [*getattr(condition, "beside", ()), ("Another observer failed, too", other)]
    return first


def _shown(fluent):
    return f"the fluent {princ_to_string(fluent.name)}"


COLLECTIONS = frozenset({list, dict, set, bytearray})
"""Collections of Python that change in place, beside the arrays of numpy."""


class ValueFluent(Fluent[T]):
    """A fluent that stores a value. Assign with `set` or ``fluent.value = x``."""

    __slots__ = ("stored", "test")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::VALUE-FLUENT"

    def __init__(self, name: Name | None = None, value: T = None, test: Same[T] | Symbol | None = None):  # type: ignore[assignment]
        self.stored: T = plain_truth(value)
        self.test = None if test is None else function_of(test)
        super().__init__(name)

    def read(self) -> T:
        return self.stored

    peek = read

    def stores(self, new: T) -> bool:
        """Store ``new`` without a pulse, unless the test says that nothing changed. Returns whether it was stored."""
        if truth(eql(self.stored, new)) if self.test is None else self._same(new):
            if new is False or new is None and self.stored is False:
                self.stored = new
            return False
        self.stored = plain_truth(new)
        return True

    def set(self, new: T) -> T:
        """Store ``new`` and pulse, unless the test says that nothing changed. Returns ``new``.

        A collection of Python that is stored once more pulses: it may have changed in place.
        """
        if self.test is None:
            old = self.stored
            kind = type(new)
            if kind is int:  # as most values of plans are
                if type(old) is int and old == new:
                    return new
            else:
                if kind not in TRUE_CLASSES and new is not True and new is not None and OWN_ANSWERS.get(kind, True):
                    new = plain_truth(new)
                    kind = type(new)
                if kind is type(old):
                    if (kind not in COLLECTIONS and kind.__name__ != "ndarray") if old is new else eql(old, new):
                        return new
                elif (old is False or new is False) and eql(old, new):  # of two classes only False is nil
                    self.stored = new  # without a pulse: it is one value in Lisp, and Python reads what it has written
                    return new
        elif self._same(new := plain_truth(new)):
            return new
        self.stored = new
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(new)
        return new

    def _same(self, new: T) -> bool:
        """The answer of the user's test. If other tasks assigned while it ran, the test is asked again, about the new value."""
        while True:
            old = self.stored
            same = truth(one(self.test(old, new)))
            if self.stored is old:
                return same

    if TYPE_CHECKING:

        @property
        def value(self) -> T:
            """The stored value; assigning pulses if it changes something."""

        @value.setter
        def value(self, new: T) -> None: ...
    else:
        value = property(read, set, doc="The stored value; assigning pulses if it changes something.")

    def __repr__(self) -> str:
        return f"#<FLUENT {getattr(self.name, 'name', self.name)} [{self.stored!r}]>"


reads_slot(ValueFluent, "stored")


class FunctionNamed:
    """Calls the function that a symbol has at the time of the call."""

    __slots__ = ("symbol",)

    def __init__(self, symbol):
        self.symbol = symbol

    def __call__(self, *arguments):
        return self.symbol.function(*arguments)


def function_of(designator: Any) -> Callable[..., Any]:
    """The function that a function or symbol stands for. A symbol is looked up again at each call."""
    return FunctionNamed(designator) if isinstance(designator, Symbol) else functions.function_of(designator)


@overload
def value(fluent: Fluent[A]) -> A: ...
@overload
def value(fluent: A) -> A: ...
def value(fluent: Any) -> Any:
    """``(value x)``: the value of a fluent. Any other object is its own value. Reading may consume a pulse. Source: cpl.md 2.3."""
    try:
        return fluent._fluent_value
    except AttributeError:
        if isinstance(fluent, Fluent):
            raise
        return fluent


@overload
def peek_value(fluent: Fluent[A]) -> A: ...
@overload
def peek_value(fluent: A) -> A: ...
def peek_value(fluent: Any) -> Any:
    """``(peek-value x)``: as `value`, but it consumes nothing. Source: cpl.md 2.4."""
    return fluent.peek() if isinstance(fluent, Fluent) else fluent


def set_value(new, fluent):
    """``(setf (value fluent) new)``: assign ``new`` to a value fluent. Returns ``new``. For other fluents there is no such method."""
    if isinstance(fluent, ValueFluent):
        if new.__class__ is list and fluent.stored is new and fluent.test is None:
            return new  # a vector of Lisp, which is EQL to itself
        return fluent.set(new)
    return no_applicable_method("(COMMON-LISP:SETF CRAM-LANGUAGE-IMPLEMENTATION:VALUE)", 1, new, fluent)


def pulse(fluent: Fluent[object]) -> None:
    """``(pulse fluent)``: tell the observers of ``fluent``, though its value did not change. Returns nil. Source: cpl.md 2.5."""
    if not isinstance(fluent, Fluent):
        return no_applicable_method("CRAM-LANGUAGE-IMPLEMENTATION:PULSE", None, fluent)
    fluent.pulse()


CLASS, NAME, VALUE, TEST = map(keyword, ("CLASS", "NAME", "VALUE", "TEST"))
ALLOW_TRACING, MAX_TRACING_FREQ = keyword("ALLOW-TRACING"), keyword("MAX-TRACING-FREQ")
_OF_VALUE_FLUENTS = {NAME, VALUE, TEST}


tracing_options: WeakKeyDictionary[Fluent[object], tuple[bool, float | None]] = WeakKeyDictionary()
"""Fluent → its options ``:allow-tracing`` and ``:max-tracing-freq``, for fluents that were made with one of them."""


_living: Cell[dict[ref[Fluent[object]], None]] = Cell({}, fresh=True)  # a weak reference to each fluent that somebody made, in order


def living_fluents() -> list[Fluent[object]]:
    """The fluents that ``make-fluent`` made and that are still in use, the oldest first."""
    return [fluent for reference in list(_living.value) if (fluent := reference()) is not None]


def announce(fluent: F, allow_tracing: bool = True, max_tracing_freq: float | None = None) -> F:
    """Run ``on-make-fluent-hook`` for a new fluent, and return the fluent. ``max_tracing_freq`` is in 1/s."""
    known = _living.value
    known[ref(fluent, known.pop)] = None
    if max_tracing_freq is not None or allow_tracing is not True:
        tracing_options[fluent] = (allow_tracing, max_tracing_freq)
    if on_make_fluent_hook.methods:
        on_make_fluent_hook(fluent, allow_tracing, max_tracing_freq)
    return fluent


@overload
def make_fluent(
    *,
    name: Name | None = None,
    value: None = None,
    test: Same[Any] | Symbol | None = None,
    allow_tracing: bool = True,
    max_tracing_freq: float | None = None,
) -> ValueFluent[Any]: ...
@overload
def make_fluent(
    *,
    name: Name | None = None,
    value: A,
    test: Same[A] | Symbol | None = None,
    allow_tracing: bool = True,
    max_tracing_freq: float | None = None,
) -> ValueFluent[A]: ...
@overload
def make_fluent(*, class_: type[F], **initargs: object) -> F: ...
def make_fluent(
    *,
    class_: Any = None,
    name: Any = None,
    value: Any = None,
    test: Any = None,
    allow_tracing: Any = True,
    max_tracing_freq: Any = None,
    **others: Any,
) -> Any:
    """A new fluent, by default a `ValueFluent` with ``value``.

    name: a string or symbol; without one the fluent is called ``FLUENT-<n>``. test: a function of the old and the new value. When it
    returns true, the assignment changes nothing and the fluent does not pulse; the default is ``eql``. allow_tracing, max_tracing_freq
    (1/s): advice for tracers. class_: a class of fluents; all other arguments are its initargs. An initarg that the class does not know
    is an error. Source: cpl.md 2.2.
    """
    if class_ is None and not others:
        return announce(ValueFluent(name, value, test), allow_tracing, max_tracing_freq)
    initargs = {CLASS: class_, NAME: name, VALUE: value, TEST: test}
    initargs = {key: argument for key, argument in initargs.items() if argument is not None}
    initargs.update((keyword(key.rstrip("_").replace("_", "-").upper()), argument) for key, argument in others.items())
    return _fluent_made(initargs, allow_tracing, max_tracing_freq)


def fluent_from_initargs(*initargs):
    """``(make-fluent :name name :value value :test test)``: a new fluent. With ``:class``, all other arguments are its initargs."""
    if len(initargs) % 2:
        return program_error("odd number of &KEY arguments")
    given = {}
    for index in range(0, len(initargs), 2):
        given.setdefault(initargs[index], initargs[index + 1])
    return _fluent_made(given, given.pop(ALLOW_TRACING, True), given.pop(MAX_TRACING_FREQ, None))


fluent_from_initargs.__lisp_lambda_list__ = lisp_list(
    sym("&REST"),
    sym("CPL-IMPL::ARGS"),
    sym("&KEY"),
    lisp_list(sym("CLASS"), lisp_list(sym("QUOTE"), sym("CPL-IMPL::VALUE-FLUENT"))),
    sym("CPL-IMPL::NAME"),
    sym("CPL-IMPL::VALUE"),
    lisp_list(sym("CPL-IMPL::ALLOW-TRACING"), True),
    sym("CPL-IMPL::MAX-TRACING-FREQ"),
    sym("&ALLOW-OTHER-KEYS"),
)


def _fluent_made(given, allow_tracing, max_tracing_freq):
    cls = given.pop(CLASS, None)
    if cls is None and given.keys() <= _OF_VALUE_FLUENTS:
        fluent = ValueFluent(given.get(NAME), given.get(VALUE), given.get(TEST))
    else:
        fluent = make_instance(find_class_or_error(cls or sym("CPL-IMPL::VALUE-FLUENT")), *itertools.chain(*given.items()))
    return announce(fluent, allow_tracing, max_tracing_freq)


def register_update_callback(fluent: Fluent[object], name: Hashable, function: C) -> C:
    """Call ``function`` with the value at every pulse of ``fluent``, in the task that pulses it. Returns ``function``.

    ``name`` identifies the callback; a name that is taken is an error. Source: cpl.md 2.6.
    """
    if not isinstance(fluent, Fluent):
        return no_applicable_method("CRAM-LANGUAGE-IMPLEMENTATION:REGISTER-UPDATE-CALLBACK", 1, fluent, name, function)
    callbacks = fluent.callbacks
    if callbacks is None:
        callbacks = fluent.callbacks = {}
    if name in callbacks:
        return error("Callback with name ~a is already registered.", name)
    callbacks[name] = function_of(function)
    return function


def get_update_callback(fluent, name):
    """Two values: the callback registered under ``name``, and whether there is one. A net over ``fluent`` counts under its own name."""
    if not isinstance(fluent, Fluent):
        return no_applicable_method("CRAM-LANGUAGE-IMPLEMENTATION:GET-UPDATE-CALLBACK", 1, fluent, name)
    if fluent.callbacks and name in fluent.callbacks:
        callback = fluent.callbacks[name]
        return MultipleValues((callback.symbol if callback.__class__ is FunctionNamed else callback, True))
    for net in fluent.living_nets():
        if net.name is name:
            return MultipleValues((net.input_pulsed, True))
    return MultipleValues((None, None))


def remove_update_callback(fluent: Fluent[object], name: Hashable) -> bool | None:
    """Remove the callback ``name``, or the net of that name. Returns ``True`` if there was one, else nil. Source: cpl.md 2.6."""
    if not isinstance(fluent, Fluent):
        return no_applicable_method("CRAM-LANGUAGE-IMPLEMENTATION:REMOVE-UPDATE-CALLBACK", 1, fluent, name)
    if fluent.callbacks and name in fluent.callbacks:
        del fluent.callbacks[name]
        return True
    before = len(fluent.nets)
    fluent.nets = [reference for reference in fluent.nets if (net := reference()) is not None and net.name is not name]
    return True if len(fluent.nets) < before else None


def check_fluent(fluent: object) -> None:
    """Signal a type error if ``fluent`` is not a fluent."""
    if not isinstance(fluent, Fluent):
        error(SimpleTypeError("The value of FLUENT is ~S, which is not of type FLUENT.", fluent, datum=fluent, expected_type="FLUENT"))
