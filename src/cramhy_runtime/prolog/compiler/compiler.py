"""The clause compiler: the clauses of a predicate become one Python function.

The compiler writes Python source for each predicate. The code looks at the first argument that distinguishes the clauses, and goes to
those that can match; if that argument is unset, it looks at the next such argument. It tries a clause together with the tests at the
beginning of its body. It makes a choice point only if these succeed and other clauses could match too, so a call that only one clause
answers leaves none. A clause that ends by calling its own predicate becomes a loop. If there is nothing but tests beside that call, as in a
``member``, the alternatives of a choice point come from a generator: it stands in the middle of the loop and only has to go on.

If the clauses are too many or too long for that function, they are functions of their own, in tables of candidates. Ground facts without
bodies are tables altogether, see ``engine/relations.py``. ``head_matching.py`` and ``clause_bodies.py`` compile the parts of a clause.

Source text, with the clauses inside the function of their predicate, is fast: naive reverse runs at 2.1 M inferences a second. With one
more Python call per clause, which closures would need at least, it runs at 1.2 M.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.utilities.patterns import variable

from ..engine import database
from .clause_bodies import (
    CALL,
    CONSTRUCTS,
    CUT,
    FILTER,
    IF,
    OR,
    SOFT_IF,
    Bodies,
    Context,
    direct,
    flat,
    is_plain_test,
    is_test,
    known_goal,
    may_cut,
)
from .list_building import FILL, Holes, can_wait, hole_positions
from ..engine.machine import again, fail
from .head_matching import A_LIST, SAME, UNBOUND, Matching
from ..engine.list_shapes import index_key
from ..engine.relations import relation_of, relation_of_rows
from ..engine.services import SERVICES
from .generated_code import Rest, Source, is_ground
from .variants import Variant

LOOP = range(100)
_HEAVY = 90
"""Clauses with at most so many conses are written out in each place where they may be tried."""

_ANY, _LIST, _OTHER = object(), object(), object()
"""The kinds of arguments that a clause can match, if they are not keys of the index: anything, lists, other atoms."""


def compile_clauses(predicate, clauses):
    """The call function of ``predicate`` for ``clauses``, a list of `Clause`, and its `Relation` if the clauses are rows of one."""
    arity, fitting = predicate.arity, []
    relation = relation_of(clauses, arity)
    if relation is not None:
        return relation.call_function(), relation
    for clause in clauses:
        arguments = _head_arguments(clause.head, arity)
        if arguments is not None:
            fitting.append((arguments, clause))
    if not fitting:
        return lambda m, step: fail(m), None
    if all(clause.goals is None and is_ground(arguments) for arguments, clause in fitting):
        relation = relation_of_rows([arguments for arguments, _ in fitting])
        return relation.call_function(), relation
    return PredicateCode(predicate, fitting).function(), None


SERVICES.install(compile_clauses=compile_clauses)


def clause_functions(predicate, clauses):
    """Pairs (clause, function), for callers that choose among the clauses. They call ``function(m, k, barrier, *arguments)``."""
    fitting = [(arguments, clause) for clause in clauses if (arguments := _head_arguments(clause.head, predicate.arity)) is not None]
    return PredicateCode(predicate, fitting).each() if fitting else []


def _head_arguments(head, arity):
    """The argument patterns of ``head`` for goals of ``arity`` arguments, or ``None`` if it cannot match such a goal."""
    arguments, cell = [], head.cdr
    while isinstance(cell, Cons) and len(arguments) <= arity:
        arguments.append(cell.car)
        cell = cell.cdr
    if cell is None:
        return arguments if len(arguments) == arity else None
    if len(arguments) > arity or isinstance(cell, Cons) or not variable(cell):
        return None
    return [*arguments, Rest(cell, arity - len(arguments))]


def _mentions(item, functor):
    stack = list(item or ())
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            stack.append(item.cdr)
            item = item.car
        if item is functor:
            return True
    return False


def _weight(item):
    """The number of conses in Lisp data or a list of it."""
    count, stack = 0, list(item or ())
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            count += 1
            stack.append(item.cdr)
            item = item.car
    return count


class PredicateCode:
    """The code of one predicate while it is written. ``fitting`` are pairs (argument patterns, clause)."""

    waiting = False  # whether the clause to come may find a hole
    leaving = "return fail(m)"

    def __init__(self, predicate, fitting):
        self.out = Source(f"clauses of {predicate.functor!r}/{predicate.arity}")
        self.terms = Matching(self.out)
        self.bodies = Bodies(self.out, self.terms, predicate)
        self.predicate, self.fitting = predicate, fitting
        self.arity = predicate.arity
        self.goals = [list(flat(clause.goals)) for _, clause in fitting]
        self.weights = [_weight([clause.head, *(clause.goals or ())]) for _, clause in fitting]
        self.arguments = "".join(f", a{i}" for i in range(self.arity))
        self.looping = predicate.functor not in database.traced and any(map(self._repeats, self.goals))
        positions = [hole_positions(predicate.functor, patterns, goals) for (patterns, _), goals in zip(fitting, self.goals)]
        telling = self._telling(range(len(fitting)), {})
        self.hole = next((i for i in sum(positions, []) if i != telling), None) if self.looping else None
        self.builders = {n for n, found in enumerate(positions) if self.hole in found}
        self.out.space.update(LOOP=LOOP, P=predicate, try_clauses=try_clauses, again=again)
        self.tries, self.buckets, self.clause_names = {}, {}, {}

    def function(self):
        """Write and compile all code. Returns the call function."""

        def body():
            self.out.emit(f"_, k{self.arguments} = step")
            self.out.emit("trail = m.trail")
            if self.looping:
                self._loop(lambda: self._dispatch(list(range(len(self.fitting))), {}))
            else:
                self._dispatch(list(range(len(self.fitting))), {})

        self.out.define("predicate", "m, step", body)
        self.out.make()
        space = self.out.space

        def functions(numbers):
            return tuple([space[self.clause_names[n]] for n in numbers])

        for name, content in self.buckets.values():
            if isinstance(content, dict):
                space[name] = {key: functions(numbers) for key, numbers in content.items()}
            else:
                space[name] = functions(content)
        return space["predicate"]

    def each(self):
        """Write and compile a function for each clause. Returns (clause, function) pairs."""
        for n in range(len(self.fitting)):
            self._clause_function(n)
        self.out.make()
        return [(clause, self.out.space[self.clause_names[n]]) for n, (_, clause) in enumerate(self.fitting)]

    def _loop(self, body):
        if self.hole is not None:
            self.out.emit("hole = None")
            self.out.emit("while True:")
            self.out.depth += 1
        self.out.emit("for _ in LOOP:")
        self.out.depth += 1
        body()
        self.out.depth -= 1
        self.out.emit(f"budget.left -= {len(LOOP)}")  # the machine's next checkpoint knows what was done here
        self.out.emit("if not m.choices: trail.clear()")
        if self.hole is not None:
            self.out.emit("if hole is None or P.call is not predicate: break")  # a list that is being built stays in one piece
            self.out.emit("m.rest()")
            self.out.depth -= 1
            self.out.emit(FILL.format(self.hole))
        self.out.emit(f"return P.call, k{self.arguments}")

    def _repeats(self, goals):
        """Whether a body may end by calling its own predicate in this function."""
        if not goals:
            return False
        goal = goals[-1]
        if direct(goal):
            return goal.car is self.predicate.functor and len(goal.cdr or ()) == self.arity
        arguments = known_goal(goal, CONSTRUCTS)
        return (
            arguments is not None and goal.car in (IF, SOFT_IF, OR, CALL) and any(self._repeats(list(flat([part]))) for part in arguments)
        )

    # ------------------------------------------------------------------------------------------------- choosing the clauses

    def _kind(self, n, position):
        """The kind of values that clause ``n`` can match at an argument."""
        patterns = self.fitting[n][0]
        if position >= len(patterns):
            return _ANY
        pattern = patterns[position]
        if isinstance(pattern, Rest) or variable(pattern):
            return _ANY
        if isinstance(pattern, Cons):
            return _LIST
        key = index_key(pattern)
        return _OTHER if key is NotImplemented else key

    def _telling(self, numbers, known):
        """The first argument that distinguishes the clauses and is not ``known`` yet."""
        for position in range(self.arity):
            if position not in known and any(self._kind(n, position) is not _ANY for n in numbers):
                return position
        return None

    def _unbound(self, numbers, known):
        """Emit code for calls in which the argument that tells most is not known. A variant is not made for them."""
        if not isinstance(self.predicate, Variant):
            self._dispatch(numbers, known)
        elif self.bodies.enumerating:
            self.out.emit(self._going_on())
        else:
            self.out.emit(f"return P.call_general(m, (None, k{self.arguments}))")

    def _going_on(self):
        """The statements with which a generator lets the predicate go on."""
        return f"yield ({self.arguments[2:]}{',' if self.arity == 1 else ''}); return"

    def _call_again(self):
        self.out.emit("continue" if self.bodies.enumerating else f"return P.call, k{self.arguments}")

    def _discriminates(self, position):
        """Whether some clauses can match values of an argument that others cannot."""
        return any(self._kind(n, position) is not self._kind(0, position) for n in range(len(self.fitting)))

    def _dispatch(self, numbers, known):
        position = self._telling(numbers, known)
        if position is None:
            self._candidates(numbers, known)
            return
        a, c = f"a{position}", f"c{position}"
        self.out.emit(f"{c} = {a}.__class__")
        self.out.emit(f"if {c} is Var:")
        self.out.depth += 1
        self.terms.follow(a)
        self.out.emit(f"{c} = {a}.__class__")
        self.out.depth -= 1
        kinds = {n: self._kind(n, position) for n in numbers}

        def fit(*wanted):
            return [n for n in numbers if kinds[n] is _ANY or any(kinds[n] is kind or kinds[n] == kind for kind in wanted)]

        outermost = not known
        telling = position if outermost else None
        self._case(f"if {c} is Cons:", lambda: self._candidates(fit(_LIST), {**known, position: A_LIST}, telling))
        self._case(f"elif {c} is Var:", lambda: (self._fill(outermost), self._unbound(numbers, {**known, position: UNBOUND})))
        keys = {kinds[n]: self.fitting[n][0][position] for n in numbers if kinds[n] not in (_ANY, _LIST, _OTHER)}
        if len(keys) <= 4:
            for key, value in list(keys.items()):
                chosen = fit(_OTHER, key)
                test = (
                    f"{a} is {self.out.constant(value)}"
                    if isinstance(value, Symbol) or value is None or value is True
                    else f"{c} is int and {a} == {self.out.constant(value)}"
                    if value.__class__ is int
                    else None
                )
                if test and self._light(chosen):
                    self._case(f"elif {test}:", lambda: self._candidates(chosen, {**known, position: SAME}, telling))
                    del keys[key]
        self._case(
            f"elif {c} is LazyTail or {c} is TermTail:",
            lambda: (self._fill(outermost), self.out.emit(f"{a} = {a}.force()"), self._call_again()),
        )
        self.out.emit("else:")
        self.out.depth += 1
        self._fill(outermost)
        if keys:
            index = self._bucket({key: fit(_OTHER, key) for key in keys})
            others = self._bucket(fit(_OTHER))
            self.out.emit(f"found = {index}.get({a} if {c} is Symbol else index_key({a}), {others})")
            self.out.emit(f"return try_clauses(m, k, found{self.arguments})")
        else:
            self._candidates(fit(_OTHER), {**known, position: None})
        self.out.depth -= 1

    def _case(self, test, body):
        self.out.emit(test)
        self.out.depth += 1
        body()
        self.out.depth -= 1

    def _light(self, numbers):
        return len(self.fitting) == 1 or sum(self.weights[n] for n in numbers) <= _HEAVY

    def _fill(self, outermost):
        if outermost and self.hole is not None:
            self.out.emit(FILL.format(self.hole))

    def _candidates(self, numbers, known, telling=None):
        """Emit code that tries the clauses ``numbers``. ``telling`` is the argument that chose them, if there may be a hole."""
        if telling is not None and self.hole is not None:
            if len(numbers) == 1 and numbers[0] in self.builders and known[telling] is A_LIST:
                self._owned(numbers[0], lambda: self._turn_with_hole(numbers[0], telling))
                return
            if len(numbers) == 1 and can_wait(self.fitting[numbers[0]][0], self.hole) and self._light(numbers):
                self.waiting = True
            elif numbers:
                self._fill(True)
        if not numbers:
            self.out.emit(self.leaving)
        elif self._light(numbers) and not any(kind is UNBOUND and self._discriminates(position) for position, kind in known.items()):
            self._chain(numbers, known, "continue" if self.looping else None)
        else:
            self.out.emit(f"return try_clauses(m, k, {self._bucket(numbers)}{self.arguments})")

    def _turn_with_hole(self, n, telling):
        Holes(self.out, self.terms, self.bodies).turn(self.fitting[n][0], self.goals[n][0], self.hole, telling)

    def _bucket(self, content):
        """The name of a tuple of clause functions, or of a dict of such tuples. ``content`` has the numbers of the clauses."""
        found = self.buckets.get(repr(content))
        if found is None:
            found = self.buckets[repr(content)] = f"B{len(self.buckets)}", content
            for numbers in content.values() if isinstance(content, dict) else [content]:
                for n in numbers:
                    self._clause_function(n)
        return found[0]

    # ------------------------------------------------------------------------------------------------------ trying clauses

    def _clause_function(self, n):
        if n in self.clause_names:
            return
        self.clause_names[n] = f"clause_{n}"
        patterns, _ = self.fitting[n]

        def body():
            self.out.emit("trail = m.trail")
            names = {}
            self.terms.match_head(patterns, names)
            self.bodies.body(self.goals[n], names, Context())

        self._owned(n, lambda: self.out.define(f"clause_{n}", f"m, k, b{self.arguments}", body))

    def _owned(self, n, write):
        """Write code of clause ``n``."""
        clause = self.fitting[n][1]
        outer = self.out.owner, self.bodies.keep_variables, self.out.failing
        self.out.owner, self.out.failing = getattr(clause, "original", clause), self.leaving
        self.bodies.keep_variables = _mentions(clause.goals, FILTER)
        write()
        self.out.owner, self.bodies.keep_variables, self.out.failing = outer

    def _known(self, n, known):
        """The part of ``known`` about the arguments that helps clause ``n``."""
        return {position: kind for position, kind in known.items() if not (kind is SAME and self._kind(n, position) is _OTHER)}

    def _chain(self, numbers, known, repeat):
        """Emit code for the clauses ``numbers`` one after the other. It takes the first whose head and first tests succeed."""
        n = numbers[0]
        patterns, names, goals = self.fitting[n][0], {}, self.goals[n]
        if any(map(may_cut, goals)):
            self.out.emit("b = len(m.choices)")
        if len(numbers) == 1:

            def last():
                waiting, self.waiting = self.waiting, False
                self.terms.match_head(patterns, names, self._known(n, known), self.hole if waiting else None)
                self.bodies.body(goals, names, Context(repeat=repeat))

            self._owned(n, last)
            return
        height = self.out.fresh("t")

        def first():
            self.out.emit(f"{height} = len(trail)")
            self.out.emit("while True:" if self.bodies.enumerating else "for _ in ONCE:")
            self.out.depth += 1
            count, self.out.failing = len(self.out.lines), "break"
            self.terms.match_head(patterns, names, self._known(n, known))
            tests = 0
            while tests < len(goals) and is_test(goals[tests]):
                self.bodies.test(goals[tests], names)
                tests += 1
            self.out.failing = self.leaving
            if self.bodies.enumerating:
                self.out.emit(f"choice[2] = {height}; yield")
                self.out.emit("break")
                self.out.depth -= 1
                return
            if len(self.out.lines) == count:
                self.out.emit("pass")
            self.out.depth -= 1
            self.out.emit("else:")
            self.out.depth += 1
            following = goals[tests:]
            if not (following and known_goal(following[0], {CUT: (0, 0)}) is not None):
                self.out.emit(f"m.choices.append({self._choice(numbers[1:], known, height)})")
            self.bodies.body(following, names, Context(repeat=repeat))
            self.out.depth -= 1

        self._owned(n, first)
        self.out.emit(f"while len(trail) > {height}: trail.pop().ref = UNSET")
        self._chain(numbers[1:], known, repeat)

    def _choice(self, numbers, known, height):
        """An expression for a choice point whose alternatives are the clauses ``numbers``."""
        if self._enumerable(numbers):
            return f"[again, k, {height}, {self._rest_of(numbers, known)}(m{self.arguments}), P]"
        return f"({self._try(numbers, known)}, k, {height}{self.arguments})"

    def _enumerable(self, numbers):
        """Whether the alternatives can come from a generator: they go on through the whole predicate, and nothing in it is called."""
        if self.hole is not None or isinstance(self.predicate, Variant) or not self.looping or not self._repeats(self.goals[numbers[-1]]):
            return False
        last = len(self.fitting) - 1
        if numbers[-1] != last or not self._light(range(last + 1)) or not direct(self.goals[last][-1]):
            return False
        return all(is_plain_test(goal) for goals in [*self.goals[:-1], self.goals[-1][:-1]] for goal in goals)

    def _rest_of(self, numbers, known):
        """The name of a generator that yields ``None`` at each solution of the clauses ``numbers`` and of the turns after them.

        It runs while its choice point is the newest one, and takes that away before the last solution. It yields the arguments instead
        if there are other clauses now, with which the predicate goes on.
        """
        key = ("rest", tuple(numbers), tuple(known.items()))
        name = self.tries.get(key)
        if name is None:
            name = self.tries[key] = self.out.fresh("rest_")
            self.out.define(name, f"m{self.arguments}", lambda: self._enumerate(numbers, known))
        return name

    def _enumerate(self, numbers, known):
        outer = self.leaving, self.bodies.enumerating
        self.leaving, self.bodies.enumerating = "return", True
        self.out.emit("trail, choice, code = m.trail, m.choices[-1], P.call")
        self.out.emit("for _ in ONCE:")  # the first turn takes the clauses that are left
        self.out.depth += 1
        self._chain(numbers, known, "continue")
        self.out.depth -= 1
        self.out.emit("while True:")
        self.out.depth += 1
        self.out.emit("for _ in LOOP:")
        self.out.depth += 1
        self._dispatch(list(range(len(self.fitting))), {})
        self.out.depth -= 1
        self.out.emit(f"budget.left -= {len(LOOP)}")
        self.out.emit(f"if P.call is not code: {self._going_on()}")
        self.out.emit("m.rest()")
        self.out.depth -= 1
        self.leaving, self.bodies.enumerating = outer

    def _try(self, numbers, known):
        """The name of the function of a choice point that tries ``numbers``."""
        key = (tuple(numbers), tuple(known.items()))
        name = self.tries.get(key)
        if name is not None:
            return name
        name = self.tries[key] = self.out.fresh("try_")

        def body():
            self.out.emit(f"_, k, _{self.arguments} = step")
            self.out.emit("m.choices.pop()")
            self.out.emit("trail = m.trail")
            if self.looping and any(self._repeats(self.goals[n]) for n in numbers):
                self.out.emit("entering = True")
                self._loop(enter_the_loop)
            else:
                self._chain(numbers, known, None)

        def enter_the_loop():
            self.out.emit("if entering:")
            self.out.depth += 1
            self.out.emit("entering = False")
            self._chain(numbers, known, "continue")
            self.out.depth -= 1
            self._dispatch(list(range(len(self.fitting))), {})

        self.out.define(name, "m, step", body)
        return name


def try_clauses(m, k, clauses, *arguments):
    """Call the first of ``clauses``, with a choice point for the others."""
    count = len(clauses)
    height = len(m.choices)
    if count == 1:
        return clauses[0](m, k, height, *arguments)
    if not count:
        return fail(m)
    m.choices.append((_next_clause, k, len(m.trail), clauses, 1, arguments))
    return clauses[0](m, k, height, *arguments)


def _next_clause(m, step):
    _, k, trail_height, clauses, i, arguments = step
    choices = m.choices
    height = len(choices) - 1
    if i + 1 < len(clauses):
        choices[height] = (_next_clause, k, trail_height, clauses, i + 1, arguments)
    else:
        choices.pop()
    return clauses[i](m, k, height, *arguments)
