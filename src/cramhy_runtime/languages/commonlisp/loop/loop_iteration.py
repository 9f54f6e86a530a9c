"""Clauses that drive a loop: for, as, repeat; and with, which only binds.

Each ``for`` clause gives an `Iteration`: bindings, and what to test and set before the first turn and before the others.
Clauses joined by ``and`` make one group, whose bindings and settings are done in parallel. Any variable may be a pattern of
variables, with nil where a part is not wanted.
"""

from __future__ import annotations

from cramhy_runtime.utilities.records import dataclass, field

from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from
from ..syntax.lambda_lists import gensym
from cramhy_runtime.lisp_core.packages import is_symbol, sym, symbol_name
from .loop_support import CAR_OF_CONS, CDR_OF_CONS, END_LOOP, LOOP_SYMBOLS, LOOP_VECTOR, TABLE_ENTRIES
from .loop_tokens import zero

IF, GO, LET, SETQ, PSETQ, FUNCTION, OR = map(sym, "IF GO LET SETQ PSETQ FUNCTION OR".split())
CAR, CDR, ENDP, ATOM, AREF, LENGTH, FUNCALL, PACKAGE = map(sym, "CAR CDR ENDP ATOM AREF LENGTH FUNCALL *PACKAGE*".split())
PLUS, MINUS, GREATER, LESS, AT_LEAST, AT_MOST = map(sym, "+ - > < >= <=".split())


@dataclass
class Turn:
    """What happens before a turn: tests that end the loop, settings (pattern, form), tests, settings of hidden variables."""

    before: list = field(default_factory=list)
    settings: list = field(default_factory=list)
    after: list = field(default_factory=list)
    hidden: list = field(default_factory=list)


@dataclass
class Iteration:
    """One ``for`` clause: bindings (pattern, form), the first turn, and the others; ``other`` ``None``: as the first."""

    bindings: list
    first: Turn
    other: Turn = None


# --------------------------------------------------------------------------------------------------------------- patterns


def pattern_variables(loop, pattern):
    """The variables of a pattern."""
    found, pending = [], [pattern]
    while pending:
        item = pending.pop()
        if isinstance(item, Cons):
            pending += [item.cdr, item.car]
        elif item is not None:
            if not is_symbol(item) or item is True or getattr(item, "constant", False):
                loop.tokens.fail("~S cannot be used as a variable.", item)
            found.append(item)
    return found


def pattern_settings(pattern, form):
    """Pairs (variable, form) to be set one after the other so that ``pattern`` matches the value of the pure ``form``."""
    if pattern is None:
        return []
    if not isinstance(pattern, Cons):
        return [(pattern, form)]
    return pattern_settings(pattern.car, lisp_list(CAR, form)) + pattern_settings(pattern.cdr, lisp_list(CDR, form))


def set_form(settings):
    """Form that sets patterns to the values of forms, in parallel when there are several."""
    settings = [(pattern, form) for pattern, form in settings if pattern is not None or isinstance(form, Cons)]
    if not settings:
        return None
    if all(is_symbol(pattern) and pattern is not None for pattern, _ in settings):
        operator = SETQ if len(settings) == 1 else PSETQ
        return Cons(operator, list_from([item for pair in settings for item in pair]))
    values = [gensym("VALUE") for _ in settings]
    pairs = [pair for (pattern, _), value in zip(settings, values) for pair in pattern_settings(pattern, value)]
    body = Cons(SETQ, list_from([item for pair in pairs for item in pair])) if pairs else None
    return lisp_list(LET, list_from([lisp_list(value, form) for value, (_, form) in zip(values, settings)]), body)


def bind_patterns(loop, bindings):
    """Bind patterns to the values of forms in parallel, then their parts."""
    direct, parts = [], []
    for pattern, form in bindings:
        if isinstance(pattern, Cons):
            value = gensym("VALUE")
            direct.append((value, form))
            pattern_variables(loop, pattern)
            parts += pattern_settings(pattern, value)
        else:
            pattern_variables(loop, pattern)
            direct.append((gensym("IGNORED") if pattern is None else pattern, form))
    loop.bind(direct)
    for part in parts:
        loop.bind([part])


