"""Lists as sets, association lists, property lists and trees.

These are the small data bases of Lisp programs: ``member`` and ``assoc`` look an element up, ``union`` and its relatives treat
a list as a set, ``getf`` and ``get`` keep properties, ``subst`` and ``sublis`` rewrite trees. All of them compare with ``eql``
unless ``:test`` says otherwise; the default is a quick loop.

Law: the order of the elements in a result is that of SBCL, because programs come to depend on it even where the standard
leaves it open. Source: ANSI 14.2; checked against SBCL.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import SimpleTypeError
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import STRETCH, UNSUPPLIED, Cons, MultipleValues, Symbol, list_from
from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.lisp_core.equality import EQUAL_TO_THEMSELVES, eql
from cramhy_runtime.lisp_core.functions import equal_to, key_of, match_of, predicate_of, test_of
from cramhy_runtime.lisp_core.packages import is_symbol, redefined
from .lists import items_of, not_a_list
from .sequence_types import in_turns

LISP_NAMES = """
member member-if member-if-not assoc assoc-if assoc-if-not rassoc rassoc-if rassoc-if-not
adjoin union nunion intersection nintersection set-difference nset-difference set-exclusive-or nset-exclusive-or subsetp
subst subst-if subst-if-not nsubst nsubst-if nsubst-if-not sublis nsublis tree-equal
getf get remprop get-properties symbol-plist
"""

_BOTH = ":TEST and :TEST-NOT were both supplied."
_BINDING_LIST = "\nwhen binding LIST"


# ------------------------------------------------------------------------------------------------------------------- member


def member(item, lst, *, key=None, test=None, test_not=None):
    """``member``: the tail of ``lst`` that starts with ``item``, or nil."""
    if key is None and test is None and test_not is None and (item.__class__ is int or item.__class__ in EQUAL_TO_THEMSELVES):
        cell, number = lst, item.__class__ is int
        while True:
            for _ in STRETCH:
                if cell.__class__ is not Cons:
                    return _at_end(cell, lst)
                each = cell.car
                if each is item or number and each.__class__ is int and each == item:
                    return cell
                cell = cell.cdr
            checkpoint()
    return _member(match_of(item, key, test, test_not, _BOTH), lst)


def member_if(predicate, lst, *, key=None):
    """``member-if``: the tail of ``lst`` that starts with an element that ``predicate`` accepts."""
    return _member(predicate_of(predicate, key), lst)


def member_if_not(predicate, lst, *, key=None):
    """``member-if-not``: the tail of ``lst`` that starts with an element that ``predicate`` rejects."""
    return _member(predicate_of(predicate, key, wanted=False), lst)


def _member(match, lst):
    cell = lst
    while True:
        for _ in STRETCH:
            if cell.__class__ is not Cons:
                return _at_end(cell, lst)
            if match(cell.car):
                return cell
            cell = cell.cdr
        checkpoint()


def _at_end(end, lst):
    """``None`` if ``end``, which stands behind the last cons of ``lst``, is that of a proper list; else a type-error."""
    return None if end is None or end is False else not_a_list(end, _BINDING_LIST if end is lst else "")


# -------------------------------------------------------------------------------------------------------- association lists


def assoc(item, alist, *, key=None, test=None, test_not=None):
    """``assoc``: the first pair of ``alist`` whose car is ``item``."""
    if key is None and test is None and test_not is None and (item.__class__ is int or item.__class__ in EQUAL_TO_THEMSELVES):
        cell, number = alist, item.__class__ is int
        while True:
            for _ in STRETCH:
                if cell.__class__ is not Cons:
                    return _at_end(cell, alist)
                pair = cell.car
                if pair.__class__ is Cons:
                    each = pair.car
                    if each is item or number and each.__class__ is int and each == item:
                        return pair
                elif pair is not None and pair is not False:
                    not_a_list(pair)
                cell = cell.cdr
            checkpoint()
    return _pair(match_of(item, key, test, test_not, _BOTH), alist)


def assoc_if(predicate, alist, *, key=None):
    """``assoc-if``: the first pair whose car ``predicate`` accepts."""
    return _pair(predicate_of(predicate, key), alist)


def assoc_if_not(predicate, alist, *, key=None):
    """``assoc-if-not``: the first pair whose car ``predicate`` rejects."""
    return _pair(predicate_of(predicate, key, wanted=False), alist)


def rassoc(item, alist, *, key=None, test=None, test_not=None):
    """``rassoc``: the first pair whose cdr is ``item``."""
    return _pair(match_of(item, key, test, test_not, _BOTH), alist, by_car=False)


def rassoc_if(predicate, alist, *, key=None):
    """``rassoc-if``: the first pair whose cdr ``predicate`` accepts."""
    return _pair(predicate_of(predicate, key), alist, by_car=False)


def rassoc_if_not(predicate, alist, *, key=None):
    """``rassoc-if-not``: the first pair whose cdr ``predicate`` rejects."""
    return _pair(predicate_of(predicate, key, wanted=False), alist, by_car=False)


def _pair(match, alist, by_car=True):
    cell = alist
    while True:
        for _ in STRETCH:
            if cell.__class__ is not Cons:
                return _at_end(cell, alist)
            pair = cell.car
            if pair.__class__ is Cons:
                if match(pair.car if by_car else pair.cdr):
                    return pair
            elif pair is not None and pair is not False:
                not_a_list(pair)
            cell = cell.cdr
        checkpoint()


# --------------------------------------------------------------------------------------------------------------------- sets


def adjoin(item, lst, *, key=None, test=None, test_not=None):
    """``adjoin``: ``lst`` with ``item`` in front, unless it is there already."""
    of = key_of(key)
    if _member(match_of(of(item) if of else item, key, test, test_not, _BOTH), lst) is not None:
        return lst
    return Cons(item, lst)


def _contains(items, key, compare):
    """A Python predicate: is there an element in ``items`` that matches the (unkeyed) argument?

    Without ``:test`` it looks the ``eql`` key up in a set, so sets of any size are handled in linear time.
    """
    if compare is None:
        from cramhy_runtime.lisp_core.equality import eql_key

        keys = {eql_key(item if key is None else key(item)) for item in items}
        return lambda item: eql_key(item if key is None else key(item)) in keys
    if key is None:
        return lambda item: any(compare(item, other) for other in _each(items))
    keyed = [key(other) for other in items]
    return lambda item: any(compare(key(item), other) for other in _each(keyed))


def _each(items):
    """``items`` with a checkpoint: a search for each of many elements takes long."""
    checkpoint()
    return in_turns(items)


def union(first, second, *, key=None, test=None, test_not=None):
    """``union``: the elements of both. Those of the longer list that are not in the shorter stand in front of the shorter."""
    items, others = items_of(first), items_of(second)
    key, compare = key_of(key), test_of(test, test_not, _BOTH)
    result = second
    if len(items) < len(others):
        items, others, result = others, items, first
        compare = compare and _swapped(compare)
    present = _contains(others, key, compare)
    for item in items:
        if not present(item):
            result = Cons(item, result)
    return result


def _swapped(compare):
    return lambda item, other: compare(other, item)


def intersection(first, second, *, key=None, test=None, test_not=None):
    """``intersection``: the elements of ``first`` that are in ``second``."""
    present = _contains(items_of(second), key_of(key), test_of(test, test_not, _BOTH))
    return _reversed(item for item in items_of(first) if present(item))


def set_difference(first, second, *, key=None, test=None, test_not=None):
    """``set-difference``: the elements of ``first`` that are not in ``second``."""
    items, others = items_of(first), items_of(second)
    if not others:
        return first
    present = _contains(others, key_of(key), test_of(test, test_not, _BOTH))
    return _reversed(item for item in items if not present(item))


def set_exclusive_or(first, second, *, key=None, test=None, test_not=None):
    """``set-exclusive-or``: the elements that are in one of the lists only."""
    return _reversed(_exclusive(first, second, key, test, test_not))


def nset_exclusive_or(first, second, *, key=None, test=None, test_not=None):
    """``nset-exclusive-or``: as `set_exclusive_or`; SBCL keeps the order here."""
    return list_from(_exclusive(first, second, key, test, test_not))


def _exclusive(first, second, key, test, test_not):
    items, others = items_of(first), items_of(second)
    key, compare = key_of(key), test_of(test, test_not, _BOTH)
    in_second = _contains(others, key, compare)
    in_first = _contains(items, key, compare and _swapped(compare))
    return [item for item in items if not in_second(item)] + [item for item in others if not in_first(item)]


def subsetp(first, second, *, key=None, test=None, test_not=None):
    """``subsetp``: whether every element of ``first`` is in ``second``."""
    items = items_of(first)
    present = _contains(items_of(second), key_of(key), test_of(test, test_not, _BOTH))
    return True if all(present(item) for item in items) else None


def _reversed(items):
    head = None
    for item in items:
        head = Cons(item, head)
    return head


nunion, nintersection, nset_difference = union, intersection, set_difference


# -------------------------------------------------------------------------------------------------------------------- trees


def _substituted(match_with_key, new, tree):
    if match_with_key(tree):
        return new
    if not isinstance(tree, Cons):
        return tree
    car = _substituted(match_with_key, new, tree.car)
    cdr = _substituted(match_with_key, new, tree.cdr)
    return tree if car is tree.car and cdr is tree.cdr else Cons(car, cdr)


def subst(new, old, tree, *, key=None, test=None, test_not=None):
    """``subst``: ``tree`` with ``new`` for each subtree that is ``old``; unchanged parts are shared."""
    return _substituted(match_of(old, key, test, test_not, _BOTH), new, tree)


def subst_if(new, predicate, tree, *, key=None):
    """``subst-if``: ``tree`` with ``new`` for each subtree that ``predicate`` accepts."""
    return _substituted(predicate_of(predicate, key), new, tree)


def subst_if_not(new, predicate, tree, *, key=None):
    """``subst-if-not``: ``tree`` with ``new`` for each subtree that ``predicate`` rejects."""
    return _substituted(predicate_of(predicate, key, wanted=False), new, tree)


def _nsubstituted(match, new, tree):
    if match(tree):
        return new
    last, cell = None, tree
    while isinstance(cell, Cons):
        checkpoint()
        if match(cell):
            break
        cell.car = _nsubstituted(match, new, cell.car)
        last, cell = cell, cell.cdr
    else:
        if last is None or not match(cell):
            return tree
    if last is not None:
        last.cdr = new
    return tree


def _rewritten(replacement, tree):
    """``tree``, changed: each subtree gives way to its ``replacement`` unless that is `UNSUPPLIED`; asked in SBCL's order."""
    new = replacement(tree)
    if new is not UNSUPPLIED:
        return new
    last, cell = None, tree
    while isinstance(cell, Cons):
        checkpoint()
        new = replacement(cell)
        if new is not UNSUPPLIED:
            break
        cell.car = _rewritten(replacement, cell.car)
        last, cell = cell, cell.cdr
    else:
        new = UNSUPPLIED if last is None else replacement(cell)
    if new is not UNSUPPLIED and last is not None:
        last.cdr = new
    return tree


