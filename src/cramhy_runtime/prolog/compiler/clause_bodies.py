"""Code for the goals of a clause.

Goals that are tests (unification, comparison, ``lisp-fun``, ``bound``, ...) become code in place. A call ends the Python function: the
goals after it are a function of their own, the continuation, which gets the variables that it needs through its step. The constructs
of control are compiled in place too: a condition made of tests is an ``if``; otherwise the branches not taken yet are functions of
choice points. A goal is built as a term only if the clause does not say which goal it is.

The rules of cut are those of ``builtins/control.py``, which interprets the goals that are data: a `Context` knows where a cut cuts to.
"""

from __future__ import annotations

from collections import namedtuple
from functools import partial

from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable

from ..builtins import control
from ..engine.database import arguments_of, find_predicate, in_place, looked_up, valid_functor
from ..engine.machine import FAIL
from .generated_code import is_ground, proper, variables
from .variants import variant_of_call
from ..symbols import sym

AND, OR, NOT, IF, SOFT_IF = sym("AND"), sym("OR"), sym("NOT"), sym("CRAM-PROLOG::->"), sym("CRAM-PROLOG::*->")
CUT, TRUE, FALSE, ONCE, CALL, FORALL = (sym(f"CRAM-PROLOG::{name}") for name in "CUT TRUE FAIL ONCE CALL FORALL".split())
UNIFIES, LISP_FUN, LISP_PRED, BOUND, GROUND, FILTER = (
    sym(f"CRAM-PROLOG::{name}") for name in "== LISP-FUN LISP-PRED BOUND GROUND FILTER-BINDINGS".split()
)
EQUAL = sym("EQUAL")
COLLECTIONS = {sym("CRAM-PROLOG::FINDALL"): "findall", sym("CRAM-PROLOG::BAGOF"): "bagof", sym("CRAM-PROLOG::SETOF"): "setof"}
COMPARISONS = frozenset(sym(name) for name in ("<", ">", "<=", ">="))

TESTS = {
    TRUE: (0, 0),
    FALSE: (0, 0),
    UNIFIES: (2, 2),
    EQUAL: (2, 2),
    BOUND: (1, 1),
    GROUND: (1, 1),
    LISP_FUN: (1, None),
    LISP_PRED: (1, None),
    **{name: (2, 2) for name in COMPARISONS},
}
"""Goals that are code in place, with the least and most number of their arguments."""
CONSTRUCTS = {
    AND: (0, None),
    OR: (0, None),
    NOT: (1, 1),
    IF: (2, 3),
    SOFT_IF: (2, 3),
    ONCE: (0, None),
    CALL: (1, 1),
    FORALL: (2, 2),
    CUT: (0, 0),
    **{name: (3, 3) for name in COLLECTIONS},
}

in_place.update([*TESTS, *CONSTRUCTS])


class Context(namedtuple("Context", "k b repeat", defaults=("k", "b", None))):
    """Where goals stand: ``k`` and ``b`` are Python expressions for their continuation and for the barrier of a cut.

    ``repeat`` is the statement with which the predicate calls itself as the last goal, or ``None`` if it must return to do so.
    """

    __slots__ = ()


def known_goal(goal, table):
    """The arguments of ``goal`` if it is one of the functors in ``table`` with a fitting number of arguments, else ``None``."""
    if not isinstance(goal, Cons) or goal.car not in table or not proper(goal) or looked_up(goal.car):
        return None
    least, most = table[goal.car]
    arguments = arguments_of(goal)
    return arguments if least <= len(arguments) and (most is None or len(arguments) <= most) else None


def is_test(goal):
    """Whether a goal is code in place, without a call or a choice point."""
    arguments = known_goal(goal, TESTS)
    if arguments is not None:
        return goal.car is not LISP_PRED or not variable(arguments[0])
    arguments = known_goal(goal, CONSTRUCTS)
    return arguments is not None and goal.car in (AND, NOT, ONCE) and all(map(is_test, arguments))


def is_plain_test(goal):
    """Whether a goal is a test that calls no Lisp and signals no error of its own."""
    return is_test(goal) and goal.car in (TRUE, FALSE, UNIFIES, BOUND, GROUND)


def flat(goals):
    """The goals of a body, with conjunctions in it flattened."""
    for goal in goals or ():
        if isinstance(goal, Cons) and goal.car is AND and proper(goal) and not looked_up(AND):
            yield from flat(goal.cdr)
        else:
            yield goal