# ----------------------------------------------------------------------------------------------------------- with, repeat


def with_clause(loop):
    """``with var [type] [= form] {and ...}``."""
    tokens = loop.tokens
    bindings = []
    while True:
        pattern = tokens.take()
        declared = tokens.type_specifier()
        if tokens.next_is("="):
            tokens.take()
            bindings.append((pattern, tokens.form()))
        else:
            bindings += zeros(loop, pattern, declared)
        if not tokens.next_is("AND"):
            break
        tokens.take()
    bind_patterns(loop, bindings)


def zeros(loop, pattern, declared):
    """Pairs of a variable of ``pattern`` and its first value. The type ``declared`` is one for all, or a tree of types like the pattern."""
    if isinstance(pattern, Cons) and isinstance(declared, Cons) and not _is_compound_type(declared):
        return [*zeros(loop, pattern.car, declared.car), *zeros(loop, pattern.cdr, declared.cdr)]
    return [(variable, zero(declared)) for variable in pattern_variables(loop, pattern)]


def _is_compound_type(specifier):
    return is_symbol(specifier.car) and symbol_name(specifier.car) in COMPOUND_TYPES


COMPOUND_TYPES = "AND OR NOT MEMBER EQL SATISFIES INTEGER MOD UNSIGNED-BYTE SIGNED-BYTE RATIONAL REAL CONS ARRAY VECTOR STRING".split()


def repeat_clause(loop):
    """``repeat form``: so many turns."""
    count = loop.temporary("COUNT", loop.tokens.form())
    turn = Turn(before=[lisp_list(AT_MOST, count, 0)], hidden=[(count, lisp_list(MINUS, count, 1))])
    add_turns(loop, [Iteration([], turn)])


# -------------------------------------------------------------------------------------------------------------------- for


def for_clause(loop, keyword):
    """``for var [type] in/on/across/=/from/being ... {and var ...}``."""
    tokens = loop.tokens
    iterations = []
    while True:
        pattern = tokens.take()
        variables = pattern_variables(loop, pattern)
        declared = tokens.type_specifier()
        word = tokens.keyword("LOOP keyword or LOOP type keyword")
        reader = _READERS.get(word)
        if reader is None:
            tokens.fail(
                "~A is an unknown keyword in FOR or AS clause in LOOP.",
                word,
                hint="After AND the next variable follows directly, without FOR."
                if _is_for(pattern) and iterations
                else "After the variable comes IN, ON, ACROSS, =, FROM or BEING.",
            )
        iterations.append((variables, reader(loop, pattern, declared, word)))
        if not tokens.next_is("AND"):
            break
        tokens.take()
    _bind(loop, iterations)
    add_turns(loop, [iteration for _, iteration in iterations])


def _is_for(pattern):
    return is_symbol(pattern) and symbol_name(pattern) in ("FOR", "AS")


def _bind(loop, iterations):
    """Bind hidden and numeric variables to their forms, and the other variables to nil."""
    # all at once: the forms of a clause do not see its own variables
    bind_patterns(loop, [binding for _, iteration in iterations for binding in iteration.bindings])
    for variables, iteration in iterations:
        bound = {binding[0] for binding in iteration.bindings if not isinstance(binding[0], Cons)}
        for variable in variables:
            if variable not in bound:
                loop.bind([(variable, None)])


def add_turns(loop, iterations):
    """Append tests and settings of a group of clauses to the loop."""
    first = _turn_forms([iteration.first for iteration in iterations])
    if all(iteration.other is None for iteration in iterations):
        loop.first += first
        loop.next += first
        return
    others = _turn_forms([iteration.other or iteration.first for iteration in iterations])
    # equal tails are made the same objects, so that the loop holds them once
    for index in range(1, min(len(first), len(others)) + 1):
        if not _same(first[-index], others[-index]):
            break
        first[-index] = others[-index]
    loop.first += first
    loop.next += others


