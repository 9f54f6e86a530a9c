"""Conses and lists: making them, taking them apart, joining them, changing them in place.

A list is a chain of `Cons` that ends in ``nil``; a chain that ends in something else is dotted, and most functions refuse it.
The accessors ``car`` to ``cddddr`` and ``first`` to ``tenth`` are made from their names, and so are their setters.

Law: nothing here copies what the standard says is shared, and nothing changes a list whose function is not named
destructive. Source: ANSI chapter 14; texts are SBCL's.
"""

from __future__ import annotations

import itertools

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import STRETCH, Cons, MultipleValues, conses, list_end, list_from, list_parts, new_object
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.heap import CONS, check_room
from cramhy_runtime.kernel.active import checkpoint

LISP_NAMES = """
cons car cdr rplaca rplacd list list* make-list copy-list copy-tree copy-alist append nconc revappend nreconc butlast nbutlast
last ldiff tailp nth nthcdr rest endp null consp listp atom list-length acons pairlis
mapcar mapc mapcan maplist mapl mapcon
caar cadr cdar cddr caaar caadr cadar caddr cdaar cdadr cddar cdddr
caaaar caaadr caadar caaddr cadaar cadadr caddar cadddr cdaaar cdaadr cdadar cdaddr cddaar cddadr cdddar cddddr
first second third fourth fifth sixth seventh eighth ninth tenth
"""


def not_a_list(thing, context=""):
    """Signal that ``thing`` is no list."""
    return type_error(thing, "LIST", context)


def cells(lst, context=""):
    """Iterate over the conses of a proper list; anything else is a type-error."""
    cell = lst
    while cell.__class__ is Cons:
        for _ in STRETCH:
            yield cell
            cell = cell.cdr
            if cell.__class__ is not Cons:
                break
        else:
            checkpoint()
    if cell is not None and cell is not False:
        not_a_list(cell, context if cell is lst else "")


def cars(cell):
    """Iterate over the elements of the proper list that begins with the cons ``cell``; a wrong end is a type-error."""
    while cell.__class__ is Cons:
        for _ in STRETCH:
            yield cell.car
            cell = cell.cdr
            if cell.__class__ is not Cons:
                break
        else:
            checkpoint()
    if cell is not None and cell is not False:
        not_a_list(cell)


def items_of(lst, context=""):
    """The elements of a proper list as a Python list; anything else is a type-error."""
    items, cell = list_parts(lst)
    if cell is not None and cell is not False:
        not_a_list(cell, context if cell is lst else "")
    return items


def index_of(number, context="", expected="UNSIGNED-BYTE"):
    """``number`` if it is a non-negative integer, else a type-error."""
    if number.__class__ is not int or number < 0:
        type_error(number, expected, context)
    return number


# ----------------------------------------------------------------------------------------------------- cons and its accessors


def cons(car_, cdr_):
    """``cons``: a new pair."""
    return Cons(car_, cdr_)


def car(lst):
    """``car``: the first element; nil for the empty list."""
    if isinstance(lst, Cons):
        return lst.car
    if lst is None or lst is False:
        return None
    return not_a_list(lst, "\nwhen binding LIST")


def cdr(lst):
    """``cdr``: what follows the first element; nil for the empty list."""
    if isinstance(lst, Cons):
        return lst.cdr
    if lst is None or lst is False:
        return None
    return not_a_list(lst, "\nwhen binding LIST")


def rplaca(pair, value):
    """``rplaca``: set the car of ``pair``; returns the pair."""
    if not isinstance(pair, Cons):
        type_error(pair, "CONS", "\nwhen binding CONS")
    pair.car = value
    return pair


def rplacd(pair, value):
    """``rplacd``: set the cdr of ``pair``; returns the pair."""
    if not isinstance(pair, Cons):
        type_error(pair, "CONS", "\nwhen binding CONS")
    pair.cdr = value
    return pair


SETTERS = {}
"""Lisp name of a place → function (new value, *arguments) that stores there and returns the new value."""


