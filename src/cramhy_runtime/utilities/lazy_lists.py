"""Lazy lists: ordinary cons lists whose rest is computed when somebody looks.

The last cdr of a lazy list is a `LazyTail` instead of ``nil``. Looking at it (`lazy_cdr`, `force_ll`, unification) computes the
next cells and puts them in its place, so all holders of the list share the work, and a completely forced list is an ordinary
proper list. The first element is computed when the list is created, each further one when it is first asked for.

Two laws beyond the original: a tail is computed once, even when the list was copied, because the tail remembers its value; and
a second task that asks for a tail while a first one computes it waits for the first. Source: prolog.md section 4, cpl.md 13.1.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import (
    STRETCH,
    UNSUPPLIED,
    Cons,
    LazyRest,
    Symbol,
    all_values,
    lisp_list,
    list_from,
    list_parts,
    one,
    truth,
)
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import write
from cramhy_runtime.lisp_core.printing import address, define_printer, output_object, print_unreadable
from cramhy_runtime.lisp_core.printing import print_slots
from cramhy_runtime.lisp_core.restarts import restart_case

from .wait_queue import Line
from .symbols import sym

CONT, NEXT, FINISH, REST = map(keyword, ("CONT", "NEXT", "FINISH", "REST"))

_environment = special(Symbol("*LAZY-LIST-ENVIRONMENT*"))


class Once:
    """A value that the first who asks computes, by ``generator``, and that is remembered; who asks meanwhile waits for the first.

    When that one ends before it has the value, the next computes it.
    """

    __slots__ = ("generator", "value", "worker", "line")
    circle, why = "A promise needs its own value to compute that value.", "the value of a promise that another task computes"

    def __init__(self, generator):
        self.generator = generator
        self.worker = self.line = None

    def force(self):
        """The value."""
        if self.begin():
            try:
                self.value = one(self.generator())
                self.generator = None
            finally:
                self.end()
        return self.value

    def begin(self):
        """True if the task is to compute the value now, and call `end` then; false if the value is there."""
        while self.generator is not None and self.worker is not None:
            if self.worker is kernel.current():
                error(self.circle)
            if self.line is None:
                self.line = Line()
            self.line.stand(self.why)
        if self.generator is None:
            return False
        self.worker = kernel.current()
        return True

    def end(self):
        self.worker = None
        if self.line is not None:
            line, self.line = self.line, None
            line.serve_all()


class LazyTail(Once, LazyRest):
    """The rest of a lazy list, not yet computed. ``generator`` takes no arguments and returns the rest: a list or ``None``.

    ``drain``, if given, returns all remaining elements at once, a Python list or a Lisp list, which is quicker for whoever wants the
    whole list.
    """

    __slots__ = ("drain",)
    circle, why = "A lazy list needs its own next element to compute that element.", "the element of a lazy list that another task computes"

    def __init__(self, generator, drain=None):
        self.generator = generator
        self.drain = drain
        self.worker = self.line = None

    def force(self, completely=False):
        """The rest of the list; computed at the first call, remembered afterwards. ``completely``: all of it, where possible."""
        if self.generator is None or not self.begin():
            return self.value
        try:
            if completely and self.drain is not None:
                rest = self.drain()
                if rest.__class__ is list:
                    rest = list_from(rest)
            else:
                rest = self.generator()
                while isinstance(rest, LazyTail):
                    rest = rest.force()
            self.value, self.generator, self.drain = rest, None, None
        finally:
            self.end()
        return rest

    def computed(self):
        """The rest for Python code, which may have no kernel."""
        with kernel.at_hand():
            return self.force()

    def __repr__(self):
        return "#<lazy tail>" if self.generator is not None else f"#<forced tail {self.value!r}>"


def tail(generator, drain=None):
    """A `LazyTail` for ``generator`` that runs in the lazy-list environment in force now."""
    environment = _environment.value
    if environment is None:
        return LazyTail(generator, drain)

    return LazyTail(lambda: _in_environment(environment, generator))


def beginning(generator):
    """``generator()``, which computes the first element of a lazy list, in the lazy-list environment: it sees what later ones see."""
    environment = _environment.value
    return generator() if environment is None else _in_environment(environment, generator)


def _in_environment(environment, generator):
    with binding(_environment, environment):
        with binding(*(item for symbol, thunk in environment for item in (symbol, one(thunk())))):
            return generator()


def with_lazy_list_dynamic_environment(definitions, thunk):
    """Call ``thunk``; lazy lists created inside compute each element, the first one too, with ``definitions`` bound anew.

    ``definitions`` is a list of (symbol, thunk giving its value). Source: prolog.md section 4.
    """
    with binding(_environment, tuple(definitions)):
        return thunk()


def from_iterator(iterator):
    """The lazy list of what a Python iterator gives, its first element computed now; ``None`` when there is none."""
    step = iter(iterator).__next__

    def rest():
        try:
            return Cons(step(), tail(rest))
        except StopIteration:
            return None

    return rest()


# ------------------------------------------------------------------------------------------------------------- the operator


class _Leave(BaseException):
    """Unwinds from ``cont``, ``next`` or ``finish`` to the step of its `lazy_list`."""

    def __init__(self, token, kind, value, parameters):
        self.token, self.kind, self.value, self.parameters = token, kind, value, parameters


def lazy_list(initial, body, restarts=False):
    """``cut:lazy-list``: the list whose elements ``body(cont, next_, finish, *parameters)`` gives, called once per element.

    ``initial`` is a sequence with the parameters of the first call. In the body ``cont(value, *parameters)`` delivers an
    element and names the parameters for the next one, ``next_(*parameters)`` calls the body again at once,
    ``finish(value)`` delivers the last element; each leaves the body. What the body returns is the rest of the list.
    With ``restarts`` the three are restarts ``:cont``, ``:next`` and ``:finish`` too, as in the original, and ``:rest`` takes the rest.
    """

    def step(parameters):
        while True:
            token = object()

            def leave(kind):
                def leaving(value=None, *arguments):
                    raise _Leave(token, kind, value, arguments)

                return leaving

            def again(*arguments):
                raise _Leave(token, "next", None, arguments)

            try:
                if not restarts:
                    return one(body(leave("cont"), again, leave("finish"), *parameters))
                return restart_case(
                    [
                        (CONT, leave("cont"), None),
                        (NEXT, again, None),
                        (FINISH, leave("finish"), None),
                        (REST, lambda rest=None: rest, None),
                    ],
                    lambda: one(body(leave("cont"), again, leave("finish"), *parameters)),
                )
            except _Leave as left:
                if left.token is not token:
                    raise
                leaving = left
            if leaving.kind == "finish":
                return Cons(leaving.value, None)
            if leaving.kind == "cont":
                arguments = leaving.parameters
                return Cons(leaving.value, tail(lambda: step(arguments)))
            parameters = leaving.parameters
            kernel.checkpoint()

    return beginning(lambda: step(tuple(initial)))


# ---------------------------------------------------------------------------------------------------------------- functions


def _cons(thing):
    return thing if thing.__class__ is Cons else type_error(thing, "LIST")


def _count(thing):
    return thing if thing.__class__ is int else type_error(thing, "INTEGER")


def lazy_car(ll):
    """The first element; ``nil`` for ``nil``."""
    return None if ll is None else _cons(ll).car


def lazy_cdr(ll):
    """The rest, computed if need be; ``nil`` for ``nil``."""
    if ll is None:
        return None
    rest = _cons(ll).cdr
    if isinstance(rest, LazyTail):
        rest = ll.cdr = rest.force()
    return rest


def lazy_elt(ll, index):
    """Element ``index``, counted from 0; ``nil`` past the end."""
    for _ in range(_count(index)):
        kernel.checkpoint()
        ll = lazy_cdr(ll)
    return lazy_car(ll)


def force_ll(ll):
    """Compute the whole list; returns it, a proper list now."""
    cell = ll
    while True:
        for _ in STRETCH:
            if cell.__class__ is not Cons and not isinstance(cell, Cons):
                return ll
            rest = cell.cdr
            if rest.__class__ is not Cons and isinstance(rest, LazyTail):
                drained = rest.drain is not None and rest.worker is None  # then all of it comes at once
                rest = cell.cdr = rest.force(True)
                if drained:
                    return ll
            cell = rest
        kernel.checkpoint()


def lazy_list_p(lc):
    """True while ``lc`` is a cons list that still has an uncomputed tail."""
    if not isinstance(lc, Cons):
        return None
    while isinstance(lc, Cons):
        kernel.checkpoint()
        lc = lc.cdr
        if isinstance(lc, LazyTail) and lc.generator is None:
            lc = lc.value
    return True if isinstance(lc, LazyTail) else None


def elements(ll):
    """A Python iterator over the elements, forcing as it goes."""
    while isinstance(ll, Cons):
        kernel.checkpoint()
        yield ll.car
        ll = lazy_cdr(ll)


def _with_restarts(step):
    """``step``, a function that gives a list, with the restarts ``:rest``, which takes the list instead, and ``:finish``, its last element.

    The original's functions have them because they are written with `lazy_list`.
    """

    def offering(*arguments):
        return restart_case(
            [(FINISH, lambda *value: Cons(value[0], None) if value else None, None), (REST, lambda rest=None: rest, None)],
            lambda: step(*arguments),
        )

    return offering


def lazy_mapcar(fun, list_1, *more_lists):
    """Lazy ``mapcar``; ends with the shortest list. One call of ``fun`` per element, the first one now."""
    function = function_of(fun)

    @_with_restarts
    def step(lists):
        if any(ll is None for ll in lists):
            return None
        return Cons(one(function(*(lazy_car(ll) for ll in lists))), tail(lambda: step([lazy_cdr(ll) for ll in lists])))

    return beginning(lambda: step([list_1, *more_lists]))


def lazy_mapcan(fun, list_1, *more_lists):
    """The lazy concatenation of the lists that ``fun`` returns; empty ones are skipped."""
    function = function_of(fun)

    @_with_restarts
    def step(lists):
        while not any(ll is None for ll in lists):
            kernel.checkpoint()
            heads = [lazy_car(ll) for ll in lists]
            part = one(function(*heads))
            if part is not None and part is not False:
                if not isinstance(part, Cons):
                    return error("Applied fun ~a to ~a but result ~a is not a list~%", fun, heads[0], part)
                rest = lists
                return _followed_by(part, lambda: step([lazy_cdr(ll) for ll in rest]))
            lists = [lazy_cdr(ll) for ll in lists]
        return None

    return beginning(lambda: step([list_1, *more_lists]))


def _followed_by(part, generate_rest):
    """``part`` lazily copied, then what ``generate_rest`` returns."""

    def rest():
        more = lazy_cdr(part)
        return generate_rest() if more is None else _followed_by(more, generate_rest)

    return Cons(lazy_car(part), tail(rest))


def lazy_filter(pred, ll):
    """The elements for which ``pred`` is true; a true second value with it makes that element the last one."""
    function = function_of(pred)

    @_with_restarts
    def step(cell):
        while cell is not None:
            kernel.checkpoint()
            result = all_values(function(lazy_car(cell)))
            if result and truth(result[0]):
                if len(result) > 1 and truth(result[1]):
                    return Cons(cell.car, None)
                kept = cell
                return Cons(cell.car, tail(lambda: step(lazy_cdr(kept))))
            cell = lazy_cdr(cell)
        return None

    return beginning(lambda: step(ll))


def lazy_fold(fun, sequence, *, initial_value=UNSUPPLIED):
    """Left fold over the whole list; without ``initial_value`` it starts with the first element."""
    function, result, cell = function_of(fun), initial_value, sequence
    if result is UNSUPPLIED:
        result, cell = lazy_car(cell), lazy_cdr(cell)
    for element in elements(cell):
        result = one(function(result, element))
    return result


def lazy_append(l_1=None, *further_lists):
    """The lazy concatenation of lists; empty ones are skipped."""
    lists = [l_1, *further_lists]
    while lists and lists[0] is None:
        lists = lists[1:]
    if not lists:
        return None
    return _followed_by(lists[0], lambda: lazy_append(*lists[1:]))


def lazy_take(n, ll):
    """The first ``n`` elements, lazily; the source is computed only as far as it is read."""
    if _count(n) <= 0 or ll is None:
        return None
    return Cons(lazy_car(ll), tail(lambda: lazy_take(n - 1, lazy_cdr(ll) if n > 1 else None)))


def lazy_skip(n, ll):
    """The list without its first ``n`` elements. (The original drops one element whatever ``n`` is.)"""
    for _ in range(_count(n)):
        kernel.checkpoint()
        ll = lazy_cdr(ll)
    return ll


def lazy_flatten(list_):
    """The atoms of a nested list, lazily, without ``nil``."""

    def step(stack):
        while stack is not None:
            kernel.checkpoint()
            cell, outer = stack
            if cell is None:
                stack = outer
                continue
            if isinstance(cell.car, Cons):
                stack = (cell.car, (lazy_cdr(cell), outer))
            elif cell.car is None:
                stack = (lazy_cdr(cell), outer)
            else:
                return Cons(cell.car, tail(lambda: step((lazy_cdr(cell), outer))))
        return None

    return step((None if list_ is None else _cons(list_), None))


def lazy_rests(list_):
    """All tails of a list, the list itself first."""
    return None if list_ is None else Cons(list_, tail(lambda: lazy_rests(lazy_cdr(list_))))


def lazy_dolist(list_, function):
    """Call ``function`` with each element in turn: the work of the macro ``lazy-dolist``."""
    for element in elements(list_):
        function(element)


def copy_lazy_list(src):
    """A copy of the computed part that shares the tail."""
    cars, src = list_parts(src)
    for car in reversed(cars):
        src = Cons(car, src)
    return src


# ----------------------------------------------------------------------------------------------------------------- promises


class Promise(Once):
    """What ``(delay expr)`` returns."""

    __slots__ = ()

    def __repr__(self):
        return "#<PROMISE>"


def delay(thunk):
    """A promise of what ``thunk`` returns: the work of the macro ``delay``."""
    return Promise(thunk)


def delay_p(obj):
    return True if isinstance(obj, Promise) else None


def force(obj):
    """The value of a promise; any other object is returned as it is."""
    return obj.force() if isinstance(obj, Promise) else obj


# ----------------------------------------------------------------------------------------------------------------- printing


_ELEMENT = sym("CUT::LAZY-CONS-ELEM")
_GENERATOR_NAME = lisp_list(sym("LAMBDA"), None, keyword("IN"), sym("CUT::LAZY-MAPCAR"))


class _ShownGenerator:
    """A generator as the original shows it: the closure of the function that makes most of its lazy lists."""

    def __init__(self, generator):
        self.generator = generator


def _print_tail(tail_, stream):
    if tail_.generator is None:
        write(tail_.value, stream)
    else:
        print_slots(_ELEMENT, [("GENERATOR", _ShownGenerator(tail_.generator))], stream)


def _print_generator(shown, stream):
    def body():
        stream.write("FUNCTION ")
        output_object(_GENERATOR_NAME, stream)
        stream.write(f" {{{address(shown.generator)}}}")

    print_unreadable(shown, stream, body=body)


define_printer(LazyTail, _print_tail)
define_printer(_ShownGenerator, _print_generator)
