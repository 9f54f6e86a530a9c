"""The variables that control the printer, and the two things it counts: depth and shared objects.

``*print-level*`` needs to know how deep the printer is, ``*print-circle*`` which objects it has met. Both counts are
kept in specials of our own, because a print function is user code: it may be preempted while another task prints.
They are bound only when the control variable asks for it. Source: ANSI 22.1; the search for circles is SBCL's
(``src/code/print.lisp``), which walks the object once into nowhere and marks what it meets twice.
"""

from __future__ import annotations

from fractions import Fraction

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Character, Symbol
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.printing import CURRENT_LEVEL, LEVELS_COUNT
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, keyword


UPCASE, DOWNCASE, CAPITALIZE = keyword("UPCASE"), keyword("DOWNCASE"), keyword("CAPITALIZE")

PRINT_ESCAPE = special("*PRINT-ESCAPE*", True)
PRINT_READABLY = special("*PRINT-READABLY*", None)
PRINT_BASE = special("*PRINT-BASE*", 10)
PRINT_RADIX = special("*PRINT-RADIX*", None)
PRINT_CASE = special("*PRINT-CASE*", UPCASE)
PRINT_CIRCLE = special("*PRINT-CIRCLE*", None)
PRINT_LENGTH = special("*PRINT-LENGTH*", None)
PRINT_LEVEL = special("*PRINT-LEVEL*", None)
PRINT_PRETTY = special("*PRINT-PRETTY*", True)
PRINT_RIGHT_MARGIN = special("*PRINT-RIGHT-MARGIN*", None)
PRINT_LINES = special("*PRINT-LINES*", None)
PRINT_MISER_WIDTH = special("*PRINT-MISER-WIDTH*", None)
PRINT_GENSYM = special("*PRINT-GENSYM*", True)
PRINT_ARRAY = special("*PRINT-ARRAY*", True)
PACKAGE = special("*PACKAGE*", COMMON_LISP_USER)

LEVEL = CURRENT_LEVEL
CIRCULARITY = special(Symbol("*CIRCULARITY*"), None)


class _Rebound:
    """What `bound` does where no kernel runs: one thread, so saving and restoring is all."""

    def __init__(self, pairs):
        self.pairs = [(pairs[index], pairs[index + 1]) for index in range(0, len(pairs), 2)]

    def __enter__(self):
        self.saved = [(symbol, symbol.value) for symbol, _ in self.pairs]
        for symbol, value in self.pairs:
            symbol.value = value

    def __exit__(self, *exc):
        for symbol, value in reversed(self.saved):
            symbol.value = value


def bound(*pairs):
    """``with bound(symbol, value, ...):`` as `dynamic.binding`, also when no kernel runs: Python code may print any
    time.
    """
    return binding(*pairs) if kernel.active() is not None else _Rebound(pairs)


class _Nothing:
    def __enter__(self):
        pass

    def __exit__(self, *exc):
        pass


_NOTHING = _Nothing()


def too_deep(stream):
    """Whether ``*print-level*`` forbids going deeper; then ``#`` has been printed in place of the object."""
    limit = PRINT_LEVEL.value
    if limit is not None and not isinstance(limit, int):
        type_error(limit, "(OR UNSIGNED-BYTE NULL)")
    if limit is not None and PRINT_READABLY.value is None and LEVEL.value >= limit:
        stream.write("#")
        return True
    return False


def deeper():
    """``with deeper():`` prints components, one level down."""
    return _NOTHING if PRINT_LEVEL.value is None and LEVELS_COUNT.value is None else bound(LEVEL, LEVEL.value + 1)


def length_limit():
    """``*print-length*``, or infinity."""
    limit = PRINT_LENGTH.value
    if limit is None or PRINT_READABLY.value is not None:
        return float("inf")
    return limit if isinstance(limit, int) else type_error(limit, "(OR UNSIGNED-BYTE NULL)")


# ---------------------------------------------------------------------------------------------------------- circularity

SEEN, BLOCK, BLOCK_CIRCULAR = "seen", "block", "block circular"
LOOK, ASSIGN = False, True
INITIATE = "initiate"


class Circularity:
    """What was met: object identity → mark. ``counter`` is ``None`` while looking, then the last label's number."""

    def __init__(self):
        self.marks = {}
        self.alive = []
        self.counter = None


def identified_by_print(obj):
    """Whether the printed form of ``obj`` alone tells which object it is, so that it needs no label."""
    if obj is None or obj is True or isinstance(obj, (int, float, complex, Fraction, Character)):
        return True
    return isinstance(obj, Symbol) and obj.package is not None


def check_circularity(obj, assign=LOOK, in_block=False):
    """The mark to print ``obj`` with: ``None`` for none, ``True`` for "met before while looking", a number for
    ``#n=``, a negative number for ``#n#``, `INITIATE` when looking has not begun. Source: SBCL's
    CHECK-FOR-CIRCULARITY.
    """
    if PRINT_CIRCLE.value is None:
        return None
    state = CIRCULARITY.value
    if state is None:
        return INITIATE
    marks, key = state.marks, id(obj)
    mark = marks.get(key)
    if state.counter is None:
        if mark is None:
            marks[key] = BLOCK if in_block else SEEN
            state.alive.append(obj)
            return None
        if mark is BLOCK:
            marks[key] = BLOCK_CIRCULAR
            return True
        if mark is SEEN and in_block:
            marks[key] = BLOCK
            return None
        if mark is SEEN:
            marks[key] = 0
        return True
    if mark is None or mark is SEEN or mark is BLOCK:
        return None
    if mark is BLOCK_CIRCULAR:
        if in_block and assign:
            return _label(state, key)
        return True if in_block else None
    if mark == 0:
        return _label(state, key) if assign and not in_block else True
    return -mark


def _label(state, key):
    state.counter += 1
    state.marks[key] = state.counter
    return state.counter


def print_mark(mark, stream):
    """Print the label or reference for ``mark``; whether the object itself is to be printed after it."""
    if mark is True:
        return False
    if mark < 0:
        stream.write(f"#{-mark}#")
        return False
    stream.write(f"#{mark}=")
    return True