def _define_path(name, path):
    """Define the accessor ``name`` that follows ``path`` ("a" car, "d" cdr), last letter first, and its setter."""
    steps = ["car" if letter == "a" else "cdr" for letter in reversed(path)]
    *way, last_step = steps

    def follow(lst, through):
        thing = lst
        for step in through:
            if isinstance(thing, Cons):
                thing = getattr(thing, step)
            elif thing is None or thing is False:
                return None
            else:
                not_a_list(thing, "\nwhen binding LIST" if thing is lst else "")
        return thing

    def accessor(lst):
        return follow(lst, steps)

    def setter(value, lst):
        pair = follow(lst, way)
        if not isinstance(pair, Cons):
            type_error(pair, "CONS", "" if way else "\nwhen binding SB-IMPL::X")
        setattr(pair, last_step, value)
        return value

    accessor.single_valued = True  # `primary` need not look
    accessor.__name__ = accessor.__qualname__ = name
    accessor.__doc__ = f"``{name}``: " + ", then ".join(steps) + "."
    if name not in globals():
        globals()[name] = accessor
    SETTERS[name.upper()] = setter


for _length in range(1, 5):
    for _letters in itertools.product("ad", repeat=_length):
        _define_path("c" + "".join(_letters) + "r", "".join(_letters))
for _index, _name in enumerate("first second third fourth fifth sixth seventh eighth ninth tenth".split()):
    _define_path(_name, "a" + "d" * _index)
_define_path("rest", "d")
first, rest = car, cdr
car.single_valued = cdr.single_valued = True


def cadr(lst):
    """``cadr``: the second element."""
    if isinstance(lst, Cons):
        rest_ = lst.cdr
        if isinstance(rest_, Cons):
            return rest_.car
        return None if rest_ is None or rest_ is False else not_a_list(rest_)
    return car(lst)


second = cadr


def consp(thing):
    """``consp``: whether ``thing`` is a pair."""
    return True if isinstance(thing, Cons) else None


def listp(thing):
    """``listp``: whether ``thing`` is a pair or nil."""
    return True if thing is None or isinstance(thing, Cons) or thing is False else None


def atom(thing):
    """``atom``: whether ``thing`` is no pair."""
    return None if isinstance(thing, Cons) else True


def null(thing):
    """``null``: whether ``thing`` is nil."""
    return True if thing is None or thing is False else None


def endp(lst):
    """``endp``: whether the list ends here; an atom other than nil is a type-error."""
    if isinstance(lst, Cons):
        return None
    if lst is None or lst is False:
        return True
    return not_a_list(lst, "\nwhen binding SB-IMPL::OBJECT")


# ------------------------------------------------------------------------------------------------------------- making lists


def list_(*items):
    """``list``: a new list of the arguments."""
    return list_from(items)


def list_star(item, *items):
    """``list*``: as `list_`, but the last argument is the tail."""
    if not items:
        return item
    return Cons(item, list_from(items[:-1], items[-1]))


def make_list(size, *, initial_element=None):
    """``make-list``: a list of ``size`` elements."""
    size = index_of(size, expected="(UNSIGNED-BYTE 58)")
    if size >= 1 << 58:
        type_error(size, "(UNSIGNED-BYTE 58)")
    check_room(size, CONS)
    return list_from([initial_element] * size)


def copy_list(lst):
    """``copy-list``: new conses with the same elements; a dotted end is kept."""
    if not isinstance(lst, Cons):
        return lst if lst is None or lst is False else not_a_list(lst, "\nwhen binding LIST")
    items, tail = list_parts(lst)
    return list_from(items, tail)


def copy_tree(tree):
    """``copy-tree``: new conses for all conses of ``tree``."""
    items, tail = list_parts(tree)
    return list_from([copy_tree(item) if isinstance(item, Cons) else item for item in items], tail)


def copy_alist(alist):
    """``copy-alist``: a new list with new pairs."""
    if not isinstance(alist, Cons):
        return alist if alist is None else not_a_list(alist, "\nwhen binding SB-IMPL::ALIST")
    items, tail = list_parts(alist)
    if tail is not None:
        not_a_list(tail)
    return list_from([Cons(item.car, item.cdr) if isinstance(item, Cons) else item for item in items])


def acons(key, value, alist):
    """``acons``: ``alist`` with the pair (``key`` . ``value``) in front."""
    return Cons(Cons(key, value), alist)


