"""Lists that a loop builds from front to back, without a variable for each rest that is not known yet.

``(<- (app (?h . ?t) ?l (?h . ?r)) (app ?t ?l ?r))`` gives its caller a cons whose cdr is the variable ``?r``, which the next turn of
the loop sets at once. No other code has seen that variable. So while such a predicate loops, it remembers the cons itself, as the
*hole*, and the next turn puts its cons into the cdr: without a variable, without a trail entry, and without a reference to follow when
the list is read. Before anything but the next such turn comes, the hole is filled with a variable.

Only a list argument that runs along the list being built could see the hole; the code tests for that. The law: the answers are the
same as without this.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable

from .clause_bodies import Context
from .generated_code import Rest, is_ground, variables

FILL = "if hole is not None: a{0} = hole.cdr = Var(); hole = None"


def hole_positions(functor, patterns, goals):
    """The arguments in which a clause may build a list with a hole.

    Such an argument is a cons whose cdr is new and goes to the same argument of the call of ``functor``, which is the whole body. The
    other arguments of the clause are variables, except for one list.
    """
    fit = []
    if len(goals) != 1 or goals[0].__class__ is not Cons or goals[0].car is not functor:
        return fit
    given = list(goals[0].cdr or ())
    if len(given) != len(patterns):
        return fit
    for position, pattern in enumerate(patterns):
        if not isinstance(pattern, Cons) or not variable(pattern.cdr) or pattern.cdr is ANONYMOUS or given[position] is not pattern.cdr:
            continue
        others = [*patterns[:position], *patterns[position + 1 :]]
        found = [item for item in others if isinstance(item, Cons)]
        parts = [part for item in others for part in ((item.car, item.cdr) if isinstance(item, Cons) else (item,))]
        elsewhere = [*parts, *given[:position], *given[position + 1 :], pattern.car]
        if (
            len(found) == 1
            and not any(isinstance(item, Rest) or not variable(item) for item in parts)
            and len({id(part) for part in parts if part is not ANONYMOUS}) == sum(part is not ANONYMOUS for part in parts)
            and (is_ground(pattern.car) or variable(pattern.car))
            and all(pattern.cdr not in variables(item) for item in elsewhere)
        ):
            fit.append(position)
    return fit


def can_wait(patterns, position):
    """Whether the head of a clause can be matched without a variable in the hole: the argument there is an atom or a repeated variable."""
    if any(isinstance(pattern, Rest) for pattern in patterns):
        return False
    pattern = patterns[position]
    return (not isinstance(pattern, Cons) and not variable(pattern)) or (
        variable(pattern) and pattern is not ANONYMOUS and pattern in patterns[:position]
    )


class Holes:
    """Writes code for such loops into ``out``, a `Source`. terms, bodies: what writes the rest of a clause."""

    def __init__(self, out, terms, bodies):
        self.out, self.terms, self.bodies = out, terms, bodies

    def turn(self, patterns, call, position, telling):
        """Emit code for a turn of a clause with the arguments ``patterns`` and the body ``call``.

        position: of the argument that is built. telling: that of the list argument, which is known to be a cons.
        """
        pattern, first = patterns[position], patterns[telling]
        names = {item: f"a{i}" for i, item in enumerate(patterns) if variable(item) and item is not ANONYMOUS}
        self.out.emit("if hole is not None:")
        self.out.depth += 1
        self.out.emit(f"if a{telling} is hole: a{position} = hole.cdr = Var(); hole = None")
        self.out.emit("else:")
        self.out.depth += 1
        self._take_parts(first, telling, names)
        self.out.emit(f"n = new(Cons); n.car = {self.terms.build(pattern.car, dict(names))}; hole.cdr = n; hole = n")
        self._next_turn(call, position, dict(names))
        self.out.depth -= 2
        self._take_parts(first, telling, names)
        x = f"a{position}"
        self.terms.follow(x)
        self.out.emit(f"if {x}.__class__ is Var:")
        self.out.depth += 1
        inside = dict(names)
        self.out.emit(f"n = new(Cons); n.car = {self.terms.build(pattern.car, inside)}; {x}.ref = n; trail.append({x}); hole = n")
        self._next_turn(call, position, inside)
        self.out.depth -= 1
        self.terms.match(pattern, x, names, 0)
        self.bodies.body([call], names, Context(repeat="continue"))

    def _take_parts(self, first, telling, names):
        for part, attribute in ((first.car, "car"), (first.cdr, "cdr")):
            if part is not ANONYMOUS:
                names[part] = self.out.fresh("v")
                self.out.emit(f"{names[part]} = a{telling}.{attribute}")

    def _next_turn(self, call, position, names):
        given = [self.terms.build(item, names) if i != position else None for i, item in enumerate(call.cdr)]
        self.out.assign_arguments(given)
        self.out.emit("continue")
