"""Fluents: cells whose changes others can observe, and nets of cells computed from cells.

A fluent is CRAM's means of communication between branches: a robot's pose, a flag, "the goal is near". Changing one *pulses*
it; a pulse wakes whoever waits, recomputes the nets built over it, and calls its callbacks, all before the assignment returns
and all in the task that assigned. A net is made by applying an operator to a fluent, ``(< distance 0.5)``, and is a fluent
again; see ``fluent_operators.py``. Waiting is in ``waiting.py``.

One task runs at a time, so there are no locks. Inputs hold their nets weakly: a net that nobody needs disappears, and its input
forgets it at the next pulse. Source: cpl.md section 2. Repaired: a net whose first computation fails leaves nothing behind on
its inputs; an error in one observer no longer keeps the others from being told; ``fl-value-changed`` applies its key always.
"""

from __future__ import annotations

import itertools
from weakref import ref

from cramhy_runtime import kernel

from ..lisp.conditions import SimpleTypeError, error
from ..lisp.data import MultipleValues, Symbol, truth
from ..lisp.equality import eql
from ..lisp.evaluation import functions
from ..lisp.objects.classes import find_class_or_error, make_instance
from ..lisp.objects.generic import generic
from ..lisp.packages import keyword
from .hooks import on_make_fluent_hook
from .symbols import sym

_count = itertools.count(1)


class Fluent:
    """What all fluents share: a name, a pulse counter, callbacks, nets computed from it, and tasks that wait for it.

    ``value`` reads (and may consume, see `PulseFluent`), ``peek`` reads without side effects.
    """

    __slots__ = ("_name", "number", "pulses", "waiters", "callbacks", "nets", "__weakref__")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::FLUENT"
    prefix = "FLUENT-"

    def __init__(self, name=None):
        self._name = name
        self.number = next(_count)
        self.pulses = 0
        self.waiters = ()
        self.callbacks = None
        self.nets = ()
        if on_make_fluent_hook:
            on_make_fluent_hook(self, True, None)

    @property
    def name(self):
        """A symbol or string; made up, ``FLUENT-<n>``, when none was given."""
        if self._name is None:
            self._name = Symbol(f"{self.prefix}{self.number}")
        return self._name

    def read(self):
        raise NotImplementedError

    peek = read
    value = property(lambda self: self.read(), doc="The current value; reading may consume a pulse.")

    def pulse(self):
        """Tell the observers. The value does not change by it; who waits for a value that is ``nil`` goes on waiting."""
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(self.peek())

    def _notify(self, value):
        problem = None
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
                    problem = problem or raised
            if stale:
                self.nets = [reference for reference in self.nets if reference() is not None]
        if self.callbacks:
            with kernel.shield():
                for callback in reversed(list(self.callbacks.values())):
                    try:
                        callback(value)
                    except BaseException as raised:
                        problem = problem or raised
        if problem is not None:
            raise problem

    def attach(self, net):
        """Have ``net`` told of pulses, as long as somebody else holds it."""
        nets = self.nets
        if not nets:
            self.nets = [ref(net)]
            return
        count = len(nets)
        if count >= 32 and not count & (count - 1):  # an input that never pulses must not collect dead nets for ever
            nets[:] = [reference for reference in nets if reference() is not None]
        nets.append(ref(net))

    def living_nets(self):
        return [net for net in (reference() for reference in self.nets) if net is not None]

    def __repr__(self):
        return f"#<FLUENT {getattr(self.name, 'name', self.name)}>"


class ValueFluent(Fluent):
    """A fluent that stores a value. Assign with `set` or ``fluent.value = x``."""

    __slots__ = ("stored", "test")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::VALUE-FLUENT"

    def __init__(self, name=None, value=None, test=None):
        self.stored = value
        self.test = function_of(test)
        super().__init__(name)

    def read(self):
        return self.stored

    peek = read

    def set(self, new):
        """Store ``new`` and pulse, unless the test says that nothing changed. Returns ``new``."""
        old = self.stored
        if self.test is None:
            if eql(old, new):
                return new
        elif truth(self.test(old, new)):
            return new
        self.stored = new
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(new)
        return new

    value = property(read, set, doc="The stored value; assigning pulses if it changes something.")

    def __repr__(self):
        return f"#<FLUENT {getattr(self.name, 'name', self.name)} [{self.stored!r}]>"


class Net(Fluent):
    """A fluent computed by ``formula(read)``, where ``read`` fetches an argument's value; ``inputs`` are its fluents."""

    __slots__ = ("formula", "inputs", "prefix")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-FLUENT"

    def __init__(self, operator, formula, inputs):
        self.prefix = "FN-" + operator
        self.formula = formula
        self.inputs = inputs
        super().__init__()
        for fluent in inputs:
            fluent.attach(self)

    def read(self):
        return self.formula(value)

    def peek(self):
        return self.formula(peek_value)

    def input_pulsed(self):
        self.pulse()


