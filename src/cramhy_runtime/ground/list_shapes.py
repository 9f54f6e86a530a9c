"""Whether a list has as many elements as a destructuring lambda list wants, with SBCL's text for what is wrong."""

from __future__ import annotations

from .condition_types import SimpleProgramError
from .conditions import error
from .data import conses
from .ports import PORTS


def check_shape(lst, least, most, what, lambda_list):
    """Check that ``lst`` has ``least`` to ``most`` elements (no upper bound: nil); returns it."""
    count, cell = 0, lst
    for each in conses(lst):
        count, cell = count + 1, each.cdr
    improper = cell is not None and not (most is None and count >= least)
    if improper or count < least or (most is not None and count > most):
        wanted = f"exactly {least}" if least == most else f"at least {least}" if most is None else f"between {least} and {most}"
        kind = "invalid number of" if improper else "too few" if count < least else "too many"
        condition = SimpleProgramError(
            "Error while parsing arguments to ~A:~%  ~A elements in~%    ~:S~%  to satisfy lambda list~%    "
            "~:S:~%  ~A expected, but got ~A",
            what,
            kind,
            lst,
            lambda_list,
            wanted,
            "a non-list" if improper else count,
        )
        if what.startswith(("DEFMACRO", "MACROLET")):
            condition.position = PORTS.definitions.expansion_place()  # the call is wrong, not the macro
        return error(condition)
    return lst