def nsubst(new, old, tree, *, key=None, test=None, test_not=None):
    """``nsubst``: as `subst`, in place."""
    return _nsubstituted(match_of(old, key, test, test_not, _BOTH), new, tree)


def nsubst_if(new, predicate, tree, *, key=None):
    """``nsubst-if``: as `subst_if`, in place."""
    return _nsubstituted(predicate_of(predicate, key), new, tree)


def nsubst_if_not(new, predicate, tree, *, key=None):
    """``nsubst-if-not``: as `subst_if_not`, in place."""
    return _nsubstituted(predicate_of(predicate, key, wanted=False), new, tree)


def sublis(alist, tree, *, key=None, test=None, test_not=None):
    """``sublis``: ``tree`` with the cdr of a pair of ``alist`` for each subtree that is the pair's car."""
    replacement = _replacement(alist, key, test, test_not)

    def rewrite(subtree):
        new = replacement(subtree)
        if new is not UNSUPPLIED:
            return new
        if not isinstance(subtree, Cons):
            return subtree
        car, cdr = rewrite(subtree.car), rewrite(subtree.cdr)
        return subtree if car is subtree.car and cdr is subtree.cdr else Cons(car, cdr)

    return rewrite(tree)


def _replacement(alist, key, test, test_not):
    """A function of a subtree: what ``alist`` has for it, or `UNSUPPLIED`."""
    pairs = [pair for pair in items_of(alist, "\nwhen binding SB-IMPL::ALIST") if pair is not None]
    for pair in pairs:
        if not isinstance(pair, Cons):
            not_a_list(pair)
    compare = test_of(test, test_not, _BOTH) or (lambda item, old: eql(old, item) is not None)
    key = key_of(key)

    def replacement(subtree):
        item = subtree if key is None else key(subtree)
        for pair in pairs:
            if compare(item, pair.car):  # in this order, as in SBCL
                return pair.cdr
        return UNSUPPLIED

    return replacement


