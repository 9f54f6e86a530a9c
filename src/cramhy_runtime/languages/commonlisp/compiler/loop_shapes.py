"""Loops in a ``tagbody``: which Python loop it is.

Every loop of Common Lisp ends up as a ``tagbody``, where one may jump from anywhere to anywhere. Nearly all of them are of one
shape: something before, one stretch that begins with a tag and is gone back to, and something after, where the stretch is left
to. `loop_of` finds it. `counting` finds in such a stretch a variable that only counts up to a limit, and `across` an index that
only serves to walk along a vector, so that Python's ``for`` can do that.
"""

from __future__ import annotations

from cramhy_runtime.utilities.records import dataclass

from cramhy_runtime.lisp_core.dispatch.reached_slots import read_attribute, written_attribute
from cramhy_runtime.lisp_core.packages import sym
from . import nodes
from .facts import walk
from .kinds import INT

LENGTH, AREF = sym("LENGTH"), sym("AREF")
LIMITS = {sym(">="): (1, False), sym(">"): (1, True), sym("<="): (-1, False), sym("<"): (-1, True)}
"""The test that ends a counting loop: its direction, and whether the limit itself is still reached."""
STEPS = {sym("+"): 1, sym("-"): -1, sym("1+"): 1, sym("1-"): -1}

QUICK = {
    sym(name)
    for name in """+ - * / < > <= >= = /= 1+ 1- MOD REM MAX MIN ABS SQRT SIN COS EXP ZEROP PLUSP MINUSP EVENP ODDP CAR CDR
FIRST SECOND THIRD REST CADR CDDR CAAR CDAR CONS LIST NULL NOT EQ EQL CONSP ATOM LISTP ENDP SYMBOLP NUMBERP INTEGERP STRINGP LENGTH
AREF SVREF CHAR SCHAR GETHASH CHAR= CHAR/= CHAR-CODE CODE-CHAR CHAR-UPCASE CHAR-DOWNCASE ALPHA-CHAR-P DIGIT-CHAR-P UPPER-CASE-P
LOWER-CASE-P ALPHANUMERICP CHARACTERP VALUES FLOAT FLOOR TRUNCATE ROUND CEILING LOGAND LOGIOR LOGXOR ASH
CRAMHY::COLLECT CRAMHY::CAR-OF-CONS CRAMHY::CDR-OF-CONS CRAMHY::END-OF-LIST CRAMHY::LOOP-VECTOR CRAMHY::CHECK-SHAPE""".split()
}
"""Functions that neither call functions of users nor take long: a loop of nothing else need not look at every turn whether its
slice is over."""
QUICK_OF_TWO = {sym(name) for name in "FIND POSITION MEMBER ASSOC COUNT STRING= STRING/= STRING< STRING> EQUAL SLOT-VALUE".split()}
"""The same, if they are called with two arguments. Where an argument is long, they look by themselves whether the slice is over."""
CHANGES = {sym(name) for name in "VECTOR-PUSH VECTOR-PUSH-EXTEND".split()}
"""Functions that are as quick, but change the length of a vector."""
SETTERS = {sym(name) for name in "GETHASH AREF SVREF CHAR SLOT-VALUE".split()}
"""Places whose setters are as quick, but change what a loop may walk along."""


@dataclass
class Loop:
    """Segments ``first`` to ``last`` are repeated; ``left_early``: the segments before them may go behind the loop."""

    first: int
    last: int
    left_early: bool


def loop_of(node):
    """The `Loop` of a ``TagbodyNode``, with ``first`` ``None`` when it only goes forward; ``None`` for another shape."""
    jumps = []
    for index, segment in enumerate(node.segments):
        for item in walk(segment):
            if item.__class__ is nodes.Go and item.tagbody is node.tagbody:
                jumps.append((index, item.index))
    backward = {target for source, target in jumps if target <= source}
    if len(backward) > 1:
        return None
    if not backward:
        targets = {target for _, target in jumps}
        if len(targets) != 1:
            return None
        target = targets.pop()
        return Loop(None, target - 1, True)
    first = backward.pop()
    last = max(source for source, target in jumps if target == first and target <= source)
    early = False
    for source, target in jumps:
        if target == first and first <= source <= last:
            continue
        if target != last + 1 or source > last:
            return None
        early = early or source < first
    return Loop(first, last, early)


FIXNUM = sym("FIXNUM")


@dataclass
class Counting:
    """``variable`` goes from its value by ``step`` to ``limit``, a node; ``body`` is what is left to do in each turn."""

    variable: object
    limit: object
    step: int
    inclusive: bool
    body: list
    vector: object = None
    element: object = None


