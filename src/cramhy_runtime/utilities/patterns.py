"""Patterns over Lisp data: variables, bindings, one-sided matching, unification.

A variable is a symbol whose name starts with ``?``; ``?_`` of the package cram-utilities matches everything and is never bound.
A segment variable starts with ``!?``, stands first in a list, and takes as few elements as will do. Bindings are an
association list of (variable . value), newest first; ``nil`` is the empty one, so whoever can fail returns a second value.

This is the library that plans call. The Prolog engine has terms of its own, see ``prolog/terms/terms.py``. Source: prolog.md sections 2, 3.
"""

from __future__ import annotations

import itertools

from cramhy_runtime.lisp_core import equality
from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.lisp_core.conditions import error, type_error, warn
from cramhy_runtime.lisp_core.data import (
    TRUE_CLASSES,
    Cons,
    Keyword,
    LispString,
    MultipleValues,
    Symbol,
    conses,
    list_from,
    one,
    python_list,
    truth,
)
from cramhy_runtime.lisp_core.functions import function_of

from .compiled_patterns import LOOK_CLOSER, Matchers, unfit
from .lazy_lists import LazyTail, lazy_cdr
from .symbols import CUT

ANONYMOUS = CUT.intern("?_")
ANONYMOUS_SEGMENT = CUT.intern("!?_")

_counter = itertools.count(1)


_COMPARED_BY_LISP = (TRUE_CLASSES | equality.EQUAL_TO_THEMSELVES) - {bytes, tuple}
"""Classes whose objects only ``equal`` compares, though Python finds more of them equal: ``True`` and 1, ``0.0`` and ``-0.0``."""


class Nothing:
    """The class of `NOTHING`."""

    __slots__ = ()

    def __bool__(self):
        return False

    def __repr__(self):
        return "None"

    def __reduce__(self):
        return "NOTHING"

    def __copy__(self):
        return self

    def __deepcopy__(self, memo):
        return self


NOTHING = Nothing()
"""Python's None in a term. There ``nil`` is the empty list, and False is itself. All three are one term, and Lisp gets ``nil`` for each."""


class Inserted:
    """Whether Python has put a `NOTHING` into terms yet. Until then nobody has to look for it in lists."""

    nothing = False


def for_lisp(term):
    """``term`` as Lisp sees it: ``nil`` for Python's None and False, and for each None in a list."""
    if term is NOTHING or term is False:
        return None
    if term.__class__ is not Cons or not Inserted.nothing:
        return term
    cells, parts, seen, cell = [], [], set(), term
    while cell.__class__ is Cons and id(cell) not in seen:  # a list of Lisp may be circular
        seen.add(id(cell))
        cells.append(cell)
        parts.append(for_lisp(cell.car))
        cell = cell.cdr
    changed = any(part is not cell.car and cell.car is not False for part, cell in zip(parts, cells))
    return list_from(parts, cell) if changed else term


def same_atom(a, b):
    """CL ``equal`` for atoms, as a Python bool; the engine's innermost test, so the common kinds come first.

    Values of Python's classes (dates, paths, bytes, frozen dataclasses, named tuples) are the same if they are of one class and equal.
    Objects that can change have no hash, or that of their identity, and are the same only as the same object.
    """
    if a is b:
        return True
    kind = a.__class__
    if kind is Symbol or kind is Cons:
        return False
    if kind is b.__class__:
        if kind is Keyword:
            return False
        if kind is int or kind is str:
            return a == b
    if equality.equal(a, b) is not None:
        return True
    if a is None or a is False or a is NOTHING:
        return b is None or b is False or b is NOTHING
    return kind is b.__class__ and compared_by_python(kind) and bool(a == b)


def compared_by_python(cls):
    """Whether objects of the class ``cls`` are values of Python's, beside those of Lisp: equal by their contents, and never changed."""
    return (
        cls not in _COMPARED_BY_LISP
        and cls.__eq__ is not object.__eq__
        and cls.__hash__ is not None
        and cls.__hash__ is not object.__hash__
    )


def equal(a, b):
    """CL ``equal`` on data that may contain lazy lists, which it forces."""
    while isinstance(a, Cons) and isinstance(b, Cons):
        checkpoint()
        if a is b:
            return True
        if not equal(a.car, b.car):
            return False
        a, b = lazy_cdr(a), lazy_cdr(b)
    return same_atom(a, b)


# ---------------------------------------------------------------------------------------------------------------- variables


def variable(pat):
    """Python's ``is_var``: whether ``pat`` is a variable."""
    return isinstance(pat, Symbol) and pat.name[:1] == "?"


