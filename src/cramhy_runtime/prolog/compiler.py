"""The clause compiler: the clauses of a predicate become one Python function.

For each predicate Python source is written and compiled: unification with the clause heads is spelled out, test by test, for the
patterns at hand; the first argument selects the clauses that can match, so that calls with a known one leave no choice point; a
clause that ends by calling its own predicate becomes a loop. Goals behind the first one of a body go into continuation functions,
which get the variables they need through their step. Ground facts without bodies are tables instead, see ``relations.py``.

Why source, and why clauses stand inside the function of their predicate: naive reverse runs at 2.1 M inferences a second; with
one more Python call per clause, which closures would need at least, at 1.2 M.
"""

from __future__ import annotations

from cramhy_runtime.kernel.budget import budget
from cramhy_runtime.lisp.data import Cons, Symbol

from . import control, lisp_calls
from .database import Clause, arguments_of, extended, find_predicate, valid_functor
from cramhy_runtime.utilities.lazy_lists import LazyTail
from .machine import fail
from cramhy_runtime.utilities.patterns import ANONYMOUS, same_atom, variable
from .relations import compile_relation, index_key
from .symbols import sym
from .terms import UNSET, TermTail, Var, unify

LOOP = range(100)
_INLINE_LIMIT = 6
_DEEP = 4
_CUT = sym("CRAM-PROLOG::CUT")
_UNIFIES = sym("CRAM-PROLOG::==")
_LISP_FUN = sym("CRAM-PROLOG::LISP-FUN")
_LISP_PRED = sym("CRAM-PROLOG::LISP-PRED")
_AND = sym("AND")
_COMPARISONS = {sym(name): sym(name) for name in ("<", ">", "<=", ">=")}
_TRUE = sym("CRAM-PROLOG::TRUE")

_ANY, _LIST, _OTHER = object(), object(), object()
"""What a clause can match by its first argument, where that is no key of the index: anything, lists, other atoms."""

INLINED = frozenset([_CUT, _UNIFIES, _LISP_FUN, _LISP_PRED, _AND, _TRUE, *_COMPARISONS])
"""Functors whose goals are compiled in place: when users extend one, all code is made anew."""


def compile_clauses(predicate, clauses):
    """The call function of ``predicate`` for ``clauses``, a list of `Clause`."""
    arity, fitting = predicate.arity, []
    for clause in clauses:
        arguments = _head_arguments(clause.head, arity)
        if arguments is not None:
            fitting.append((arguments, clause))
    if not fitting:
        return lambda m, step: fail(m)
    table = compile_relation([arguments for arguments, _ in fitting]) if all(
        clause.goals is None and _is_ground(arguments) for arguments, clause in fitting) else None
    return table or _Code(predicate, fitting).function()


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
    return [*arguments, _Rest(cell, arity - len(arguments))]


class _Rest:
    """The variable behind the dot of a clause head, for goals with ``count`` more arguments."""

    def __init__(self, name, count):
        self.name, self.count = name, count


def _is_ground(item):
    stack = list(item) if isinstance(item, list) else [item]
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            stack.append(item.cdr)
            item = item.car
        if isinstance(item, (_Rest, LazyTail)) or variable(item):
            return False
    return True


def _variables(item, found):
    stack = [item]
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            stack.append(item.cdr)
            item = item.car
        if variable(item) and item is not ANONYMOUS:
            found.setdefault(item)
    return found


