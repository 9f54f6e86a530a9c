"""``error`` in the form that a ``handler-case`` of the same function guards: if a clause fits, the code goes on there.

Rows of ``make bench`` without it, as times of the row with it: handler-case 1.8.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import sym

from ..core import NONE, word
from ..generator.exits import jump
from ..passes import JUMPS, enter, opens_call

ERROR = sym("ERROR")


@opens_call("errors", ERROR, effect=True)
def error_in_case(generator, node, destination):
    if not (generator.cases and generator.cases[-1][-1] is generator.scope and node.arguments):
        return None
    names, found, target, _ = generator.cases[-1]
    arguments = generator.arguments(node.arguments)
    generator.emit(word("setv"), found, generator.positioned(generator.call("error_in_case", *names, *arguments), node))
    jump(generator, target)
    return (NONE if destination.kind == "value" else None,)


@enter("errors")
def _jumps():
    JUMPS.add(ERROR)