def nsublis(alist, tree, *, key=None, test=None, test_not=None):
    """``nsublis``: as `sublis`, in place."""
    return _rewritten(_replacement(alist, key, test, test_not), tree)


def tree_equal(first, second, *, test=None, test_not=None):
    """``tree-equal``: whether two trees have the same shape and matching leaves."""
    compare = test_of(test, test_not, _BOTH) or (lambda item, other: eql(item, other) is not None)

    def same(x, y):
        while isinstance(x, Cons):
            checkpoint()
            if not isinstance(y, Cons) or not same(x.car, y.car):
                return False
            x, y = x.cdr, y.cdr
        return not isinstance(y, Cons) and compare(x, y)

    return True if same(first, second) else None


# ----------------------------------------------------------------------------------------------------------- property lists


def _malformed(plist, tail):
    """Signal that ``plist`` is no property list: ``tail`` stands where a cons with a value should."""
    return error(SimpleTypeError("malformed property list: ~S.", plist, datum=tail, expected_type="CONS"))


def property_cell(plist, indicator, context=""):
    """The cons whose car is ``indicator`` at a key position of ``plist``, or ``None``. Malformed lists are a type-error."""
    cell = plist
    while True:
        for _ in STRETCH:
            if cell.__class__ is not Cons:
                return None if cell is None or cell is False else not_a_list(cell, context)
            if not isinstance(cell.cdr, Cons):
                _malformed(plist, cell.cdr)
            if cell.car is indicator or eql(cell.car, indicator):
                return cell
            cell = cell.cdr.cdr
        checkpoint()