def segment_variable(pat):
    return isinstance(pat, Symbol) and pat.name[:2] == "!?"


def is_var(pat):
    return True if isinstance(pat, Symbol) and pat.name[:1] == "?" else None


def is_unnamed_var(pat):
    return True if pat is ANONYMOUS else None


def is_segvar(pat):
    return True if segment_variable(pat) else None


def is_segform(form):
    return True if isinstance(form, Cons) and segment_variable(form.car) else None


def var_name(var):
    """The variable that names ``var``: itself, or for a segment variable the one without the ``!``."""
    if variable(var):
        return var
    if segment_variable(var):
        return var.package.intern(var.name[1:]) if var.package else Symbol(var.name[1:])
    return error("No variable.")


def fresh_name(base):
    """An uninterned variable whose name is ``base`` and a number."""
    return Symbol(f"{base}{next(_counter)}")


def gen_var(base="?VAR-"):
    """A fresh uninterned variable; ``base`` is the start of its name and starts with ``?``."""
    if not isinstance(base, (str, LispString)) or not str(base).startswith("?"):
        return error("The assertion (IS-VAR (MAKE-SYMBOL ~s)) failed: the name of a variable starts with a question mark.", base)
    return fresh_name(str(base))


def is_genvar(var):
    if not variable(var):
        return error("The assertion (IS-VAR VAR) failed: ~s is not a variable.", var)
    return True if var.package is None else None


# ----------------------------------------------------------------------------------------------------------------- bindings


def entry(var, bdgs):
    """The pair for ``var`` in an association list, or ``None``."""
    while bdgs is not None:
        checkpoint()
        pair = bdgs.car if bdgs.__class__ is Cons else type_error(bdgs, "LIST")
        if pair is not None and (pair if pair.__class__ is Cons else type_error(pair, "LIST")).car is var:
            return pair
        bdgs = lazy_cdr(bdgs)
    return None


def add_bdg(var, val, bdgs):
    """Values: ``bdgs`` with (var . val), and whether that is consistent with what they say already."""
    if var is ANONYMOUS:
        return MultipleValues((bdgs, True))
    pair = entry(var, bdgs)
    if pair is None:
        return MultipleValues((Cons(Cons(var, val), bdgs), True))
    if equal(substitute_vars(pair.cdr, bdgs), val):
        return MultipleValues((bdgs, True))
    return MultipleValues((None, None))


def var_value(var, binds):
    """The value of a variable with its inner variables substituted; everything else is returned as it is."""
    if not variable(var):
        return var
    pair = entry(var, binds)
    return var if pair is None else substitute_vars(pair.cdr, binds)


def substitute_vars(pat, bdgs):
    """``pat`` with every bound variable replaced, recursively."""
    if not isinstance(pat, Cons):
        seen = None
        while variable(pat):
            pair = entry(pat, bdgs)
            if pair is None:
                return pat
            seen = {pat} if seen is None else seen | {pat}
            pat = pair.cdr
            if pat in seen if isinstance(pat, Symbol) else False:
                return pat
        return pat if not isinstance(pat, Cons) else substitute_vars(pat, bdgs)
    cars, changed, cell = [], False, pat
    for each in conses(pat):
        car = each.car
        value = substitute_vars(car, bdgs) if isinstance(car, (Cons, Symbol)) else car
        changed = changed or value is not car
        cars.append(value)
        cell = each.cdr
        if variable(cell):
            value = substitute_vars(cell, bdgs)
            changed = changed or value is not cell
            cell = value
            break
    return list_from(cars, cell) if changed else pat


def is_bound(pat, bdgs):
    """False only for a variable whose value is still a variable."""
    return None if variable(var_value(pat, bdgs)) else True


def is_ground(pat, bdgs):
    """True if no variable is left after substitution."""
    return True if vars_in(substitute_vars(pat, bdgs)) is None else None


def variables_of(tree):
    """The variables of ``tree`` as a Python list, in order of first occurrence, ``?_`` included."""
    found, stack = {}, [tree]
    while stack:
        checkpoint()
        item = stack.pop()
        while isinstance(item, Cons):
            checkpoint()
            if isinstance(item.cdr, (Cons, Symbol)):
                stack.append(item.cdr)
            item = item.car
        if variable(item):
            found.setdefault(item)
    return list(found)


def vars_in(pat):
    """The variables of the tree without duplicates, in reverse order of first occurrence."""
    return list_from(variables_of(pat)[::-1])


