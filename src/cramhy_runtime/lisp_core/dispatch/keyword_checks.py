"""Which keywords a call of a generic function may have: those of all applicable methods together (ANSI 7.6.5)."""

from __future__ import annotations

from ..conditions import program_error
from ..data import list_from
from ..packages import keyword

ALLOW_OTHER_KEYS = keyword("ALLOW-OTHER-KEYS")


def checking_keys(generic_function, effective, methods):
    """``effective``, behind a test that the call has no keywords but those of ``methods`` (ANSI 7.6.5)."""
    shapes = [generic_function.shape, *(method.shape for method in methods)]
    others_allowed = any(shape.allow_other_keys for shape in shapes)
    allowed = list(dict.fromkeys(key for shape in shapes for key in shape.keys))
    first = generic_function.shape.required + generic_function.shape.optional

    def check(*arguments, **keywords):
        if len(arguments) > first:
            given = arguments[first:]
            if len(given) % 2:
                return program_error("odd number of &KEY arguments")
            for key in given[::2]:
                if not others_allowed and key not in allowed and key is not ALLOW_OTHER_KEYS and not other_keys_allowed(given):
                    return program_error("invalid keyword argument: ~S (valid keys are ~{~S~^, ~}).", key, list_from(allowed))
        return effective(*arguments, **keywords)

    return check


def other_keys_allowed(given):
    """Whether keyword arguments, key by key, hold a true ``:allow-other-keys``; the first one counts."""
    for index in range(0, len(given), 2):
        if given[index] is ALLOW_OTHER_KEYS:
            return given[index + 1] is not None
    return False
