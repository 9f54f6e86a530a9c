"""Random numbers: ``random``, ``*random-state*``, and the seed of the session.

The generator is the Mersenne twister with the seeding and the way of drawing numbers that SBCL has, so a plan that throws dice
sees in a fresh session the numbers that it sees on the original: ``(random 255)`` is 92 first. (Integers of 63 bits and more
are drawn otherwise.) Law: same seed, same run.
`seed_random` is called by the session for ``--seed``. Source: ANSI 12.1.7; Matsumoto and Nishimura 1998 (MT19937).
"""

from __future__ import annotations

import functools
import random as python_random

from cramhy_runtime.lisp_core.conditions import SimpleTypeError, error, type_error
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import sym
from .arithmetic import is_integer

LISP_NAMES = "random make-random-state random-state-p"
EXTENSION_NAMES = "seed-random-state"
"""Names of the package SB-EXT."""

DEFAULT_SEED = 5489


class RandomState:
    """The state of the generator: 32 bits at a time."""

    lisp_name = "RANDOM-STATE"

    def __init__(self, seed=DEFAULT_SEED):
        self._source = python_random.Random()
        self._source.setstate((3, (*_initial_words(seed), 624), None))

    def chunk(self):
        """The next 32 random bits."""
        return self._source.getrandbits(32)

    def copy(self):
        other = RandomState.__new__(RandomState)
        other._source = python_random.Random()
        other._source.setstate(self._source.getstate())
        return other

    def words(self):
        """The state as SBCL keeps it: 0, the constant of the twister, which word is next, and the 624 words."""
        *state, place = self._source.getstate()[1]
        return [0, _TWIST, place, *state]

    def __repr__(self):
        return "#<RANDOM-STATE>"


_TWIST = 2567483615


def restored_state(slot=None, words=None):
    """The `RandomState` that prints as ``#S(RANDOM-STATE :STATE words)``: what ``#S`` makes of it.

    slot: the keyword :STATE; words: a vector, as `RandomState.words` gives them. Errors: a type-error, where they are not a state.
    """
    numbers = list(words) if hasattr(words, "__iter__") and not isinstance(words, str) else []
    if slot is not sym(":STATE") or len(numbers) != 627 or numbers[1] != _TWIST:
        return type_error(words, "(SIMPLE-ARRAY (UNSIGNED-BYTE 32) (627))")
    state = RandomState.__new__(RandomState)
    state._source = python_random.Random()
    try:
        state._source.setstate((3, (*numbers[3:], numbers[2]), None))
    except (ValueError, TypeError, OverflowError):
        return type_error(words, "(SIMPLE-ARRAY (UNSIGNED-BYTE 32) (627))")
    return state


@functools.lru_cache(maxsize=1)  # each session begins with the same seed
def _initial_words(seed):
    word = seed & 0xFFFFFFFF
    words = [word]
    for index in range(1, 624):
        word = (1812433253 * (word ^ word >> 30) + index) & 0xFFFFFFFF
        words.append(word)
    return tuple(words)


RANDOM_STATE = special("*RANDOM-STATE*", RandomState())


def seed_random(seed=None):
    """Start the numbers of ``*random-state*`` anew from ``seed``, an integer; ``None`` is the seed of a fresh session."""
    RANDOM_STATE.value = RandomState(DEFAULT_SEED if seed is None else seed)


def random(limit, state=None):
    """A random number from 0 to below ``limit``, of the kind of ``limit``: an integer, single-float or double-float."""
    state = RANDOM_STATE.value if state is None else state
    if state.__class__ is not RandomState:
        return type_error(state, sym("RANDOM-STATE"))
    if is_integer(limit) and limit > 0:
        return _integer(limit, state)
    if isinstance(limit, float) and limit > 0:
        return _single(limit, state) if limit.__class__ is SingleFloat else _double(limit, state)
    return error(
        SimpleTypeError(
            "Argument is neither a positive integer nor a positive float:~%  ~S",
            limit,
            datum=limit,
            expected_type="(OR (INTEGER 1) (FLOAT (0)))",
        )
    )


def _integer(limit, state):
    # Equal chances without division: mask to the bits needed, and draw again when the number is too large.
    bits = (limit - 1).bit_length()
    if not bits:
        return 0
    mask = (1 << bits) - 1
    while True:
        number = state.chunk()
        for _ in range((bits - 1) // 32):
            number = number << 32 | state.chunk()
        number &= mask
        if number < limit:
            return number


def _single(limit, state):
    while True:
        number = limit * SingleFloat((state.chunk() >> 8 & 0x7FFFFF) * 2.0**-23)
        if number != limit:
            return number


def _double(limit, state):
    while True:
        high = state.chunk() >> 11 & 0xFFFFF
        number = float(limit) * ((high << 32 | state.chunk()) * 2.0**-52)
        if number != limit:
            return number


def make_random_state(state=None):
    """A copy of ``state`` or, for nil, of ``*random-state*``; for t a state seeded from the current one.

    The standard asks for a "truly random" state for t. That would make two runs with the same seed differ, so it is drawn
    from the generator of the session (law 5).
    """
    if state is True:
        return RandomState(RANDOM_STATE.value.chunk())
    state = RANDOM_STATE.value if state is None else state
    return state.copy() if isinstance(state, RandomState) else type_error(state, "(OR RANDOM-STATE BOOLEAN)")


def seed_random_state(seed=0):
    """``sb-ext:seed-random-state``: the state for the integer ``seed``."""
    if seed is True:
        return make_random_state(True)
    return RandomState(seed) if is_integer(seed) else type_error(seed, sym("UNSIGNED-BYTE"))


def random_state_p(object):
    return True if isinstance(object, RandomState) else None
