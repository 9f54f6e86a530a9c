"""Terms that are nested deeper than Python recurses, and terms without end.

The functions of ``terms.py`` recurse along the elements of lists, which is quickest for terms as people write them. Where Python has no
stack left they come here: `rebuild` needs none. A variable that was unified with a term that contains it makes a term without end, for
there is no occurs check (prolog.md 2.4); who goes through very many cells, or has no stack left, asks `refuse_cycle` whether it is one.
"""

from __future__ import annotations

from cramhy_runtime.ground.conditions import StorageCondition, error
from cramhy_runtime.ground.data import Cons

CYCLE_SUSPECTED = 1_000_000
"""So many cells are gone through before it is asked whether they end."""


LIST_SUSPECTED = 200_000
"""So many elements of one list are gone through before it is asked whether it ends, which is quicker to find out."""
_ENDLESS = "A variable was unified with a list that contains it, which makes the list endless."


def refuse_endless(lst, contents):
    """Signal an error if following the rests of ``lst`` comes back. ``contents``: see `refuse_cycle`."""
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
    """Signal an error if ``term`` contains itself. ``contents(term)`` is what a term that is no cons stands for, or the term."""
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
    """``term`` with ``leaf(part)`` in place of each part that is no cons; unchanged conses are shared. A cycle is an error."""
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
