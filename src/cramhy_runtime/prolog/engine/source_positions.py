"""Where clauses and goals stand in the user's text, so that messages can name the rule and the place.

A clause knows the form that made it (see ``terms/origins.py``). Goals are data inside of that form. When a message needs the place of a
goal, the form is read again from its text.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.source_places import circumstance, describe, user_position
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.kernel.images import Cell, per_image

from . import database
from .machine import Machine, again
from .goal_text import clause_name, clause_number, show
from ..terms.terms import import_term, undo, unify

# --------------------------------------------------------------------------------------------------------------------- goals

_goals: dict = per_image({})
_version = Cell(-1)


def _indexed():
    """Functor → its goals in clauses: (clause, path to the goal in the form of the clause, goal)."""
    if _version.value != database.version.value:
        _version.value = database.version.value
        _goals.clear()
        for entry in list(database.functors.values()):
            for clause in entry.clauses:
                for number, goal in enumerate(clause.goals or ()):
                    _enter(clause, goal, (number + 2,))  # after `<-` and the head
    return _goals


def _enter(clause, form, path):
    waiting = [(form, path)]
    while waiting:
        form, path = waiting.pop()
        if isinstance(form, Cons):
            if isinstance(form.car, Symbol):
                _goals.setdefault(form.car, []).append((clause, path, form))
            number = 0
            while isinstance(form, Cons):
                waiting.append((form.car, (*path, number)))
                form, number = form.cdr, number + 1


def written_goals(goal):
    """The goals in clauses of which the term ``goal`` may be an instance: (clause, path, goal as it is written)."""
    found = []
    for clause, path, written in _indexed().get(goal.car, ()):
        trail = []
        if unify(import_term(written, {}), goal, trail):
            found.append((clause, path, written))
        undo(trail, 0)
    return found


def goal_position(clause, path):
    """(file, line, column) of a goal of ``clause``, or of the clause if its text cannot be read, or ``None`` if the place is unknown."""
    position = clause.position
    if position is None or position[0].endswith(".hy"):
        return position
    form, places = _read_again(*position)
    for number in path:
        for _ in range(number):
            form = form.cdr if isinstance(form, Cons) else None
        if not isinstance(form, Cons):
            return position
        form = form.car
    return (position[0], *places[id(form)][:2]) if id(form) in places else position


def _read_again(filename, line, column=None):
    """The form that begins there, read into a separate package, and the places of its parts."""
    import linecache  # it imports the tokenizer

    lines = linecache.getlines(filename)[line - 1 :]
    if not lines or not column:
        return None, {}
    text = "\n" * (line - 1) + " " * (column - 1) + lines[0][column - 1 :] + "".join(lines[1:])
    return PORTS.user.read_with_places(text, filename)


def running(m):
    """(clause, functor, waiting clauses) of the code that the proof ``m`` runs. The first two are ``None`` if the code does not say.

    The functor is known if the code is for several clauses. The waiting clauses are those with goals left to prove.
    """
    clause = functor = None
    frame = sys._getframe(1)
    while frame is not None and frame.f_code is not _LOOP:
        space = frame.f_globals
        predicate = space.get("P")
        if functor is None and isinstance(predicate, database.Predicate) and frame.f_code.co_filename.startswith("<clauses of "):
            clause, functor = getattr(space.get(frame.f_code.co_name), "clause", None), predicate.functor
        frame = frame.f_back
    waiting, step = {}, m.goes_on
    while step is not None and len(waiting) < _LOOKED_AT:
        waiting[step] = getattr(step[0], "clause", None)
        step = step[1]
    return clause, functor, [each for each in waiting.values() if each is not None]


def _tell_clause(found):
    """A text for an error in a proof: which clause was tried, if the step shows it."""
    step = found.get("step") or (None, None)
    function = step[0]
    clause = getattr(function, "clause", None)
    if clause is None and step[1] is not None and function is not again:
        clause = getattr(step[1][0], "clause", None)
    predicate = step[4] if function is again else getattr(function, "__globals__", {}).get("P")
    if clause is None and isinstance(predicate, database.Predicate):
        entry = database.functors.get(predicate.functor)
        clauses = entry.clauses if entry is not None else ()
        if len(clauses) != 1:
            return f"in the clauses of {show(predicate.functor)}"
        clause = clauses[0]
    return clause and f"in {clause_name(clause)}"


circumstance(_tell_clause)(Machine.next_solution)
_LOOP = Machine.next_solution.__code__
_LOOKED_AT, _SHOWN = 20, 3


def _mentions(query, goal):
    """Whether the query itself has a goal with the functor of ``goal``."""
    waiting = [query]
    while waiting:
        form = waiting.pop()
        if isinstance(form, Cons):
            if isinstance(goal, Cons) and form.car is goal.car:
                return True
            while isinstance(form, Cons):
                waiting.append(form.car)
                form = form.cdr
    return False


class Place:
    """The place in the text of the term ``goal``, a goal of the proof ``m``.

    ``position`` is (file, line, column), or ``None``. ``clauses`` are those to which it may belong, none for a goal of the query.
    ``written`` is the goal as it is written there. The last goal of a clause runs in place of its clause, so its clause is not known: with
    ``everywhere`` all clauses are searched, unless the query has such a goal itself.
    """

    def __init__(self, m, goal, everywhere=False):
        found = written_goals(goal) if isinstance(goal, Cons) else []
        clause, functor, waiting = running(m)
        if clause is not None:
            found = [entry for entry in found if entry[0] is clause]
        elif functor is not None:
            found = [entry for entry in found if entry[0].head.car is functor]
        else:
            near = [entry for entry in found if entry[0] in waiting]
            found = near or (found if everywhere and not _mentions(getattr(m, "goal", None), goal) else [])
        self.clauses = list(dict.fromkeys(entry[0] for entry in found)) or ([] if clause is None else [clause])
        self.written = found[0][2] if found else None
        if found:
            self.position = goal_position(*found[0][:2])
        else:
            self.position = user_position() if clause is None else clause.position

    @property
    def in_file(self) -> bool:
        """Whether it stands in a file, so that it was neither typed at a prompt nor asked by Python."""
        return self.position is not None and not self.position[0].startswith("<")

    @property
    def where(self):
        """``at family.lisp:14:3``, or ``None`` for a goal that was typed at the prompt."""
        place = describe(self.position)
        return None if not place or not self.clauses and self.position[0].startswith("<repl") else f"at {place}"

    def rule(self, words):
        """``words`` and the clauses: ``It is a goal of clause 2 of family.`` It is ``None`` for a goal of the query itself."""
        if not self.clauses:
            return None
        names = [f"clause {clause_number(clause)} of {show(clause.group)}" for clause in self.clauses[:_SHOWN]]
        return f"{words} {' or '.join(names)}{' or others' if len(self.clauses) > _SHOWN else ''}."
