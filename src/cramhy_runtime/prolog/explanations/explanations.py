"""``(explain goal)``: an explanation for a student of why a goal holds, or why it does not.

A goal that fails has mostly failed in many ways: each clause of its predicate was tried and stopped somewhere. The text shows the clause
that came furthest: the goals that hold, the first that never did, and the values of the variables then. It goes on into that goal, down
to the built-in or the missing fact at the bottom. The other clauses get a line each. For a goal that holds, the text shows the clauses
that prove it.

From Python `explain` returns an `Explanation`, whose ``str`` is that text; in Lisp the text is printed.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import Error, error, handler_case
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, MultipleValues, Symbol
from cramhy_runtime.lisp_core.packages import CURRENT as PACKAGE
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.lisp_core.output import standard_output

from . import explaining, failure_reasons as reasons
from .explaining import start
from ..engine.goal_text import Names, clause_name, clause_number, show
from ..symbols import sym
from ..terms.terms import resolve
from .undefined import advice
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..engine.database import Clause

LIMIT = 10_000
"""A proof is given up as endless after so many goals."""
_MOST_OTHERS, _MOST_DEPTH, _MOST_VALUES, _MOST_LINES, _ENDS = 8, 6, 6, 40, 4
_NOT, EXPLAIN = sym("NOT"), sym("CRAM-PROLOG::EXPLAIN")
_FIRST_WORDS = "there it none nobody the one what no element".split()

_goal_makers = []
to_explain = []
"""The thing that ``(explain)`` explains: the one that the last such error message was about; a list with at most one element."""


class Explanation:
    """The outcome of a proof, and the reasons. ``str`` of it is the text for the user.

    ``outcome`` is ``"holds"``, ``"fails"``, ``"given up"`` (after too many goals) or ``"error"``. ``bindings`` is a dict of the goal's
    variables if it holds. ``clause`` is the `Clause` that proves it, or that came furthest. ``goal`` is the text of the goal at the
    bottom of the failure, and ``reason`` says why that one fails. ``problem`` is the condition that ended the proof.
    """

    def __init__(
        self,
        record: Any,
        outcome: str,
        bindings: dict[Symbol, object] | None = None,
        problem: BaseException | None = None,
        text: str | None = None,
    ):
        self.outcome, self.bindings, self.problem = outcome, bindings, problem
        self.text: str = text or ""
        self.root: Any = None
        self.clause: Clause | None = None
        self.goal: str | None = None
        self.reason: str | None = None
        if text is not None:
            return
        self.root = record.root
        if outcome == "holds" and self.root.attempts:
            self.clause = self.root.attempts[-1].clause
        if outcome == "fails":
            bottom = _bottom(self.root)
            self.goal, self.reason = _shown(bottom), _reason(bottom)
            self.clause = self.root.attempts and _furthest(self.root).clause or None
        self.text = "\n".join(_TELLERS[outcome](self, record))

    @property
    def holds(self) -> bool:
        """Whether the goal has a solution."""
        return self.outcome == "holds"

    def __str__(self) -> str:
        return self.text

    def hint(self) -> str:
        """The text for an error that itself names the goal: the clause that came furthest, and those that came as far."""
        lines = self.text.splitlines()[1:]
        if self.clause is not None and len(self.root.attempts) > 1:
            best = _furthest(self.root)
            if best.mismatch is None:
                lines = lines[: lines.index("The others:")]
                others = _others(self.root, best, as_far=True)
                lines += ["As far came:", *("  " + line for line in others[:_ENDS])] if others else []
                lines += [f"  and {len(others) - _ENDS} more"] if len(others) > _ENDS else []
        return "\n".join(lines)


def explain(goal: object, limit: int = LIMIT, dry: bool = False) -> Explanation:
    """The `Explanation` of ``goal``: Lisp data, quoted as for ``prolog``, or an object with a goal, such as a designator.

    limit: the number of goals after which the proof is given up, 1 or more. dry: whether to leave out goals that might change
    something. Another goal or limit is an error.
    """
    goal = goal_for(goal)
    if limit.__class__ is not int or limit < 1:
        error("The :LIMIT of EXPLAIN is the number of goals after which a proof is given up, 1 or more: ~S is none.", limit)
    if isinstance(goal, str):
        return Explanation(None, "fails", text=goal)
    machine, variables = start(goal, limit, dry)
    record = machine.record
    problem, found = handler_case([(Error, lambda condition: (condition, False))], lambda: (None, machine.next_solution()))
    if problem is not None:
        return Explanation(record, "error", problem=problem)
    if record.stopped is not None:
        return Explanation(record, "given up")
    if found:
        return Explanation(
            record, "holds", {symbol: resolve(variable) for symbol, variable in variables.items() if resolve(variable) is not symbol}
        )
    return Explanation(record, "fails")


def print_explanation(goal=UNSUPPLIED, *, limit=LIMIT):
    """``(explain &optional goal &key limit)``: print to ``*standard-output*`` why ``goal`` holds or fails. Returns no values.

    Without a goal, it is the goal of the last error; it is an error if there was none.
    """
    if goal is UNSUPPLIED:
        goal = (
            to_explain[-1]
            if to_explain
            else error("There is nothing to explain yet: give EXPLAIN a goal, quoted as for PROLOG, or a designator.")
        )
    found = explain(goal, limit)
    stream = standard_output()
    stream.fresh_line()
    show = getattr(stream, "show", None)  # a notebook shows it as an outline
    if show is None or not show(found):
        stream.write(f"{found}\n")
    return MultipleValues(())


def offer(thing):
    """The form that explains ``thing``, for an error message. From now on, ``(explain)`` is about it."""
    to_explain[:] = [thing]
    return "(explain)" if PACKAGE.value.lookup("EXPLAIN")[0] is EXPLAIN else "(prolog:explain)"


def explained_by(cls, goal):
    """Explain objects of ``cls`` by ``goal(object)``: a goal that resolves the object, or a text if there is no such goal."""
    _goal_makers.append((cls, goal))


def goal_for(thing):
    """The goal that explains ``thing``, or a text. Objects of other classes are an error."""
    for cls, goal in _goal_makers:
        if isinstance(thing, cls):
            return goal(thing)
    if isinstance(thing, Cons):
        return thing
    return error("EXPLAIN takes a goal, quoted as for PROLOG, or a designator: ~S is neither.", thing)


# ---------------------------------------------------------------------------------------------------------------- what fails


def _shown(box):
    return show(box.shown)


def _furthest(box):
    """The attempt at the goal of ``box`` that came furthest."""
    return max(box.attempts, key=explaining.Attempt.score)


def _bottom(box):
    """The box at the bottom of a failure, found by following `_culprit`."""
    while True:
        deeper = _culprit(box)
        if deeper is None:
            return box
        box = deeper


def _culprit(box):
    """The goal inside that shows why the goal of ``box`` failed, or ``None`` if the reason is in the box itself."""
    if box.attempts:
        return _furthest(box).culprit
    return box.culprit if box.functor is not _NOT else None


def _reason(box):
    """Why a goal without a culprit failed: a clause of a sentence, or ``None``."""
    if box.trouble == "undefined":
        return _undefined(box)
    if box.trouble == "empty":
        return f"there are no clauses of {show(box.functor)}"
    if box.trouble == "dry":
        return "what it calls was not called again here"
    if box.functor is _NOT and box.inner:
        return f"{_shown(box.inner[0])} holds"
    if box.attempts:
        return _mismatches(box)
    return box.reason


def _undefined(box):
    return advice(box.functor if box.term.__class__ is Cons else None) or f"nobody defines {show(box.functor)}"


def _mismatches(box):
    """Why no clause of a predicate matches a goal."""
    attempts, functor = box.attempts, show(box.functor)
    best = _nearest(attempts)
    if best.mismatch[0] == 0:
        counts = {attempt.mismatch[1] for attempt in attempts if attempt.mismatch[0] == 0}
        return reasons.other_count(box.functor, best.mismatch[2], counts)
    which = (
        f"none of the {box.tried} clauses of {functor} matches; in the nearest, "
        if box.tried > 1
        else f"the only clause of {functor} does not match: in "
    )
    return which + f"{clause_name(best.clause)}, {_mismatch(best)}"


def _mismatch(attempt):
    """``argument 2 is move, not drive``."""
    number, wanted, given = attempt.mismatch
    if number == 0:
        return f"the head has {wanted} argument{'' if wanted == 1 else 's'}, not {given}"
    names = Names()
    return f"argument {number} is {show(wanted, names)}, not {show(given, names)}"


def _nearest(attempts):
    """The attempt that is most like the goal, among attempts whose heads do not match."""
    furthest = max(attempt.mismatch[0] for attempt in attempts)
    best = [attempt for attempt in attempts if attempt.mismatch[0] == furthest]
    given = best[0].mismatch[2]
    if furthest and isinstance(given, Symbol):
        near = reasons.spelled_like(given, [a.mismatch[1] for a in best if isinstance(a.mismatch[1], Symbol)])
        for attempt in best:
            if near and attempt.mismatch[1] is near[0]:
                return attempt
    return best[0]


def _tell(box, depth=0):
    """Lines that say why the goal of ``box`` failed, without the goal itself."""
    if depth == _MOST_DEPTH:
        bottom = _bottom(box)
        return [f"... and so on, down to {_shown(bottom)}" + (f": {_reason(bottom)}" if _reason(bottom) else "")]
    if box.attempts:
        best = _furthest(box)
        if best.mismatch is not None:
            return [_sentence(_mismatches(box))]
        if best.clause is None:
            return _tell_body(best, depth)
        return _tell_clauses(box, best, depth)
    deeper = _culprit(box)
    if deeper is None:
        reason = _reason(box)
        return [_sentence(reason)] if reason else []
    return [f"{_shown(deeper)} fails" + (":" if _tell(deeper, depth + 1) else "."), *("  " + line for line in _tell(deeper, depth + 1))]


def _sentence(text):
    if text.partition(" ")[0] in _FIRST_WORDS:  # and not a symbol of the user's
        text = text[0].upper() + text[1:]
    return text if text.endswith("?") else text + "."


def _tell_clauses(box, best, depth):
    count = box.tried
    lines = [
        f"Of {count} clauses this one came furthest, {clause_name(best.clause)}:"
        if count > 1
        else f"There is one clause, {clause_name(best.clause)}:"
    ]
    lines += ["  " + line for line in [show(best.clause.head), *_tell_body(best, depth)]]
    others = _others(box, best) if depth == 0 else []
    if others:
        lines.append("The others:")
        lines += ["  " + line for line in others[:_MOST_OTHERS]]
        if len(others) > _MOST_OTHERS:
            lines.append(f"  and {len(others) - _MOST_OTHERS} more")
    return lines


def _others(box, best, as_far=False):
    """Lines for the clauses except ``best``, one for each reason. With ``as_far``, only for those that came as far."""
    stopped = {}
    for attempt in box.attempts:
        if attempt is not best and not (as_far and attempt.reached < best.reached):
            stopped.setdefault((attempt.clause.group, _brief(attempt)), []).append(attempt.clause)
    lines = []
    for (group, brief), clauses in stopped.items():
        numbers = [clause_number(clause) for clause in clauses]
        of = "" if group is best.clause.group else f" of {show(group)}"
        lines.append(f"clause{'s' if len(numbers) > 1 else ''} {', '.join(numbers)}{of}{_place(clauses[0], best.clause)}: {brief}")
    return lines


def _place(clause, told):
    """The place of ``clause``, in short if it is in the file of the clause ``told``."""
    position = clause.position
    if position is None:
        return ""
    if told.position is not None and told.position[0] == position[0]:
        return f" (line {position[1]})"
    return f" at {describe(position)}"


def _brief(attempt):
    """Why a clause did not succeed, in a line."""
    if attempt.mismatch is not None:
        return _mismatch(attempt)
    culprit = attempt.culprit
    if culprit is None:
        return "it has solutions, but what follows fails for them"
    bottom = _bottom(culprit)
    return _reason(bottom) or f"{_shown(bottom)} fails"


def _tell_body(attempt, depth):
    """Lines for the goals of a body, each with its outcome."""
    written = list(explaining.flat(attempt.clause.goals)) if attempt.clause is not None else attempt.goals
    lines = []
    for position, goal in enumerate(written):
        if position < attempt.reached:
            lines.append(f"holds  {show(goal)}")
        elif position > attempt.reached:
            lines.append(f"  -    {show(goal)}")
        else:
            culprit, tried = attempt.culprit, len(attempt.boxes[position])
            stopped = culprit is not None and culprit.trouble == "dry"
            how_often = f" for each of {tried} solutions of the goals before it; for one:" if culprit is not None and tried > 1 else ""
            lines.append(f"{'STOPS' if stopped else 'FAILS' if culprit is not None else 'holds'}  {show(goal)}{how_often}")
            if culprit is not None:
                lines += ["         " + line for line in _tell(culprit, depth + 1)]
    culprit = attempt.culprit or (attempt.boxes[attempt.reached][0] if attempt.boxes else None)
    values = culprit.values if culprit is not None else ()
    if values:
        shown = [f"{show(name)} = {show(value)}" for name, value in values[:_MOST_VALUES]]
        lines.append(f"with {', '.join(shown)}" + (", ..." if len(values) > _MOST_VALUES else ""))
    return lines


def _tell_failure(explanation, record):
    root = record.root
    told = _tell(root)
    return [f"{_shown(root)} has no solution.", *told]


# ----------------------------------------------------------------------------------------------------------------- what holds


def _tell_success(explanation, record):
    root = record.root
    values = ", ".join(f"{show(symbol)} = {show(value)}" for symbol, value in explanation.bindings.items())
    lines = [f"{_shown(root)} holds" + (f" with {values}." if values else ".")]
    proof = _proof(root, 0)
    lines += proof[:_MOST_LINES]
    if len(proof) > _MOST_LINES:
        lines.append(f"... and {len(proof) - _MOST_LINES} goals more")
    return lines


def _proof(root, depth):
    """Lines for the goals of a proof, each with the clause that proves it and the goals of its body below it."""
    lines, stack, names = [], [(root, 0)], Names()
    while stack:
        box, depth = stack.pop()
        attempt = box.attempts[-1] if box.attempts and box.attempts[-1].mismatch is None else None
        by = f"  by {clause_name(attempt.clause)}" if attempt is not None and attempt.clause is not None else ""
        if box.functor is not explaining.AND:
            lines.append(f"{'  ' * (depth + 1)}{show(box.term, names)}{by}")
            depth += 1
        inside = attempt.live if attempt is not None else () if box.functor is _NOT else [b for b in box.inner if b.state == "exited"]
        stack += [(inner, depth) for inner in reversed(inside)]
    return lines


# ------------------------------------------------------------------------------------------------------- what comes to no end


def _chain(box):
    """The goals around ``box`` and its own, the outermost first."""
    chain = []
    while box is not None:
        chain.append(box)
        box = box.parent
    return chain[::-1]


def _tell_given_up(explanation, record):
    chain = [_shown(box) for box in _chain(record.stopped)]
    lines = [
        f"The proof of {_shown(record.root)} was given up after {record.limit} goals; it may be endless. It was in these goals, "
        "the outermost first:"
    ]
    if len(chain) <= 2 * _ENDS + 1:
        lines += ["  " + text for text in chain]
    else:
        lines += ["  " + text for text in chain[:_ENDS]]
        lines += [f"  ... {len(chain) - 2 * _ENDS} more ...", *("  " + text for text in chain[-_ENDS:])]
    again = next(
        (box for box in _chain(record.stopped) if box.attempts and "..." not in _shown(box) and chain.count(_shown(box)) > 1), None
    )
    if again is not None:
        clause = again.attempts[-1].clause
        lines.append(
            f"{_shown(again)} comes back to itself"
            + (f" through {clause_name(clause)}" if clause is not None else "")
            + ": nothing has changed in between, so it never ends."
        )
    else:
        lines.append(f"If it only takes long, allow it more goals: (explain goal :limit {10 * record.limit}).")
    return lines


def _tell_error(explanation, record):
    text = str(explanation.problem).splitlines() or [type(explanation.problem).__name__]
    lines = [f"The proof of {_shown(record.root)} ends with an error: {text[0]}", *("  " + line for line in text[1:])]
    chain = _chain(record.latest)
    lines.append("It was in these goals, the outermost first:")
    lines += [f"  {_shown(box)}" for box in chain[-2 * _ENDS :]]
    return lines


_TELLERS = {"fails": _tell_failure, "holds": _tell_success, "given up": _tell_given_up, "error": _tell_error}

__all__ = ["Explanation", "explain", "explained_by", "print_explanation"]