class CachedNet(Net):
    """A net all of whose inputs are cacheable: computed when an input pulses, and pulsing only when its value changes."""

    __slots__ = ("cached",)
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-CACHEABLE-FLUENT"

    def __init__(self, operator, formula, inputs):
        self.cached = formula(value)  # first: if it fails, the inputs never hear of this net
        super().__init__(operator, formula, inputs)

    def read(self):
        return self.cached

    peek = read

    def pulse(self):
        new = self.formula(value)
        old = self.cached
        if eql(old, new):
            return
        self.cached = new
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(new)

    input_pulsed = pulse


NEVER, ONCE, ALWAYS = "NEVER", "ONCE", "ALWAYS"


class PulseFluent(Fluent):
    """True while there are pulses of its parent that have not been consumed; reading it consumes (cpl.md 2.8).

    ``missed`` says what becomes of pulses that nobody saw: NEVER forgets those before its creation, ONCE joins them to one,
    ALWAYS keeps each.
    """

    __slots__ = ("parent", "missed", "seen", "processed")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::PULSE-FLUENT"
    prefix = "FN-PULSE-FLUENT"

    def __init__(self, parent, missed=ONCE):
        self.parent = parent
        self.missed = missed
        self.seen = parent.pulses
        self.processed = parent.pulses if missed == NEVER else 0
        super().__init__()
        parent.attach(self)

    def read(self):
        if self.processed >= self.seen:
            return None
        if self.missed == ALWAYS:
            self.processed += 1
        else:
            self.processed = self.seen
        return True

    def peek(self):
        return True if self.processed < self.seen else None

    def input_pulsed(self):
        self.seen = self.parent.pulses
        self.pulse()


class ChangeFluent(Net):
    """True when its parent's value is not what it was at the last reading (``fl-value-changed``)."""

    __slots__ = ("parent", "test", "key", "remembered")

    def __init__(self, parent, test, key):
        self.parent, self.test, self.key = parent, test, key
        self.remembered = key(value(parent))
        super().__init__("FL-UPDATED", self._look, (parent,))

    def _look(self, read):
        current = self.key(read(self.parent))
        if truth(self.test(current, self.remembered)):
            return None
        if read is value:
            self.remembered = current
        return True


def function_of(designator):
    """The function that a function or symbol stands for; ``None`` stays ``None``."""
    return None if designator is None else functions.function_of(designator)


def is_cacheable(fluent):
    return isinstance(fluent, (ValueFluent, CachedNet))


def value(fluent):
    """``(value x)``: the value of a fluent; any other object is its own value."""
    return fluent.read() if isinstance(fluent, Fluent) else fluent


def peek_value(fluent):
    """``(peek-value x)``: as `value`, consuming nothing."""
    return fluent.peek() if isinstance(fluent, Fluent) else fluent


set_value = generic("(setf CPL-IMPL::VALUE)", "(new-value fluent)", documentation="Assign a value fluent; returns the value.")
set_value.method(None, ValueFluent)(lambda new, fluent: fluent.set(new))


def pulse(fluent):
    """``(pulse fluent)``: tell its observers, though nothing changed. Returns nil."""
    fluent.pulse()


def make_fluent(*, class_=None, name=None, value=None, test=None, allow_tracing=True, max_tracing_freq=None, **others):
    """A new fluent, by default a value fluent with ``value``; ``test`` says which assignments change nothing (``eql``)."""
    if class_ is None and not others:
        return ValueFluent(name, value, test)
    cls = class_ if isinstance(class_, type) else find_class_or_error(class_ or sym("CPL-IMPL::VALUE-FLUENT"))
    if cls is ValueFluent and not others:
        return ValueFluent(name, value, test)
    initargs = [keyword("NAME"), name, keyword("VALUE"), value]
    if test is not None:
        initargs += [keyword("TEST"), test]
    for key, argument in others.items():
        initargs += [keyword(key.rstrip("_").replace("_", "-").upper()), argument]
    return make_instance(cls, *initargs)


def register_update_callback(fluent, name, function):
    """Call ``function`` with the value at every pulse of ``fluent``. A ``name`` that is taken is an error."""
    callbacks = fluent.callbacks
    if callbacks is None:
        callbacks = fluent.callbacks = {}
    if name in callbacks:
        return error("Callback with name ~a is already registered.", name)
    callbacks[name] = function_of(function)
    return function


def get_update_callback(fluent, name):
    """Two values: the callback registered under ``name`` (a net counts under its own name) and whether there is one."""
    if fluent.callbacks and name in fluent.callbacks:
        return MultipleValues((fluent.callbacks[name], True))
    for net in fluent.living_nets():
        if net.name is name:
            return MultipleValues((net.input_pulsed, True))
    return MultipleValues((None, None))


def remove_update_callback(fluent, name):
    """``True`` if there was a callback ``name`` and it is gone now, else nil."""
    if fluent.callbacks and name in fluent.callbacks:
        del fluent.callbacks[name]
        return True
    before = len(fluent.nets)
    fluent.nets = [reference for reference in fluent.nets if (net := reference()) is not None and net.name is not name]
    return True if len(fluent.nets) < before else None


def check_fluent(fluent):
    """Signal the type error of an operator that takes a fluent only."""
    if not isinstance(fluent, Fluent):
        error(SimpleTypeError("The value of FLUENT is ~S, which is not of type FLUENT.", fluent,
                              datum=fluent, expected_type="FLUENT"))