def _turn_forms(turns):
    forms = []
    for tests, settings in (("before", "settings"), ("after", "hidden")):
        test = [form for turn in turns for form in getattr(turn, tests)]
        if test:
            forms.append(lisp_list(IF, test[0] if len(test) == 1 else Cons(OR, list_from(test)), lisp_list(GO, END_LOOP), None))
        setting = set_form([pair for turn in turns for pair in getattr(turn, settings)])
        if setting is not None:
            forms.append(setting)
    return forms


def _same(one, other):
    while isinstance(one, Cons) and isinstance(other, Cons):
        if not _same(one.car, other.car):
            return False
        one, other = one.cdr, other.cdr
    return one is other or (one.__class__ is other.__class__ and isinstance(one, (int, float)) and one == other)


def _step_call(step, form):
    """The form that applies the ``by`` function ``step``."""
    if isinstance(step, Cons) and step.car is FUNCTION and is_symbol(step.cdr.car):
        return lisp_list(step.cdr.car, form)
    return lisp_list(FUNCALL, step, form)


def _by(loop, bindings):
    """The step of ``in`` and ``on``: a function form, evaluated once unless it is ``#'name``."""
    tokens = loop.tokens
    if not tokens.next_is("BY"):
        return lisp_list(FUNCTION, CDR)
    tokens.take()
    form = tokens.form()
    if isinstance(form, Cons) and form.car is FUNCTION and isinstance(form.cdr, Cons) and is_symbol(form.cdr.car):
        return form
    step = gensym("STEP")
    bindings.append((step, form))
    return step


def _for_in(loop, pattern, declared, word):
    rest = gensym("LIST")
    bindings = [(rest, loop.tokens.form())]
    step = _by(loop, bindings)
    move = lisp_list(CDR_OF_CONS, rest) if isinstance(step, Cons) and step.cdr.car is CDR else _step_call(step, rest)
    return Iteration(
        bindings, Turn(before=[lisp_list(ENDP, rest)], settings=[(pattern, lisp_list(CAR_OF_CONS, rest))], hidden=[(rest, move)])
    )


def _for_on(loop, pattern, declared, word):
    rest = gensym("LIST")
    bindings = [(rest, loop.tokens.form())]
    step = _by(loop, bindings)
    return Iteration(bindings, Turn(before=[lisp_list(ATOM, rest)], settings=[(pattern, rest)], hidden=[(rest, _step_call(step, rest))]))


def _for_across(loop, pattern, declared, word):
    return _across(pattern, loop.tokens.form())


def _across(pattern, form):
    vector, index = gensym("VECTOR"), gensym("INDEX")
    bindings = [(vector, lisp_list(LOOP_VECTOR, form)), (index, 0)]
    return Iteration(
        bindings,
        Turn(
            before=[lisp_list(AT_LEAST, index, lisp_list(LENGTH, vector))],
            settings=[(pattern, lisp_list(AREF, vector, index))],
            hidden=[(index, lisp_list(PLUS, index, 1))],
        ),
    )


def _for_equals(loop, pattern, declared, word):
    tokens = loop.tokens
    first = tokens.form()
    bindings = [(variable, zero(declared)) for variable in pattern_variables(loop, pattern)]
    if not tokens.next_is("THEN"):
        return Iteration(bindings, Turn(settings=[(pattern, first)]))
    tokens.take()
    return Iteration(bindings, Turn(settings=[(pattern, first)]), Turn(settings=[(pattern, tokens.form())]))