def getf(plist, indicator, default=None):
    """``getf``: the value after ``indicator`` in ``plist``, or ``default``."""
    cell = property_cell(plist, indicator, "\nwhen binding SB-IMPL::PLACE")
    return default if cell is None else cell.cdr.car


def with_property(plist, indicator, value):
    """``plist`` with the property set in place, or put in front: what ``(setf getf)`` stores back. Returns the list."""
    cell = property_cell(plist, indicator)
    if cell is None:
        return Cons(indicator, Cons(value, plist))
    cell.cdr.car = value
    return plist


def without_property(plist, indicator):
    """(list, found): ``plist`` without the first property ``indicator``, changed in place, for ``remf`` and `remprop`."""
    previous, cell = None, plist
    while True:
        for _ in STRETCH:
            if not isinstance(cell, Cons):
                return plist, False
            if not isinstance(cell.cdr, Cons):
                _malformed(plist, cell.cdr)
            if cell.car is indicator or eql(cell.car, indicator):
                rest = cell.cdr.cdr
                if previous is None:
                    return rest, True
                previous.cdr = rest
                return plist, True
            previous, cell = cell.cdr, cell.cdr.cdr
        checkpoint()


def get_properties(plist, indicators):
    """``get-properties``: three values, the first indicator of ``indicators`` in ``plist``, its value, the tail there."""
    wanted = [equal_to(indicator) for indicator in items_of(indicators)]
    cell = plist
    while isinstance(cell, Cons):
        if not isinstance(cell.cdr, Cons):
            _malformed(plist, cell.cdr)
        if any(same(cell.car) for same in wanted):
            return MultipleValues((cell.car, cell.cdr.car, cell))
        cell = cell.cdr.cdr
        checkpoint()
    if cell is not None and cell is not False:
        not_a_list(cell) if cell is plist else _malformed(plist, cell)
    return MultipleValues((None, None, None))


_constant_plists: dict = {}  # NIL and T are Python objects and cannot keep their own


def symbol_plist(symbol):
    """``symbol-plist``: the property list of ``symbol``."""
    if isinstance(symbol, Symbol):
        return symbol.plist
    if not is_symbol(symbol):
        type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")
    return _constant_plists.get(symbol)


def set_symbol_plist(plist, symbol):
    """``(setf symbol-plist)``."""
    if not isinstance(plist, Cons) and plist is not None:
        not_a_list(plist)
    symbol_plist(symbol)
    if isinstance(symbol, Symbol):
        redefined(symbol)
        symbol.plist = plist
    else:
        _constant_plists[symbol] = plist
    return plist


def get(symbol, indicator, default=None):
    """``get``: the property ``indicator`` of ``symbol``, or ``default``."""
    cell = property_cell(symbol_plist(symbol), indicator)
    return default if cell is None else cell.cdr.car


def set_get(value, symbol, indicator, default=None):
    """``(setf get)``; ``default`` is accepted and not used, as in the standard."""
    set_symbol_plist(with_property(symbol_plist(symbol), indicator, value), symbol)
    return value


def remprop(symbol, indicator):
    """``remprop``: remove a property; returns what the list was from there on, or nil."""
    plist = symbol_plist(symbol)
    cell = property_cell(plist, indicator)
    if cell is None:
        return None
    set_symbol_plist(without_property(plist, indicator)[0], symbol)
    return cell


SETTERS = {"GET": set_get, "SYMBOL-PLIST": set_symbol_plist}