def map_tree(fun, tree):
    """``tree`` with ``fun`` applied to every atom but ``nil``, in car and in cdr position."""
    function = function_of(fun)

    def walk(item):
        if isinstance(item, Cons):
            return Cons(walk(item.car), walk(item.cdr))
        return None if item is None else one(function(item))

    return walk(tree)


def rename_vars(pat, *, gensym_var_names=True):
    """``pat`` with each variable but ``?_`` replaced by a fresh uninterned one, consistently."""
    fresh = {}

    def rename(atom):
        if not variable(atom) or atom is ANONYMOUS:
            return atom
        if atom not in fresh:
            fresh[atom] = fresh_name(atom.name + "-") if truth(gensym_var_names) else Symbol(atom.name)
        return fresh[atom]

    return map_tree(rename, pat)


def patterns_eq(pattern_1, pattern_2):
    """Whether two lists have the same shape and atoms, any variable standing for any variable."""
    for pattern in (pattern_1, pattern_2):
        if pattern is not None and not isinstance(pattern, Cons):
            return type_error(pattern, "LIST")
    return _patterns_eq(pattern_1, pattern_2)


def _patterns_eq(pattern_1, pattern_2):
    while isinstance(pattern_1, Cons) and isinstance(pattern_2, Cons):
        checkpoint()
        a, b = pattern_1.car, pattern_2.car
        if isinstance(a, Cons) and isinstance(b, Cons):
            if not _patterns_eq(a, b):
                return None
        elif not ((variable(a) and variable(b)) or a is b or (isinstance(a, int) and same_atom(a, b))):
            return None
        pattern_1, pattern_2 = pattern_1.cdr, pattern_2.cdr
    return True if pattern_1 is pattern_2 else None


def bindings_equal(lhs, rhs, *, test=None):
    """Whether every binding of ``lhs`` has an equal value in ``rhs``; not the reverse."""
    function = equal if test is None else function_of(test)
    for pair in python_list(lhs):
        if pair.__class__ is not Cons:
            return type_error(pair, "CONS")
        other = entry(pair.car, rhs)
        if not truth(one(function(pair.cdr, None if other is None else other.cdr))):
            return None
    return True


def with_vars_bound(variables, bdg, body):
    """Call ``body`` with the value of each variable: the work of the macro of that name."""
    return body(*(var_value(var, bdg) for var in variables))


def with_vars_strictly_bound(variables, bdg, body):
    """As `with_vars_bound`, but a variable without a value is an error."""
    values = []
    for var in variables:
        value = var_value(var, bdg)
        values.append(error("Couldn't resolve variable ~a.", var) if variable(value) else value)
    return body(*values)


def with_pat_vars_bound(pat, seq, body):
    """Match ``pat`` against ``seq``; call ``body`` with a function that gives a variable's value.

    No match is an error, a match without variables a warning: the work of the macro of that name.
    """
    bdgs, matched = pat_match(pat, seq)
    if not matched:
        return error("Pattern ~a does not match ~a in with-pat-vars-bound.", pat, seq)
    if bdgs is None:
        warn("Pattern ~a does not contain any variables in with-pat-vars-bound", pat)
    return body(lambda var: var_value(var, bdgs))


# ----------------------------------------------------------------------------------------------------------------- matching

_FAIL = object()
_matchers = Matchers(ANONYMOUS, {"equal": equal, "substitute_vars": substitute_vars})
_functions = _matchers.functions


def pat_match(pat, seq, *options):
    """Values: the bindings under which ``pat`` is ``seq``, and whether there are any. Variables stand on the left only.

    ``options``: bindings to extend, then keywords; ``:test`` compares atoms (default ``eql``).
    """
    if not options and pat.__class__ is Cons:
        function = _functions.get(pat)
        if function is None:
            _matchers.meet(pat)
        else:
            result = function(seq)
            if result is not LOOK_CLOSER:
                return result
            if function is not unfit:
                _functions.pop(pat, None)
    options, bdgs = list(options), None
    if options and not (isinstance(options[0], Keyword) and options[0].name == "TEST"):
        bdgs = options.pop(0)
    test = equality.eql
    for index in range(0, len(options) - 1, 2):
        if options[index].name == "TEST":
            test = function_of(options[index + 1])
    result = _match(pat, seq, bdgs, test)
    return MultipleValues((None, None)) if result is _FAIL else MultipleValues((result, True))


def pat_match_p(pat, seq, *options):
    """Whether ``pat`` matches ``seq``."""
    return pat_match(pat, seq, *options)[1]


