"""Terms that are nested deeper than Python recurses, and terms without end.

The functions of ``terms.py`` recurse along the elements of lists, which is quickest for terms as people write them. If Python has no
stack left, they call `rebuild`, which needs none. There is no occurs check (prolog.md 2.4), so a variable that is unified with a term
that contains it makes a term without end. Code that goes through very many cells, or has no stack left, calls `refuse_cycle` to find out.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import StorageCondition, error
from cramhy_runtime.lisp_core.data import Cons

CYCLE_SUSPECTED = 1_000_000
"""After so many cells, code asks whether they end."""


LIST_SUSPECTED = 200_000
"""After so many elements of one list, code asks whether the list ends, which is quicker to find out."""
_ENDLESS = "A variable was unified with a list that contains it, which makes the list endless."


def refuse_endless(lst, contents):
    """Signal an error if ``lst`` is circular. For ``contents`` see `refuse_cycle`."""
    slow, fast, both = lst, lst, False
    while True:
        fast = contents(fast.cdr) if fast.__class__ is Cons else contents(fast)
        if fast.__class__ is not Cons:
            return
        if both:
            slow = contents(slow.cdr) if slow.__class__ is Cons else contents(slow)
        both = not both
        if slow is fast:
            error(StorageCondition(_ENDLESS))


def refuse_cycle(term, contents):
    """Signal an error if ``term`` contains itself. ``contents(term)`` is the value of a term that is not a cons, or the term."""
    inside, done, waiting = set(), set(), [(term, False)]
    while waiting:
        item, leaving = waiting.pop()
        if leaving:
            inside.discard(id(item))
            done.add(id(item))
            continue
        if item.__class__ is not Cons:
            item = contents(item)
        if item.__class__ is not Cons or id(item) in done:
            continue
        if id(item) in inside:
            error(StorageCondition(_ENDLESS))
        inside.add(id(item))
        waiting += [(item, True), (item.cdr, False), (item.car, False)]


def rebuild(term, contents, leaf):
    """A copy of ``term`` with ``leaf(part)`` for each part that is not a cons. Unchanged conses are shared. A cycle is an error."""
    refuse_cycle(term, contents)
    results, waiting = [], [(term, False)]
    while waiting:
        item, built = waiting.pop()
        if built:
            cdr, car = results.pop(), results.pop()
            results.append(item if car is item.car and cdr is item.cdr else Cons(car, cdr))
            continue
        if item.__class__ is not Cons:
            item = contents(item)
        if item.__class__ is Cons:
            waiting += [(item, True), (item.cdr, False), (item.car, False)]
        else:
            results.append(leaf(item))
    return results[0]