def counting(statements, tagbody, first, end, scope):
    """The `Counting` that the repeated ``statements`` are, or ``None``."""
    if len(statements) < 3 or not _goes(statements[-1], tagbody, first) or not _quick(statements):
        return None
    head, body = statements[0], statements[1:-1]
    if head.__class__ is not nodes.If or not _goes(head.then, tagbody, end) or head.otherwise.__class__ is not nodes.Constant:
        return None
    test = head.test
    if test.__class__ is not nodes.Call or test.symbol not in LIMITS or len(test.arguments) != 2:
        return None
    counter, limit = test.arguments
    direction, inclusive = LIMITS[test.symbol]
    if counter.__class__ is not nodes.LocalVariable:
        return None
    variable = counter.variable
    if variable.captured or variable.writes != 1 or variable.owner is not scope:
        return None
    step = None
    for index, statement in enumerate(body):
        if statement.__class__ is nodes.SetLocal and statement.variable is variable:
            step = _step(statement.value, variable)
            after = body[index + 1 :]
            body = body[:index] + after
            break
    if step is None or step * direction <= 0 or _reads(after, variable) or _reads(statements, variable) != variable.reads:
        return None
    if any(item.__class__ is nodes.Go and item.tagbody is tagbody and item.index == first for item in walk(body)):
        return None
    if limit.__class__ is nodes.Call and limit.symbol is LENGTH:
        return _across(variable, limit, step, inclusive, body, scope)
    if not _settled(limit):
        return None
    if _reads(body, variable) and variable.kind != INT:
        return None
    return Counting(variable, limit, step, inclusive, body)


def _across(variable, limit, step, inclusive, body, scope):
    """``(>= index (length vector))`` ends the loop, and ``index`` occurs in ``(setq element (aref vector index))`` only."""
    vector = limit.arguments[0] if len(limit.arguments) == 1 else None
    if any(item.__class__ is nodes.CallSetf or item.__class__ is nodes.Call and item.symbol in CHANGES for item in walk(body)):
        return None
    if vector.__class__ is not nodes.LocalVariable or not _settled(vector) or step != 1 or inclusive or not body or variable.reads != 3:
        return None
    setting = body[0]
    if setting.__class__ is not nodes.SetLocal or setting.value.__class__ is not nodes.Call or setting.value.symbol is not AREF:
        return None
    arguments = setting.value.arguments
    element = setting.variable
    if len(arguments) != 2 or any(argument.__class__ is not nodes.LocalVariable for argument in arguments):
        return None
    if arguments[0].variable is not vector.variable or arguments[1].variable is not variable:
        return None
    if element.boxed or element.owner is not scope:
        return None
    return Counting(variable, limit, step, inclusive, body[1:], vector, element)


def _goes(node, tagbody, index):
    return node.__class__ is nodes.Go and node.tagbody is tagbody and node.index == index


def _step(value, variable):
    """The number that is added to ``variable``, or ``None``. Nobody counts beyond a fixnum, so the declaration of one needs no check."""
    if value.__class__ is nodes.Checked and value.type is FIXNUM:
        value = value.value
    if value.__class__ is not nodes.Call or value.symbol not in STEPS or not value.arguments:
        return None
    first, *others = value.arguments
    if first.__class__ is not nodes.LocalVariable or first.variable is not variable:
        return None
    if not others:
        return STEPS[value.symbol] if value.symbol.name in ("1+", "1-") else None
    amount = others[0]
    if len(others) == 1 and amount.__class__ is nodes.Constant and amount.value.__class__ is int and value.symbol.name in "+-":
        return STEPS[value.symbol] * amount.value
    return None


def _settled(node):
    """Whether a limit is the same in every turn."""
    if node.__class__ is nodes.Constant:
        return True
    return node.__class__ is nodes.LocalVariable and not node.variable.writes and not node.variable.boxed


def _reads(statements, variable):
    return sum(item.__class__ is nodes.LocalVariable and item.variable is variable for item in walk(statements))


_CALLS = (
    nodes.CallLocal,
    nodes.CallValue,
    nodes.CallSetf,
    nodes.CallSpread,
    nodes.Support,
    nodes.UnwindProtect,
    nodes.Catching,
    nodes.Handling,
    nodes.Each,
)


def _quick(statements):
    for item in walk(statements):
        kind = item.__class__
        if kind in _CALLS and not (kind is nodes.CallSetf and (item.symbol in SETTERS or written_attribute(item.symbol) is not None)):
            return False
        if kind is nodes.Call and item.symbol not in QUICK and item.symbol not in CHANGES:
            if (item.symbol not in QUICK_OF_TWO or len(item.arguments) != 2) and read_attribute(item.symbol) is None:
                return False
    return True


def quiet(node):
    """Whether evaluating ``node`` surely changes no variable: a simple expression of quick functions."""
    kind = node.__class__
    if kind is nodes.Call:
        return node.symbol in QUICK and all(map(quiet, node.arguments))
    return kind is nodes.Constant or kind is nodes.LocalVariable or kind is nodes.GlobalVariable