def _match(pat, seq, bdgs, test):
    while True:
        checkpoint()
        if isinstance(pat, Cons) and segment_variable(pat.car):
            result = match_segvar(
                pat, seq, bdgs, lambda p, s, b: MultipleValues((lambda r: (None, None) if r is _FAIL else (r, True))(_match(p, s, b, test)))
            )
            return result[0] if result[1] else _FAIL
        if segment_variable(pat):
            return error("Segvar ~a must be car of a cons-cell.", pat)
        if variable(seq) or segment_variable(seq):
            return error("Found variable ~a on right hand side of pattern match.", seq)
        if variable(pat):
            bdgs, consistent = add_bdg(pat, seq, bdgs)
            return bdgs if consistent else _FAIL
        if not (isinstance(pat, Cons) and isinstance(seq, Cons)):
            if isinstance(pat, Cons) or isinstance(seq, Cons):
                return _FAIL
            return bdgs if truth(one(test(pat, seq))) else _FAIL
        bdgs = _match(pat.car, seq.car, bdgs, test)
        if bdgs is _FAIL:
            return _FAIL
        pat, seq = pat.cdr, lazy_cdr(seq)


def match_segvar(pat, seq, bdgs, continuation):
    """Match the segment variable that starts ``pat`` with ever longer starts of ``seq``.

    ``continuation(pattern, sequence, bindings)`` matches what follows; it returns bindings and success as two values.
    """
    var, rest = pat.car, pat.cdr
    name = ANONYMOUS if var is ANONYMOUS_SEGMENT else var_name(var)
    taken = []
    while True:
        if rest is None:  # at the end: the whole rest, which must be a proper list
            cell = seq
            while isinstance(cell, Cons):
                checkpoint()
                taken.append(cell.car)
                cell = lazy_cdr(cell)
            if cell is not None:
                return MultipleValues((None, None))
            return add_bdg(name, list_from(taken), bdgs)
        extended, consistent = add_bdg(name, list_from(taken), bdgs)
        if consistent:
            result = continuation(rest, seq, extended)
            if isinstance(result, MultipleValues) and truth(result[1]):
                return result
        if not isinstance(seq, Cons):
            return MultipleValues((None, None))
        taken.append(seq.car)
        seq = lazy_cdr(seq)


# -------------------------------------------------------------------------------------------------------------- unification


def unify(lhs, rhs, bdgs=None):
    """Values: ``bdgs`` extended so that both sides are the same, and whether that is possible. See prolog.md 2.4."""
    result = _unify(lhs, rhs, bdgs)
    return MultipleValues((None, None)) if result is _FAIL else MultipleValues((result, True))


def unify_p(lhs, rhs, bdgs=None):
    """Whether both sides unify."""
    return unify(lhs, rhs, bdgs)[1]


def _shallow(term, bdgs):
    while variable(term):
        pair = entry(term, bdgs)
        if pair is None or pair.cdr is term:
            return term
        term = pair.cdr
    return term


def _unify(lhs, rhs, bdgs):
    while True:
        checkpoint()
        lhs, rhs = _shallow(lhs, bdgs), _shallow(rhs, bdgs)
        if isinstance(lhs, LazyTail):
            lhs = lhs.force()
        if isinstance(rhs, LazyTail):
            rhs = rhs.force()
        if segment_variable(lhs) or segment_variable(rhs):
            return error("Found segvar that is not in car of a cons-cell while unifying ~a and ~a", lhs, rhs)
        if lhs is ANONYMOUS or rhs is ANONYMOUS or lhs is rhs:
            return bdgs
        if variable(lhs):
            return Cons(Cons(lhs, substitute_vars(rhs, bdgs)), bdgs)
        if variable(rhs):
            return Cons(Cons(rhs, substitute_vars(lhs, bdgs)), bdgs)
        if truth(is_segform(lhs)) or truth(is_segform(rhs)):
            warn("Using segvars in unify... This is not implementet properly at the moment.")
            pattern, other = (lhs, rhs) if truth(is_segform(lhs)) else (rhs, lhs)
            result = match_segvar(pattern, other, bdgs, unify)
            return result[0] if result[1] else _FAIL
        if not (isinstance(lhs, Cons) and isinstance(rhs, Cons)):
            if isinstance(lhs, Cons) or isinstance(rhs, Cons):
                return _FAIL
            return bdgs if same_atom(lhs, rhs) else _FAIL
        bdgs = _unify(lhs.car, rhs.car, bdgs)
        if bdgs is _FAIL:
            return _FAIL
        lhs, rhs = lhs.cdr, rhs.cdr