class _Code:
    """The source of one predicate in the making: lines of text, and the constants that they name."""

    def __init__(self, predicate, fitting):
        self.predicate, self.fitting = predicate, fitting
        self.arity = predicate.arity
        self.lines, self.functions = [], []
        self.globals = {"Cons": Cons, "new": Cons.__new__, "Var": Var, "UNSET": UNSET, "unify": unify, "fail": fail, "LOOP": LOOP,
                        "same_atom": same_atom, "LazyTail": LazyTail, "TermTail": TermTail, "index_key": index_key,
                        "Symbol": Symbol, "lisp_fun": lisp_calls.lisp_fun, "lisp_pred": lisp_calls.lisp_pred,
                        "compare": lisp_calls.compare, "resolve_argument": lisp_calls.resolve_argument,
                        "raw_argument": lisp_calls.raw_argument, "as_variable": lisp_calls.as_variable,
                        "try_clauses": try_clauses, "P": predicate, "budget": budget}
        self.constants = {}
        self.counter = 0

    def function(self):
        arguments = "".join(f", a{i}" for i in range(self.arity))
        self.arguments = arguments
        clause_names = []
        for number, (patterns, clause) in enumerate(self.fitting):
            clause_names.append(f"clause_{number}")
            self._define(f"clause_{number}(m, k, b{arguments})", lambda p=patterns, c=clause: self._clause(p, c, False))
        self._define("predicate(m, step)", lambda: self._dispatch(clause_names))
        source = "\n".join(self.functions)
        name = f"<clauses of {self.predicate.functor!r}/{self.arity}>"
        exec(compile(source, name, "exec"), self.globals)
        for key, buckets in self.buckets.items():
            self.globals[key] = {item: tuple(self.globals[f"clause_{n}"] for n in numbers) for item, numbers in buckets.items()} \
                if isinstance(buckets, dict) else tuple(self.globals[f"clause_{n}"] for n in buckets)
        return self.globals["predicate"]

    # ------------------------------------------------------------------------------------------------------------- plumbing

    def _define(self, signature, body):
        outer, self.lines, depth = self.lines, [], getattr(self, "depth", 0)
        self.depth = 1
        body()
        self.functions.append(f"def {signature}:\n" + "\n".join(self.lines) + "\n")
        self.lines, self.depth = outer, depth

    def emit(self, line):
        self.lines.append("    " * self.depth + line)

    def fresh(self, prefix="t"):
        self.counter += 1
        return f"{prefix}{self.counter}"

    def constant(self, value):
        if value is None:
            return "None"
        if value is True:
            return "True"
        if value.__class__ is int and abs(value) < 2**31:
            return repr(value)
        name = self.constants.get(id(value))
        if name is None:
            name = self.constants[id(value)] = f"C{len(self.constants)}"
            self.globals[name] = value
        return name

    # ------------------------------------------------------------------------------------------------- choosing the clauses

    def _dispatch(self, names):
        self.emit(f"_, k{self.arguments} = step" if self.arity else "k = step[1]")
        self.emit("trail = m.trail")
        self.emit("for _ in LOOP:")
        self.depth += 1
        numbers = list(range(len(names)))
        self.buckets = {"EVERY": numbers}
        kinds = [self._kind(patterns) for patterns, _ in self.fitting]
        if not self.arity or all(kind is _ANY for kind in kinds):
            self._candidates(numbers, "EVERY")
        else:
            self.emit("while a0.__class__ is Var:")
            self.emit("    r = a0.ref")
            self.emit("    if r is UNSET: break")
            self.emit("    a0 = r")
            self.emit("c0 = a0.__class__")
            lists = [n for n in numbers if kinds[n] in (_ANY, _LIST)]
            others = [n for n in numbers if kinds[n] in (_ANY, _OTHER)]
            keys = {}
            for n in numbers:
                if kinds[n] not in (_ANY, _LIST, _OTHER):
                    keys.setdefault(kinds[n], None)
            index = {key: [n for n in numbers if kinds[n] in (_ANY, _OTHER, key)] for key in keys}
            self.buckets.update(LISTS=lists, OTHERS=others, INDEX=index)
            self._branch("if c0 is Cons:", lists, "LISTS")
            self._branch("elif c0 is Var:", numbers, "EVERY")
            if None in index:
                self._branch("elif a0 is None:", index[None], "NILS")
                self.buckets["NILS"] = index[None]
            self.emit("elif c0 is LazyTail or c0 is TermTail:")
            self.emit("    a0 = a0.force()")
            self.emit("    continue")
            self.emit("else:")
            self.depth += 1
            if [key for key in index if key is not None]:
                self.emit("found = INDEX.get(a0 if c0 is Symbol else index_key(a0), OTHERS)")
                self.emit(f"return try_clauses(m, k, found{self.arguments})")
            else:
                self._candidates(others, "OTHERS")
            self.depth -= 1
        self.depth -= 1
        self.emit(f"budget.left -= {len(LOOP)}")  # the machine's next checkpoint knows what was done here
        self.emit(f"return P.call, k{self.arguments}")

    def _branch(self, test, numbers, bucket):
        self.emit(test)
        self.depth += 1
        self._candidates(numbers, bucket)
        self.depth -= 1

    def _candidates(self, numbers, bucket):
        if not numbers:
            self.emit("return fail(m)")
        elif len(numbers) == 1 and len(self.fitting) <= _INLINE_LIMIT:
            patterns, clause = self.fitting[numbers[0]]
            if not all(_direct(goal) for goal in _flat(clause.goals)):
                self.emit("b = len(m.choices)")
            self._clause(patterns, clause, True)
        else:
            self.emit(f"return try_clauses(m, k, {bucket}{self.arguments})")

    def _kind(self, patterns):
        if not patterns:
            return _ANY
        first = patterns[0]
        if isinstance(first, _Rest) or variable(first):
            return _ANY
        if isinstance(first, Cons):
            return _LIST
        key = index_key(first)
        return _OTHER if key is NotImplemented else key

    # --------------------------------------------------------------------------------------------------------------- a clause

    def _clause(self, patterns, clause, looping):
        """Code of one clause: ``looping`` when it stands in the loop of the predicate, whose ``a0`` is dereferenced."""
        if not looping:
            self.emit("trail = m.trail")
        names = {}
        for i, pattern in enumerate(patterns):
            if isinstance(pattern, _Rest):
                self._rest(i, pattern, names)
                break
            if variable(pattern) and pattern is not ANONYMOUS and pattern not in names:
                names[pattern] = f"a{i}"
        # A variable that stands alone as an argument is that argument; the other occurrences must be the same as it.
        for i, pattern in enumerate(patterns):
            if isinstance(pattern, _Rest):
                break
            if not (variable(pattern) and (pattern is ANONYMOUS or names[pattern] == f"a{i}")):
                self._match(pattern, f"a{i}", names, 0, looping and i == 0)
        goals = list(_flat(clause.goals))
        self._body(goals, names, looping)

    def _rest(self, i, pattern, names):
        built = "None"
        for j in reversed(range(i, i + pattern.count)):
            built = f"Cons(a{j}, {built})"
        if pattern.name is not ANONYMOUS:
            if pattern.name in names:
                self.emit(f"if not unify({names[pattern.name]}, {built}, trail): return fail(m)")
            else:
                self.emit(f"rest = {built}")
                names[pattern.name] = "rest"

    def _match(self, pattern, expression, names, depth, dereferenced=False):
        """Code that unifies ``pattern`` with the term in the Python variable ``expression``; on failure it leaves by failing."""
        if variable(pattern):
            if pattern is ANONYMOUS:
                return
            if pattern in names:
                self.emit(f"if not unify({names[pattern]}, {expression}, trail): return fail(m)")
            else:
                names[pattern] = expression
            return
        if isinstance(pattern, Cons) and (depth >= _DEEP or _is_ground(pattern)):
            built = self._build(pattern, names)
            self.emit(f"if not unify({built}, {expression}, trail): return fail(m)")
            return
        x = expression
        if not dereferenced:
            x = self.fresh("x")
            self.emit(f"{x} = {expression}")
            self.emit(f"while {x}.__class__ is Var:")
            self.emit(f"    r = {x}.ref")
            self.emit("    if r is UNSET: break")
            self.emit(f"    {x} = r")
        if isinstance(pattern, Cons):
            self._match_list(pattern, x, names, depth)
            return
        value = self.constant(pattern)
        same = f"{x} is {value}" if isinstance(pattern, Symbol) or pattern is None or pattern is True else f"same_atom({x}, {value})"
        self.emit(f"if not ({same}):")
        self.emit(f"    if {x}.__class__ is Var:")
        self.emit(f"        {x}.ref = {value}")
        self.emit(f"        trail.append({x})")
        self.emit(f"    elif not unify({x}, {value}, trail): return fail(m)")

    def _match_list(self, pattern, x, names, depth):
        kind = self.fresh("c")
        self.emit(f"{kind} = {x}.__class__")
        self.emit(f"if {kind} is LazyTail or {kind} is TermTail:")
        self.emit(f"    {x} = {x}.force()")
        self.emit(f"    {kind} = {x}.__class__")
        known = dict(names)
        self.emit(f"if {kind} is Cons:")
        self.depth += 1
        for part, attribute in ((pattern.car, "car"), (pattern.cdr, "cdr")):
            if part is ANONYMOUS:
                continue
            if variable(part) and part not in names:
                name = names[part] = self.fresh("v")
                self.emit(f"{name} = {x}.{attribute}")
            else:
                piece = self.fresh("p")
                self.emit(f"{piece} = {x}.{attribute}")
                self._match(part, piece, names, depth + 1)
        if self.lines[-1].endswith(f"if {kind} is Cons:"):
            self.emit("pass")
        self.depth -= 1
        self.emit(f"elif {kind} is Var:")
        self.depth += 1
        written = dict(known)
        for name in names:
            if name not in known:
                written[name] = names[name]
                if _occurs(name, pattern):
                    self.emit(f"{names[name]} = Var()")
        built = self._cons(pattern, written)
        self.emit(f"{x}.ref = {built}")
        self.emit(f"trail.append({x})")
        self.depth -= 1
        self.emit("else: return fail(m)")

    def _cons(self, pattern, names):
        """Code for a new cons, without the call of its constructor; returns the Python variable that holds it."""
        car, cdr = self._build(pattern.car, names), self._build(pattern.cdr, names)
        cell = self.fresh("n")
        self.emit(f"{cell} = new(Cons); {cell}.car = {car}; {cell}.cdr = {cdr}")
        return cell

    def _build(self, pattern, names):
        """An expression for the term ``pattern``; new variables are created on lines before it."""
        if variable(pattern):
            if pattern is ANONYMOUS:
                return "Var()"
            if pattern not in names:
                names[pattern] = self.fresh("v")
                self.emit(f"{names[pattern]} = Var()")
            return names[pattern]
        if not isinstance(pattern, Cons) or _is_ground(pattern):
            return self.constant(pattern)
        parts, cell = [], pattern
        while isinstance(cell, Cons) and not _is_ground(cell) and len(parts) < 40:
            parts.append(self._build(cell.car, names))
            cell = cell.cdr
        if isinstance(cell, Cons) and not _is_ground(cell):
            end = self.fresh("n")
            self.emit(f"{end} = {self._build(cell, names)}")
        else:
            end = self._build(cell, names)
        for part in reversed(parts):
            end = f"Cons({part}, {end})"
        return end

    # ----------------------------------------------------------------------------------------------------------------- a body

    def _body(self, goals, names, looping):
        while goals:
            goal, goals = goals[0], goals[1:]
            if not self._inline(goal, names):
                break
        else:
            self.emit("return k")
            return
        self._call(goal, goals, names, looping)

    def _inline(self, goal, names):
        """Code for a goal that needs no call; false if it needs one."""
        functor = goal.car if isinstance(goal, Cons) else None
        if functor not in INLINED or extended(functor) or not _proper(goal):
            return False
        arguments = arguments_of(goal)
        if functor is _CUT and not arguments:
            self.emit("del m.choices[b:]")
        elif functor is _TRUE and not arguments:
            pass
        elif functor is _UNIFIES and len(arguments) == 2:
            left, right = (self._build(argument, names) for argument in arguments)
            self.emit(f"if not unify({left}, {right}, trail): return fail(m)")
        elif functor in _COMPARISONS and len(arguments) == 2:
            left, right = (self._argument(argument, names) for argument in arguments)
            self.emit(f"if not compare(m, {self.constant(functor)}, {left}, {right}): return fail(m)")
        elif functor is _LISP_FUN and arguments:
            function = self._argument(arguments[0], names)
            given = "".join(self._argument(argument, names) + ", " for argument in arguments[1:-1])
            result = self._build(arguments[-1], names) if len(arguments) > 1 else "None"
            self.emit(f"if not lisp_fun(m, {function}, ({given}), {result}): return fail(m)")
        elif functor is _LISP_PRED and arguments and not variable(arguments[0]):
            given = "".join(self._argument(argument, names) + ", " for argument in arguments[1:])
            self.emit(f"if not lisp_pred(m, {self.constant(arguments[0])}, ({given})): return fail(m)")
        else:
            return False
        return True

    def _argument(self, pattern, names):
        """An expression for what a Lisp function gets for ``pattern``: a variable's value; lists as they are written."""
        if variable(pattern):
            return f"resolve_argument(m, {self._build(pattern, names)})"
        if not isinstance(pattern, Cons) or _is_ground(pattern):
            return self.constant(pattern)
        # A variable of the head is here whatever the caller gave; in a list as it is written it must be a variable still.
        written = {**names, **{name: f"as_variable({names[name]})" for name in _variables(pattern, {}) if name in names}}
        built = self._build(pattern, written)
        names.update((name, code) for name, code in written.items() if name not in names)
        return f"raw_argument(m, {built})"

    def _call(self, goal, goals, names, looping):
        functor = goal.car if isinstance(goal, Cons) else None
        direct = _direct(goal)
        if direct:
            given = [self._build(argument, names) for argument in goal.cdr or ()]
        else:
            term = self._build(goal, names)
        if direct and not goals and looping and functor is self.predicate.functor and len(given) == self.arity:
            if self.arity:
                self.emit(f"{self.arguments[2:]}{',' if self.arity == 1 else ''} = {', '.join(given)}"
                          f"{',' if self.arity == 1 else ''}")
            self.emit("continue")
            return
        rest = self._continuation(goals, names)
        if direct:
            callee = find_predicate(functor, len(given))
            self.emit(f"return {self.constant(callee)}.call, {rest}{''.join(', ' + item for item in given)}")
        elif functor in control.CONTROL:
            name = self.constant(control.in_clause(functor))
            self.emit(f"return {name}(m, ({term}).cdr, {rest}, b)")
        else:
            self.emit(f"return {self.constant(control.solve)}(m, {term}, {rest}, b)")

    def _continuation(self, goals, names):
        """An expression for the continuation that proves ``goals``; its function is written beside this one."""
        if not goals:
            return "k"
        needed = {}
        for goal in goals:
            _variables(goal, needed)
        live = [name for name in needed if name in names]
        barrier = not all(_direct(goal) for goal in goals)
        function = self.fresh("then_")
        held = ["k", *(["b"] if barrier else []), *(f"v_{i}" for i in range(len(live)))]
        passed = ["k", *(["b"] if barrier else []), *(names[name] for name in live)]

        def body():
            self.emit(f"_, {', '.join(held)} = step")
            self.emit("trail = m.trail")
            self._body(goals, {name: f"v_{i}" for i, name in enumerate(live)}, False)

        self._define(f"{function}(m, step)", body)
        return f"({function}, {', '.join(passed)})"