def direct(goal):
    """Whether a goal is a call of a predicate that is known now, with a known number of arguments."""
    return isinstance(goal, Cons) and valid_functor(goal.car) and goal.car not in control.CONTROL and proper(goal)


def may_cut(goal):
    """Whether a cut in ``goal`` can reach the enclosing clause."""
    if direct(goal):
        return False
    arguments = known_goal(goal, CONSTRUCTS)
    if arguments is None:
        return known_goal(goal, TESTS) is None
    if goal.car in (IF, SOFT_IF):
        arguments = arguments[1:]
    return goal.car is CUT or (goal.car in (AND, IF, SOFT_IF) and any(map(may_cut, arguments)))


class Bodies:
    """Writes code for bodies of clauses into ``out``, a `Source`. terms: what writes their terms. predicate: whose clauses they are.

    ``keep_variables`` says that every variable must be a `Var`, since goals of the clause change variables that are set.
    """

    keep_variables = False
    enumerating = False  # whether a generator is written, which yields at a solution

    def __init__(self, out, terms, predicate):
        self.out, self.terms, self.predicate = out, terms, predicate

    def body(self, goals, names, context):
        """Emit code for ``goals``, a list. The code leaves the function, or repeats the predicate."""
        goals = list(flat(goals))
        while goals:
            goal, goals = goals[0], goals[1:]
            arguments = known_goal(goal, CONSTRUCTS)
            if goal.__class__ is Cons and goal.car is CUT and arguments is not None:
                self.out.emit(f"del m.choices[{context.b}:]")
            elif is_test(goal):
                self.test(goal, names)
                if goal.car is FALSE:
                    return
            elif goal.__class__ is Cons and goal.car is CALL and arguments is not None and direct(arguments[0]):
                goals.insert(0, arguments[0])
            elif arguments is not None:
                _WRITERS[goal.car](self, arguments, goals, names, context)
                return
            else:
                self._call(goal, goals, names, context)
                return
        if self.enumerating:
            self.out.emit("m.choices.pop()")
            self.out.emit("yield")
            self.out.emit("return")
        else:
            self.out.emit(f"return {context.k}")

    # ------------------------------------------------------------------------------------------------------------------ tests

    def test(self, goal, names):
        """Emit code in place for a goal that `is_test`."""
        functor, arguments = goal.car, arguments_of(goal)
        if functor is TRUE:
            return
        if functor is FALSE:
            self.out.emit(self.out.failing)
        elif functor in (AND, ONCE):
            for part in arguments:
                self.test(part, names)
        elif functor is NOT:
            self._not_test(arguments[0], names)
        elif functor in (UNIFIES, EQUAL):
            self._unify(*arguments, names)
        elif functor in COMPARISONS:
            left, right = (self._argument(argument, names) for argument in arguments)
            self._compare(functor, left, right)
        elif functor is LISP_FUN:
            function = self._argument(arguments[0], names)
            given = "".join(self._argument(argument, names) + ", " for argument in arguments[1:-1])
            result = arguments[-1] if len(arguments) > 1 else None
            if variable(result) and result is not ANONYMOUS and result not in names and not self.keep_variables:
                name = names[result] = self.out.fresh("v")
                self.out.emit(f"{name} = lisp_value(m, {function}, ({given}))")
                self.out.emit(f"if {name} is NotImplemented: {self.out.failing}")
            else:
                self.terms.fail_unless(f"lisp_fun(m, {function}, ({given}), {self.terms.build(result, names)})")
        elif functor is LISP_PRED:
            given = "".join(self._argument(argument, names) + ", " for argument in arguments[1:])
            self.terms.fail_unless(f"lisp_pred(m, {self.out.constant(arguments[0])}, ({given}))")
        elif functor is BOUND:
            self.terms.fail_unless(f"deref({self.terms.build(arguments[0], names)}).__class__ is not Var")
        else:
            self.terms.fail_unless(f"ground({self.terms.build(arguments[0], names)})")

    def _compare(self, functor, left, right):
        x, y = self.out.fresh("x"), self.out.fresh("y")
        self.out.emit(f"{x} = {left}; {y} = {right}")
        self.out.emit(f"if {x}.__class__ is int and {y}.__class__ is int:")
        self.out.emit(f"    if not {x} {functor.name} {y}: {self.out.failing}")
        self.out.emit(f"elif not compare(m, {self.out.constant(functor)}, {x}, {y}): {self.out.failing}")

    def _unify(self, left, right, names):
        for side, other in ((left, right), (right, left)):
            if variable(side) and side is not ANONYMOUS and side not in names and not self.keep_variables and side not in variables(other):
                names[side] = self.out.fresh("v")
                self.out.emit(f"{names[side]} = {self.terms.build(other, names)}")
                return
        self.terms.fail_unless(f"unify({self.terms.build(left, names)}, {self.terms.build(right, names)}, trail)")

    def _not_test(self, goal, names):
        height = self.out.fresh("t")
        names = dict(names)
        if not is_ground(goal):
            self.out.emit(f"{height} = len(trail)")
        self._tests([goal], names)
        self.out.emit("else:")
        self.out.depth += 1
        if not is_ground(goal):
            self.out.emit(f"undo(trail, {height})")
        self.out.emit(self.out.failing)
        self.out.depth -= 1
        if not is_ground(goal):
            self.out.emit(f"undo(trail, {height})")

    def _tests(self, goals, names):
        """Emit a loop of one turn around tests. It breaks when a test fails, and an ``else`` may follow it."""
        self.out.emit("for _ in ONCE:")
        self.out.depth += 1
        outer, self.out.failing = self.out.failing, "break"
        count = len(self.out.lines)
        for goal in goals:
            self.test(goal, names)
        if len(self.out.lines) == count:
            self.out.emit("pass")
        self.out.failing = outer
        self.out.depth -= 1

    def _argument(self, pattern, names):
        """An expression for the argument of a Lisp function for ``pattern``: a variable's value; lists as they are written."""
        if variable(pattern):
            return f"resolve_argument(m, {self.terms.build(pattern, names)})"
        if not isinstance(pattern, Cons) or is_ground(pattern):
            return self.out.constant(pattern)
        return f"raw_argument(m, {self._as_written(pattern, names)})"

    def _as_written(self, pattern, names):
        """An expression for a list in which the variables are variables, even where their values are known."""
        self.terms.first_occurrences(pattern, names)
        boxes = {}
        for name in variables(pattern):
            boxes[name] = self.out.fresh("v")
            self.out.emit(f"{boxes[name]} = as_variable({names[name]})")
        return self.terms.build(pattern, boxes)

    # ------------------------------------------------------------------------------------------------------------------ calls

    def _call(self, goal, goals, names, context):
        functor = goal.car if isinstance(goal, Cons) else None
        if direct(goal):
            if not self.keep_variables:
                variant, arguments = variant_of_call(goal, names, variables(list_from(goals)))
                if variant is not None:
                    given = [self.terms.build(argument, names) for argument in arguments]
                    rest = self.continuation(goals, names, context)
                    self.out.emit(f"return {self.out.constant(variant)}.call, {rest}{''.join(', ' + item for item in given)}")
                    return
            build = self._as_written if functor in (LISP_FUN, LISP_PRED) else self.terms.build
            given = [build(argument, names) for argument in goal.cdr or ()]
            predicate = self.predicate
            if not goals and context.repeat and functor is predicate.functor and len(given) == predicate.arity:
                self.out.assign_arguments(given)
                self.out.emit(context.repeat)
                return
            callee = self.out.constant(self.predicate_of(functor, len(given)))
            rest = self.continuation(goals, names, context)
            self.out.emit(f"return {callee}.call, {rest}{''.join(', ' + item for item in given)}")
            return
        term = self.terms.build(goal, names)
        rest = self.continuation(goals, names, context)
        if functor in control.CONTROL:
            barrier = context.b if may_cut(goal) else 0
            self.out.emit(f"return {self.out.constant(control.in_clause(functor))}(m, ({term}).cdr, {rest}, {barrier})")
        else:
            self.out.emit(f"return {self.out.constant(control.solve)}(m, {term}, {rest}, {context.b})")

    def predicate_of(self, functor, arity):
        """The `Predicate` for a call. The code that is being written may be that of a variant, which calls itself."""
        own = self.predicate
        return own if own is not None and own.functor is functor and own.arity == arity else find_predicate(functor, arity)

    def continuation(self, goals, names, context):
        """An expression for the continuation that proves ``goals``; its function is written beside this one."""
        if not goals:
            return context.k
        return self.branch("then_", goals, names, context._replace(repeat=None), context.k)

    def branch(self, kind, goals, names, context, k, held=(), opening=()):
        """An expression for a step whose function proves ``goals`` in ``context``.

        ``held`` maps further Python names in the function to expressions for their values. ``opening`` are lines at its beginning.
        """
        needed = {}
        for goal in goals:
            variables(goal, needed)
        live = [name for name in needed if name in names]
        held = dict(held)
        if any(map(may_cut, goals)):
            held["b"] = context.b
        function = self.out.fresh(kind)

        def body():
            self.out.emit(f"{', '.join(['_', 'k', *held, *(f'w{i}' for i in range(len(live)))])} = step")
            for line in opening:
                self.out.emit(line)
            self.out.emit("trail = m.trail")
            outer, self.out.failing = self.out.failing, "return fail(m)"
            self.body(goals, {name: f"w{i}" for i, name in enumerate(live)}, context._replace(k="k", b="b"))
            self.out.failing = outer

        self.out.define(function, "m, step", body)
        return f"({', '.join([function, k, *held.values(), *(names[name] for name in live)])})"

    # ------------------------------------------------------------------------------------------------- constructs of control

    def _shared(self, parts, goals, names):
        """Emit code for new variables that occur in more than one of ``parts`` and the ``goals`` after them."""
        seen = variables(list_from(goals))
        for part in parts:
            inside = variables(part)
            self.terms.first_occurrences(list_from([name for name in inside if name in seen]), names)
            seen = {**seen, **inside}

    def _rest(self, goals, names, context):
        """A Python variable with the continuation after a construct."""
        if not goals:
            return context.k
        k = self.out.fresh("k")
        self.out.emit(f"{k} = {self.continuation(goals, names, context)}")
        return k

    def _height(self):
        height = self.out.fresh("h")
        self.out.emit(f"{height} = len(m.choices)")
        return height

    def _or(self, branches, goals, names, context):
        self._shared(branches, goals, names)
        k = self._rest(goals, names, context)
        if not branches:
            self.out.emit(self.out.failing)
            return
        local = self._height()
        if len(branches) > 1:
            self.out.emit(f"m.choices.append({self._other_branches(branches[1:], names, k)})")
        self.body(branches[:1], dict(names), Context(k, local, context.repeat if k == context.k else None))

    def _other_branches(self, branches, names, k):
        """An expression for the choice point of the later branches of an ``or``, which share their variables."""
        live = [name for name in variables(list_from(branches)) if name in names]
        function = self.out.fresh("or_")

        def body():
            self.out.emit(f"{', '.join(['_', 'k', 'height', *(f'w{i}' for i in range(len(live)))])} = step")
            self.out.emit("trail = m.trail")
            here = {name: f"w{i}" for i, name in enumerate(live)}
            self.out.emit("m.choices.pop()")
            self.out.emit("b = len(m.choices)")
            if len(branches) > 1:
                self.out.emit(f"m.choices.append({self._other_branches(branches[1:], here, 'k')})")
            outer, self.out.failing = self.out.failing, "return fail(m)"
            self.body(branches[:1], here, Context())
            self.out.failing = outer

        self.out.define(function, "m, step", body)
        return f"({', '.join([function, k, 'len(trail)', *(names[name] for name in live)])})"

    def _if(self, arguments, goals, names, context, soft=False):
        condition, then, otherwise = arguments if len(arguments) == 3 else [*arguments, list_from([FALSE])]
        self._shared([condition, then, otherwise], goals, names)
        k = self._rest(goals, names, context)
        inner = Context(k, context.b, context.repeat if k == context.k else None)
        if is_test(condition):
            height = self.out.fresh("t")
            self.out.emit(f"{height} = len(trail)")
            inside = dict(names)
            self._tests([condition], inside)
            self.out.emit("else:")
            self.out.depth += 1
            self.body([then], inside, inner)
            self.out.depth -= 1
            self.out.emit(f"undo(trail, {height})")
            self.body([otherwise], dict(names), inner)
            return
        self.terms.first_occurrences(list_from([name for name in variables(condition) if name in variables(then)]), names)
        h = self._height()
        alone = inner._replace(repeat=None)
        self.out.emit(f"m.choices.append({self.branch('else_', [otherwise], names, alone, k, {'_': 'len(trail)'}, ['m.choices.pop()'])})")
        inside = self.out.fresh("k")
        opening = ["settle(m, h)" if soft else "del m.choices[h:]"]
        self.out.emit(f"{inside} = {self.branch('then_', [then], names, alone, k, {'h': h}, opening)}")
        self.body([condition], names, Context(inside, f"{h} + 1"))

    def _soft_if(self, arguments, goals, names, context):
        if is_test(arguments[0]):
            self._if(arguments, goals, names, context)
        else:
            self._if(arguments, goals, names, context, soft=True)

    def _not(self, arguments, goals, names, context):
        self._shared(arguments, goals, names)
        k = self._rest(goals, names, context)
        h = self._height()
        self.out.emit(f"m.choices.append((proceed, {k}, len(trail)))")
        self.body(arguments, dict(names), Context(f"({self.out.constant(control.refute)}, {k}, {h})", f"{h} + 1"))

    def _forall(self, arguments, goals, names, context):
        condition, action = arguments
        unmet = [AND, list_from([CALL, condition]), list_from([NOT, action])]
        goal = list_from([NOT, list_from(unmet)])
        if known_goal(goal, CONSTRUCTS) is None:  # NOT is traced: a call, which wants a barrier that this clause may not have
            k = self._rest(goals, names, context)
            self.body([goal], names, Context(k, self._height()))
        else:
            self.body([goal, *goals], names, context)

    def _once(self, arguments, goals, names, context):
        self._shared(arguments, goals, names)
        k = self._rest(goals, names, context)
        h = self._height()
        self.body(arguments, names, Context(f"({self.out.constant(control.commit)}, {k}, {h})", h))

    def _call_construct(self, arguments, goals, names, context):
        goal = arguments[0]
        if known_goal(goal, CONSTRUCTS) is None:
            self._call(list_from([CALL, goal]), goals, names, context)
            return
        self._shared(arguments, goals, names)
        k = self._rest(goals, names, context)
        self.body([goal], names, Context(k, self._height()))

    # -------------------------------------------------------------------------------------------------------------- collections

    def _collect(self, arguments, goals, names, context, kind):
        """``findall``, ``bagof`` or ``setof``: the goal becomes a function, which a machine of its own proves."""
        template, goal, result = arguments
        self.terms.first_occurrences(list_from([template, goal]), names)  # what a solution leaves unset is the same in all instances
        live = list(variables(list_from([template, goal])))
        function = self.out.fresh("all_")

        def body():
            self.out.emit(f"{', '.join(['_', 'k', 'template', *(f'w{i}' for i in range(len(live)))])} = step")
            self.out.emit("trail = m.trail")
            self.out.emit("b = 0")
            inner = [goal]
            here = {name: f"w{i}" for i, name in enumerate(live)}
            if template not in live:
                here[_TEMPLATE] = "template"
                inner.append(list_from([UNIFIES, _TEMPLATE, template]))
            outer, self.out.failing = self.out.failing, "return fail(m)"
            self.body(inner, here, Context())
            self.out.failing = outer

        self.out.define(function, "m, step", body)
        found = self.out.fresh("f")
        held = "".join(names[name] + ", " for name in live)
        self.out.emit(
            f"{found} = {self.out.constant(getattr(control, kind))}(m, {function}, ({held}), "
            f"{live.index(template) if template in live else None})"
        )
        if kind != "findall":
            self.out.emit(f"if {found} is None: {self.out.failing}")
        if variable(result) and result is not ANONYMOUS and result not in names and not self.keep_variables:
            names[result] = found
        else:
            self.terms.fail_unless(f"unify({self.terms.build(result, names)}, {found}, trail)")
        self.body(goals, names, context)


_TEMPLATE = sym("CRAM-PROLOG::?WHOLE-TEMPLATE")
_WRITERS = {
    OR: Bodies._or,
    IF: Bodies._if,
    SOFT_IF: Bodies._soft_if,
    NOT: Bodies._not,
    FORALL: Bodies._forall,
    ONCE: Bodies._once,
    CALL: Bodies._call_construct,
    **{name: partial(Bodies._collect, kind=kind) for name, kind in COLLECTIONS.items()},
}

__all__ = ["FAIL", "Bodies", "Context", "direct", "flat", "is_test", "may_cut"]