def pairlis(keys, data, alist=None):
    """``pairlis``: ``alist`` with the pairs of ``keys`` and ``data`` in front, the last pair first, as in SBCL."""
    keys, data = items_of(keys), items_of(data)
    if len(keys) != len(data):
        error("The lists of keys and data are of unequal length.")
    for key, value in zip(keys, data, strict=True):
        alist = Cons(Cons(key, value), alist)
    return alist


# ----------------------------------------------------------------------------------------------------------- joining lists


def append(*lists):
    """``append``: a list of the elements of all; the last argument is shared and may be anything."""
    if not lists:
        return None
    result = lists[-1]
    for lst in reversed(lists[:-1]):
        if lst is not None:
            result = list_from(items_of(lst), result)
    return result


def nconc(*lists):
    """``nconc``: the lists joined by changing the last cdr of each."""
    result = end = None
    last_index = len(lists) - 1
    for index, lst in enumerate(lists):
        if isinstance(lst, Cons):
            if end is None:
                result = lst
            else:
                end.cdr = lst
            end = _last_cell(lst) if index < last_index else lst
        elif lst is not None and lst is not False:
            if index < last_index:
                not_a_list(lst)
            if end is None:
                return lst
            end.cdr = lst
    return result


def _last_cell(cell):
    while True:
        for _ in STRETCH:
            if cell.cdr.__class__ is not Cons:
                return cell
            cell = cell.cdr
        checkpoint()


def revappend(lst, tail):
    """``revappend``: the elements of ``lst`` in reverse, then ``tail``."""
    for cell in cells(lst, "\nwhen binding SB-IMPL::X"):
        tail = Cons(cell.car, tail)
    return tail


def nreconc(lst, tail):
    """``nreconc``: as `revappend`, with the conses of ``lst``."""
    for cell in list(cells(lst)):
        cell.cdr, tail = tail, cell
    return tail


# ------------------------------------------------------------------------------------------------------------ parts of lists


def nthcdr(n, lst):
    """``nthcdr``: what remains of ``lst`` after ``n`` elements."""
    index_of(n)
    if not isinstance(lst, Cons) and lst is not None and lst is not False:
        not_a_list(lst, "\nwhen binding LIST")
    for step in range(n):
        if isinstance(lst, Cons):
            if not step & 255:
                checkpoint()
            lst = lst.cdr
        elif lst is None or lst is False:
            return None
        else:
            not_a_list(lst)
    return lst


def nth(n, lst):
    """``nth``: element number ``n``, counted from 0; nil beyond the end."""
    index_of(n)
    while n > 0 and isinstance(lst, Cons):
        lst = lst.cdr
        n -= 1
        if not n & 255:
            checkpoint()
    if isinstance(lst, Cons):
        return lst.car
    return None if lst is None or lst is False else not_a_list(lst)


def set_nth(value, n, lst):
    """``(setf nth)``."""
    pair = nthcdr(n, lst)
    if not isinstance(pair, Cons):
        type_error(pair, "CONS")
    pair.car = value
    return value


SETTERS["NTH"] = set_nth


def last(lst, n=1):
    """``last``: the list of the last ``n`` conses."""
    index_of(n, "\nwhen binding SB-IMPL::N")
    if not isinstance(lst, Cons):
        return lst if lst is None or lst is False else not_a_list(lst, "\nwhen binding LIST")
    if n == 1:
        return _last_cell(lst)
    count = len(lst)
    for _ in range(max(count - n, 0)):
        lst = lst.cdr
    return lst


def butlast(lst, n=1):
    """``butlast``: a list of all but the last ``n`` elements."""
    index_of(n, "\nwhen binding SB-IMPL::N")
    if not isinstance(lst, Cons) and lst is not None:
        not_a_list(lst, "\nwhen binding LIST")
    items, _ = list_parts(lst)
    return list_from(items[: max(len(items) - n, 0)])


def nbutlast(lst, n=1):
    """``nbutlast``: as `butlast`, by cutting ``lst``."""
    index_of(n, "\nwhen binding SB-IMPL::N")
    if not isinstance(lst, Cons) and lst is not None:
        not_a_list(lst, "\nwhen binding LIST")
    keep = len(list_parts(lst)[0]) - n
    if keep <= 0:
        return None
    cell = lst
    for _ in range(keep - 1):
        cell = cell.cdr
    cell.cdr = None
    return lst