def _for_numbers(loop, pattern, declared, word):
    """``from``, ``upfrom``, ``downfrom``, ``to``, ``upto``, ``downto``, ``below``, ``above``, ``by``, in any order."""
    tokens = loop.tokens
    if not is_symbol(pattern):
        tokens.fail("destructuring is not allowed in a FOR clause that counts: ~S", pattern)
    variable = gensym("NUMBER") if pattern is None else pattern
    bindings, down, limit, exclusive, step = [], False, None, False, 1
    seen = set()
    while True:
        form = tokens.form()
        part = "start" if word.endswith("FROM") else "step" if word == "BY" else "limit"
        if part in seen:
            tokens.fail("~A is given twice in a FOR clause.", {"start": "The start", "step": "BY", "limit": "The limit"}[part])
        seen.add(part)
        down = down or word in ("DOWNFROM", "DOWNTO", "ABOVE")
        if part == "start":
            bindings.append((variable, form))
        else:
            if not isinstance(form, (int, float)):
                value = gensym(part.upper())
                bindings.append((value, form))
                form = value
            if part == "limit":
                limit, exclusive = form, word in ("BELOW", "ABOVE")
            else:
                step = form
        if not tokens.next_is(*_NUMBER_WORDS):
            break
        word = symbol_name(tokens.take())
    if "start" not in seen:
        if down:
            tokens.fail("don't know where to start stepping", hint="Counting down needs FROM.")
        bindings.append((variable, 0 if zero(declared) is None else zero(declared)))
    test = []
    if limit is not None:
        comparison = (AT_MOST if exclusive else LESS) if down else (AT_LEAST if exclusive else GREATER)
        test = [lisp_list(comparison, variable, limit)]
    stepped = lisp_list(MINUS if down else PLUS, variable, step)
    return Iteration(bindings, Turn(after=test), Turn(settings=[(variable, stepped)], after=list(test)))


def _for_being(loop, pattern, declared, word):
    """``being {each | the} hash-key/hash-value/symbol ... {of | in} ... [using (...)]``."""
    tokens = loop.tokens
    if tokens.next_is("EACH", "THE"):
        tokens.take()
    kind = tokens.keyword("iteration path name")
    kind += "" if kind.endswith("S") else "S"
    if kind == "ELEMENTS" and tokens.next_is("OF", "IN"):  # of a sequence, as in SBCL
        tokens.take()
        return _across(pattern, lisp_list(sym("COERCE"), tokens.form(), lisp_list(sym("QUOTE"), sym("VECTOR"))))
    if kind not in ("HASH-KEYS", "HASH-VALUES", "SYMBOLS", "PRESENT-SYMBOLS", "EXTERNAL-SYMBOLS"):
        tokens.fail(
            "~A is not the name of a LOOP iteration path.",
            kind[:-1],
            hint="There are HASH-KEYS, HASH-VALUES, SYMBOLS, PRESENT-SYMBOLS and EXTERNAL-SYMBOLS.",
        )
    source, other = None, None
    while tokens.next_is("OF", "IN", "USING"):
        if symbol_name(tokens.take()) == "USING":
            other = tokens.form()
            if not (isinstance(other, Cons) and isinstance(other.cdr, Cons) and kind.startswith("HASH")):
                tokens.fail("bad format for USING: ~S", other, hint="It is written USING (HASH-VALUE variable).")
        else:
            source = (tokens.form(),)
    rest = gensym("ENTRIES")
    test, move = lisp_list(ATOM, rest), [(rest, lisp_list(CDR, rest))]
    if kind.startswith("HASH"):
        if source is None:
            tokens.fail("The hash table is missing.", hint="It is written BEING THE HASH-KEYS OF table.")
        part, opposite = (CAR, CDR) if kind == "HASH-KEYS" else (CDR, CAR)
        entry = lisp_list(CAR, rest)
        settings = [(pattern, lisp_list(part, entry))]
        if other is not None:
            variable = other.cdr.car
            settings.append((variable, lisp_list(opposite, entry)))
            for each in pattern_variables(loop, variable):
                loop.bind([(each, None)])
        return Iteration([(rest, lisp_list(TABLE_ENTRIES, source[0]))], Turn(before=[test], settings=settings, hidden=move))
    symbols = lisp_list(LOOP_SYMBOLS, kind, source[0] if source else PACKAGE)
    return Iteration([(rest, symbols)], Turn(before=[test], settings=[(pattern, lisp_list(CAR, rest))], hidden=move))


_NUMBER_WORDS = ("FROM", "UPFROM", "DOWNFROM", "TO", "UPTO", "DOWNTO", "BELOW", "ABOVE", "BY")
_READERS = {
    "IN": _for_in,
    "ON": _for_on,
    "ACROSS": _for_across,
    "=": _for_equals,
    "BEING": _for_being,
    **dict.fromkeys(_NUMBER_WORDS, _for_numbers),
}
