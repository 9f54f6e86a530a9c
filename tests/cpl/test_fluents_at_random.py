"""Random programs on a handful of fluents, compared with a model that says what section 2 of cpl.md says and nothing else.

The model knows no tasks and no speed: a fluent there is a record, a pulse asks all fluents made later whether it concerns them, and
what is cached is computed anew from the definition. Programs assign, pulse, read, peek, register and remove callbacks, and make nets
and pulse fluents on whatever there is.
"""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime import cpl
from cramhy_runtime.cpl.fluents import operators as op
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.packages import keyword

SMALL = st.integers(-2, 3)
PLACE = st.integers(0, 11)
VALUES = st.one_of(st.none(), SMALL)


def number(value):
    return value if isinstance(value, int) and value is not True else 0


def add(*values):
    """Total over anything: the programs are to differ in what fluents do, not in type errors."""
    return sum(map(number, values))


FUNCTIONS = {
    "add": (add, lambda *a: cpl.fl_funcall(add, *a)),
    "not": (lambda a, *_: None if a is not None else True, lambda a, *_: op.fl_not(a)),
    "eql": (lambda a, b, *_: True if type(a) is type(b) and a == b else None, lambda a, b, *_: op.fl_eql(a, b)),
}
MODES = ["NEVER", "ONCE", "ALWAYS"]


class Model:
    """One fluent of the model."""

    def __init__(self, world, kind, inputs=(), **slots):
        self.world, self.kind, self.inputs = world, kind, inputs
        self.pulses, self.callbacks = 0, {}
        self.__dict__.update(slots)
        self.cacheable = kind == "value" or (kind in ("net", "and", "or") and all(each.cacheable for each in inputs))
        if self.cacheable and kind != "value":
            self.cached = self.compute(False)
        world.append(self)

    def compute(self, peek):
        """What the definition of a net says."""
        if self.kind == "net":
            return self.function(*[each.value(peek) for each in self.inputs])
        result = True if self.kind == "and" else None
        for each in self.inputs:
            result = each.value(peek)
            if (result is None) == (self.kind == "and"):
                return result
        return result

    def value(self, peek=False):
        if self.kind == "value":
            return self.stored
        if self.kind == "pulsed":
            if self.processed >= self.seen:
                return None
            if not peek:
                self.processed = self.processed + 1 if self.mode == "ALWAYS" else self.seen
            return True
        if self.kind == "changed":
            current = self.inputs[0].value(peek)
            if same(current, self.remembered):
                return None
            if not peek:
                self.remembered = current
            return True
        return self.cached if self.cacheable else self.compute(peek)

    def set(self, new):
        if not same(self.stored, new):
            self.stored = new
            self.pulse()

    def pulse(self):
        if self.cacheable and self.kind != "value":
            new = self.compute(False)
            if same(new, self.cached):
                return
            self.cached = new
        self.pulses += 1
        value = self.value(True) if self.observed() else None
        for other in list(self.world):
            if self in other.inputs:
                if other.kind == "pulsed":
                    other.seen = self.pulses
                other.pulse()
        for seen in self.callbacks.values():
            seen.append(value)

    def observed(self):
        return self.callbacks or any(self in other.inputs for other in self.world)


def same(a, b):
    return type(a) is type(b) and a == b


class Pair:
    """A fluent, and the model of it."""

    def __init__(self, real, model):
        self.real, self.model = real, model
        self.real_seen, self.model_seen = {}, {}