def _proper(goal):
    while isinstance(goal, Cons):
        goal = goal.cdr
    return goal is None


def _direct(goal):
    """Whether a goal is a call of a predicate that is known now, with a known number of arguments."""
    return isinstance(goal, Cons) and valid_functor(goal.car) and goal.car not in control.CONTROL and _proper(goal)


def _occurs(name, pattern):
    return name in _variables(pattern, {})


def _flat(goals):
    """The goals of a body, conjunctions in it flattened."""
    for goal in goals or ():
        if isinstance(goal, Cons) and goal.car is _AND and not extended(_AND):
            yield from _flat(goal.cdr)
        else:
            yield goal


def try_clauses(m, k, clauses, *arguments):
    """Call the first of ``clauses``, with a choice point for the others."""
    count = len(clauses)
    if count == 1:
        return clauses[0](m, k, len(m.choices), *arguments)
    if not count:
        return fail(m)
    height = len(m.choices)
    m.choices.append((len(m.trail), (_next_clause, k, clauses, 1, arguments)))
    return clauses[0](m, k, height, *arguments)


def _next_clause(m, step):
    _, k, clauses, i, arguments = step
    height = len(m.choices)
    if i + 1 < len(clauses):
        m.choices.append((len(m.trail), (_next_clause, k, clauses, i + 1, arguments)))
    return clauses[i](m, k, height, *arguments)


__all__ = ["Clause", "INLINED", "compile_clauses"]