def _same_tail(thing, tail):
    if thing is tail:
        return True
    if isinstance(thing, Cons) or isinstance(tail, Cons):
        return False
    from cramhy_runtime.lisp_core.equality import eql

    return eql(thing, tail) is not None


def ldiff(lst, tail):
    """``ldiff``: a list of what stands before ``tail`` in ``lst``."""
    if not isinstance(lst, Cons) and lst is not None:
        not_a_list(lst, "\nwhen binding LIST")
    items = []
    for cell in conses(lst):
        if cell is tail:
            return list_from(items)
        items.append(cell.car)
    end = list_end(lst)
    return list_from(items, None if _same_tail(end, tail) else end)


def tailp(tail, lst):
    """``tailp``: whether ``tail`` is ``lst`` or one of its tails."""
    if not isinstance(lst, Cons) and lst is not None:
        not_a_list(lst, "\nwhen binding LIST")
    for cell in conses(lst):
        if cell is tail:
            return True
    return True if _same_tail(list_end(lst), tail) else None


def list_length(lst):
    """``list-length``: the number of elements; nil for a circular list."""
    if not isinstance(lst, Cons) and lst is not None:
        not_a_list(lst, "\nwhen binding LIST")
    count, slow, fast = 0, lst, lst
    while isinstance(fast, Cons):
        fast = fast.cdr
        count += 1
        if count % 2 == 0:
            slow = slow.cdr
            if slow is fast and isinstance(fast, Cons):
                return None
    return count if fast is None or fast is False else not_a_list(fast)


# ------------------------------------------------------------------------------------------------------------------ mapping


def mapcar(function, lst, *lists):
    """``mapcar``: the list of what ``function`` gives for the elements, until the shortest list ends."""
    function = function_of(function)
    if lists:
        return list_from([_one(function(*items)) for items in _lockstep((lst, *lists))])
    tail = header = Cons(None)
    cell = lst
    while cell.__class__ is Cons:
        for _ in STRETCH:
            value = function(cell.car)
            if value.__class__ is MultipleValues:
                value = value[0] if len(value) else None
            cell, new = cell.cdr, new_object(Cons)
            new.car, new.cdr, tail.cdr = value, None, new
            tail = new
            if cell.__class__ is not Cons:
                break
        else:
            checkpoint()
    if cell is not None and cell is not False:
        not_a_list(cell)
    return header.cdr


def _one(value):
    if value.__class__ is MultipleValues:
        return value[0] if len(value) else None
    return value


def _lockstep(lists, tails=False):
    """Iterate over the elements (or ``tails``) of several lists at once."""
    lists = list(lists)
    while True:
        checkpoint()
        for lst in lists:
            if not isinstance(lst, Cons):
                return None if lst is None or lst is False else not_a_list(lst)
        yield tuple(lists) if tails else [lst.car for lst in lists]
        lists = [lst.cdr for lst in lists]


def mapc(function, lst, *lists):
    """``mapc``: call ``function`` on the elements; returns ``lst``."""
    function = function_of(function)
    if lists:
        for items in _lockstep((lst, *lists)):
            function(*items)
    else:
        for cell in cells(lst):
            function(cell.car)
    return lst


def mapcan(function, lst, *lists):
    """``mapcan``: the lists that ``function`` gives for the elements, joined with `nconc`."""
    function = function_of(function)
    return _joined(_one(function(*items)) for items in _lockstep((lst, *lists)))


def _joined(parts):
    # As SBCL, an atom among the results is dropped unless it is the last one.
    head = Cons(None)
    end = head
    for part in parts:
        end.cdr = part
        if isinstance(part, Cons):
            end = _last_cell(part)
    return head.cdr


def maplist(function, lst, *lists):
    """``maplist``: as `mapcar` on the lists and their tails instead of the elements."""
    function = function_of(function)
    return list_from([_one(function(*tails)) for tails in _lockstep((lst, *lists), tails=True)])


def mapl(function, lst, *lists):
    """``mapl``: as `mapc` on the tails."""
    function = function_of(function)
    for tails in _lockstep((lst, *lists), tails=True):
        function(*tails)
    return lst


def mapcon(function, lst, *lists):
    """``mapcon``: as `mapcan` on the tails."""
    function = function_of(function)
    return _joined(_one(function(*tails)) for tails in _lockstep((lst, *lists), tails=True))