class World:
    def __init__(self):
        self.models, self.pairs = [], []

    def make(self, real, kind, inputs=(), **slots):
        self.pairs.append(Pair(real, Model(self.models, kind, tuple(pair.model for pair in inputs), **slots)))

    def at(self, place):
        return self.pairs[place % len(self.pairs)]

    def do(self, command, *arguments):
        getattr(self, "do_" + command)(*arguments)
        for pair in self.pairs:
            assert same(cpl.peek_value(pair.real), pair.model.value(True)), (command, arguments, pair.real)
            assert pair.real.pulses == pair.model.pulses, (command, arguments, pair.real)
            assert pair.real_seen == pair.model_seen, (command, arguments, pair.real)

    def do_fluent(self, value):
        self.make(cpl.make_fluent(value=value), "value", stored=value)

    def do_set(self, place, value):
        values = [pair for pair in self.pairs if pair.model.kind == "value"]
        pair = values[place % len(values)]
        assert pair.real.set(value) == value
        pair.model.set(value)

    def do_pulse(self, place):
        pair = self.at(place)
        assert cpl.pulse(pair.real) is None
        pair.model.pulse()

    def do_read(self, place, times):
        pair = self.at(place)
        for _ in range(times):
            assert same(cpl.value(pair.real), pair.model.value())

    def do_net(self, name, first, second):
        a, b = self.at(first), self.at(second)
        function, lifted = FUNCTIONS[name]
        self.make(lifted(a.real, b.real), "net", (a,) if name == "not" else (a, b), function=function)

    def do_junction(self, kind, first, second):
        a, b = self.at(first), self.at(second)
        self.make((op.fl_and if kind == "and" else op.fl_or)(a.real, b.real), kind, (a, b))

    def do_apply(self, first, second):
        a, b = self.at(first), self.at(second)
        self.make(
            cpl.fl_apply(lambda lead, rest: add(lead, *rest), a.real, lisp_list(b.real, 1)),
            "net",
            (a, b),
            function=lambda lead, rest: add(lead, rest, 1),
        )

    def do_pulsed(self, place, mode):
        pair = self.at(place)
        count = pair.model.pulses
        self.make(
            cpl.pulsed(pair.real, handle_missed_pulses=keyword(mode)),
            "pulsed",
            (pair,),
            mode=mode,
            seen=count,
            processed=count if mode == "NEVER" else 0,
        )

    def do_changed(self, place):
        pair = self.at(place)
        real = cpl.fl_value_changed(pair.real)
        self.make(real, "changed", (pair,), remembered=pair.model.value())

    def do_callback(self, place, name):
        pair = self.at(place)
        if name in pair.model.callbacks:
            assert cpl.remove_update_callback(pair.real, name) is True
            del pair.model.callbacks[name]
        else:
            pair.real_seen.setdefault(name, [])
            pair.model_seen.setdefault(name, [])
            cpl.register_update_callback(pair.real, name, pair.real_seen[name].append)
            pair.model.callbacks[name] = pair.model_seen[name]


COMMANDS = st.one_of(
    st.tuples(st.just("fluent"), VALUES),
    st.tuples(st.just("set"), PLACE, VALUES),
    st.tuples(st.just("set"), PLACE, VALUES),
    st.tuples(st.just("pulse"), PLACE),
    st.tuples(st.just("read"), PLACE, st.integers(1, 3)),
    st.tuples(st.just("net"), st.sampled_from(sorted(FUNCTIONS)), PLACE, PLACE),
    st.tuples(st.just("junction"), st.sampled_from(["and", "or"]), PLACE, PLACE),
    st.tuples(st.just("apply"), PLACE, PLACE),
    st.tuples(st.just("pulsed"), PLACE, st.sampled_from(MODES)),
    st.tuples(st.just("changed"), PLACE),
    st.tuples(st.just("callback"), PLACE, st.sampled_from(["a", "b"])),
)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(COMMANDS, min_size=10, max_size=40))
def test_a_random_program_does_what_the_model_says(program):
    world = World()
    world.do("fluent", 1)
    for command in program:
        if len(world.pairs) < 12 or command[0] in ("set", "pulse", "read", "callback"):
            world.do(*command)


def test_the_model_is_held_to_its_word():
    """It notices a fluent that pulses once too often."""
    world = World()
    world.do("fluent", 1)
    world.do("net", "not", 0, 0)
    world.pairs[0].real.pulses += 1
    try:
        world.do("read", 0, 1)
    except AssertionError:
        return
    raise AssertionError("it did not notice")
