"""Occasions: goals that hold in the world. Any predicate can be an occasion.

``holds`` is a predicate of Prolog and a generic function. With one argument, an occasion, the predicate is about the present; with two,
the occasion and a time (``time_terms.py``), about a time in the current episode. Other packages extend it by clauses, some with three
arguments, the timeline first. The function asks the predicate. Source: projection-and-events.md B2.

Repaired: with a time, the function asks the clauses of two arguments, too; the original asks only those of three, and has none.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group
from ..prolog.query import prolog
from cramhy_runtime.prolog.builtins.rete import clear_alpha_network, match_fact, rete_assert, rete_holds, rete_retract
from ..utilities.lazy_lists import force_ll
from ..utilities.patterns import ANONYMOUS
from ..utilities.small_functions import deprecate
from .events import clear_belief
from .symbols import sym

HOLDS, OCCASION = sym("CRAM-OCCASIONS-EVENTS::HOLDS"), sym("CRAM-OCCASIONS-EVENTS::?OCCASION")

define_fact_group(
    sym("CRAM-OCCASIONS-EVENTS::OCCASIONS"), [HOLDS], [lisp_list(lisp_list(HOLDS, OCCASION), lisp_list(sym("CRAM-PROLOG::CALL"), OCCASION))]
)

holds = generic(
    "CRAM-OCCASIONS-EVENTS::HOLDS",
    "(occasion &optional time-specification)",
    documentation="""
The lazy list of the binding lists under which ``occasion`` holds, now or at a time such as ``(at 5.0d0)``.""",
)


@holds.method(object)
def _holds(occasion, time_specification=None):
    if time_specification is None:
        return prolog(lisp_list(HOLDS, occasion))
    return prolog(
        lisp_list(sym("OR"), lisp_list(HOLDS, occasion, time_specification), lisp_list(HOLDS, ANONYMOUS, occasion, time_specification))
    )


# ------------------------------------------------------------------------------------------------------- deprecated functions

_asserted = per_image([])  # the occasions that assert_occasion remembers


def assert_occasion(occasion):
    """Deprecated: assert ``occasion`` as a fact in the rete memory."""
    deprecate("ASSERT-OCCASION is deprecated.")
    _asserted.append(occasion)
    rete_assert(occasion)


def retract_occasion(occasion):
    """Deprecated: retract the asserted occasions that match the pattern ``occasion``."""
    deprecate("RETRACT-OCCASION is deprecated.")
    for fact in list(_asserted):
        if match_fact(occasion, fact, {}) is not None:
            _asserted.remove(fact)
            if rete_holds(fact) is not None:  # somebody may have retracted it, or cleared the memory
                rete_retract(fact)


def holds_occasion(occasion):
    """Deprecated: the list of the bindings under which ``occasion`` is a fact of the rete memory."""
    deprecate("HOLDS-OCCASION is deprecated.")
    return force_ll(rete_holds(occasion))


def _forget_occasions():
    _asserted.clear()
    clear_alpha_network()


clear_belief.add(_forget_occasions, "OCCASIONS", user=False)
