"""Functions that are written in place: mapping over lists, searching, and the next method of a method.

``(mapcar (lambda (x) ...) list)`` means a loop whose body is that of the function, and becomes one. So the variables around stay
variables of one Python function, and ``return-from`` and ``go`` out of the function written in place are jumps. Functions of
several lists end with the shortest. What has another shape (a lambda list with keywords, a function that is computed) is called.
``(find-if (lambda (x) ...) sequence)`` and its relatives become loops likewise, over sequences of any kind (``cramhy::each``), and so do
``(reduce (lambda (a b) ...) sequence :initial-value value)`` and ``(maphash (lambda (key value) ...) table)``.

A method that uses ``call-next-method`` and ``next-method-p`` has them as local functions, so that it can give them away, too. Where its
parameters are all required, the definitions of these functions say which variable holds the function of the next method, and which the
arguments. Then a call of ``call-next-method`` is a call of that function, and no closure is made.

Rows of ``make bench`` without a pass, as times of the row with it. ``mapping``: mapcar 1.17. ``searching``: remove-if, reduce 1.11.
``next-methods``: call-next-method 3.1.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, list_from
from ..syntax.lambda_lists import gensym
from ..loop.loop_support import CAR_OF_CONS, CDR_OF_CONS, COLLECT, COLLECT_NCONC, END_OF_LIST
from cramhy_runtime.lisp_core.packages import sym
from .nodes import CallLocal, LocalVariable, Support
from .passes import ON, WRITTEN_OUT, enter

MAPCAR, MAPC, MAPCAN = map(sym, "MAPCAR MAPC MAPCAN".split())
LET, LET_STAR, TAGBODY, IF, GO, SETQ, PROGN, ATOM, CONS, FUNCTION, LAMBDA = map(
    sym, "LET LET* TAGBODY IF GO SETQ PROGN ATOM CONS FUNCTION LAMBDA".split()
)
MAPPING = {MAPCAR: COLLECT, MAPC: None, MAPCAN: COLLECT_NCONC}
SEARCHING: dict = {}
"""Symbol of a function of a predicate and a sequence → the function that writes the loop."""
MAPHASH, REDUCE, INITIAL_VALUE = map(sym, "MAPHASH REDUCE :INITIAL-VALUE".split())


@enter("mapping")
def _mapping():
    WRITTEN_OUT.update({*MAPPING, MAPHASH, REDUCE})


SIMPLE = {
    sym(name)
    for name in """CAR CDR CAAR CADR CDDR FIRST SECOND THIRD REST 1+ 1- - NOT NULL EVENP ODDP ZEROP PLUSP MINUSP CONSP ATOM LISTP SYMBOLP
    NUMBERP INTEGERP STRINGP CHARACTERP KEYWORDP ABS IDENTITY LENGTH CHAR-UPCASE CHAR-DOWNCASE CHAR-CODE CODE-CHAR SYMBOL-NAME""".split()
}
"""Functions of one argument whose calls are written in place, too: ``#'car`` is as good as a lambda expression."""


def open_coded(form, local):
    """The loop that a call of a mapping or searching function means, or ``None`` to call it. ``local(symbol)``: what it names here, if
    not a global function."""
    parts, cell = [], form.cdr
    while isinstance(cell, Cons):
        parts.append(cell.car)
        cell = cell.cdr
    if cell is not None or len(parts) < 2:
        return None
    function, *lists = parts
    if isinstance(function, Cons) and function.car is FUNCTION and isinstance(function.cdr, Cons):
        function = function.cdr.car
        if function.__class__ is Symbol and function in SIMPLE and len(lists) == 1 and local(function) is None:
            item = gensym("ITEM")
            function = lisp_list(LAMBDA, lisp_list(item), lisp_list(function, item))
    if not (isinstance(function, Cons) and function.car is LAMBDA and isinstance(function.cdr, Cons)):
        return None
    variables = _variables(function.cdr.car)
    if variables is not None and len(variables) == 2 and (form.car is MAPHASH or form.car is REDUCE):
        return (_maphash if form.car is MAPHASH else _reduce)(variables, function.cdr.cdr, *lists)
    if variables is None or len(variables) != len(lists) or form.car is MAPHASH or form.car is REDUCE:
        return None
    if form.car in SEARCHING:
        if len(lists) > 1:
            return None
        item = gensym("ITEM")
        test = Cons(LET, Cons(lisp_list(lisp_list(variables[0], item)), function.cdr.cdr))
        return SEARCHING[form.car](item, test, lists[0])
    return _loop(form.car, variables, function.cdr.cdr, lists)


def _variables(lambda_list):
    variables, cell = [], lambda_list
    while isinstance(cell, Cons):
        if not isinstance(cell.car, Symbol) or cell.car.name.startswith("&"):
            return None
        variables.append(cell.car)
        cell = cell.cdr
    return variables if cell is None and len(set(variables)) == len(variables) else None


def _loop(name, variables, body, lists):
    collect = MAPPING[name]
    rests = [gensym("REST") for _ in lists]
    first, header, tail, again, end = (gensym(text) for text in ("FIRST", "HEADER", "TAIL", "NEXT", "END"))
    bindings = [lisp_list(rest, each) for rest, each in zip(rests, lists, strict=True)]
    leave = lisp_list(GO, end)
    tests = [lisp_list(IF, lisp_list(ATOM, rest), lisp_list(PROGN, lisp_list(END_OF_LIST, rest), leave), None) for rest in rests]
    elements = list_from([lisp_list(variable, lisp_list(CAR_OF_CONS, rest)) for variable, rest in zip(variables, rests, strict=True)])
    value = Cons(LET, Cons(elements, body))
    steps = [lisp_list(SETQ, rest, lisp_list(CDR_OF_CONS, rest)) for rest in rests]
    if collect is None:
        bindings.append(lisp_list(first, rests[0]))
        result = first
    else:
        bindings += [lisp_list(header, lisp_list(CONS, None, None)), lisp_list(tail, header)]
        value = lisp_list(SETQ, tail, lisp_list(collect, tail, value))
        result = lisp_list(CDR_OF_CONS, header)
    loop = Cons(TAGBODY, list_from([again, *tests, value, *steps, lisp_list(GO, again), end]))
    return lisp_list(LET_STAR, list_from(bindings), loop, result)


# ----------------------------------------------------------------------------------------------------------- searching

EACH, SUPPORT, BLOCK, RETURN_FROM, PLUS_ONE = map(sym, "CRAMHY::EACH CRAMHY::SUPPORT BLOCK RETURN-FROM 1+".split())
FIRST_SEQUENCE = "\nwhen binding SB-IMPL::FIRST-SEQ"


def searching(name):
    """Enter the decorated function as the one that writes a call of ``name``: it gets a symbol for an element, the test of it, and the
    form of the sequence."""

    def define(function):
        SEARCHING[sym(name)] = function
        enter("searching")(lambda: WRITTEN_OUT.add(sym(name)))
        return function

    return define


def _each(item, sequence, form, whole=False, context=""):
    """A loop that evaluates ``form`` for each element. whole: a list is looked at as a whole before."""
    return lisp_list(EACH, lisp_list(item, sequence, "each_of_all" if whole else "each", context), form)


def _leaving(loop_for, otherwise):
    """A block around the loop ``loop_for(leave)``, where ``leave(form)`` gives the block that value; its value else is ``otherwise``."""
    block = gensym("FOUND")
    loop = loop_for(lambda value: lisp_list(RETURN_FROM, block, value))
    return lisp_list(BLOCK, block, loop, otherwise)


@searching("FIND-IF")
def _find_if(item, test, sequence):
    return _leaving(lambda leave: _each(item, sequence, lisp_list(IF, test, leave(item), None)), None)


@searching("SOME")
def _some(item, test, sequence):
    answer = gensym("ANSWER")

    def loop(leave):
        leaving = lisp_list(LET, lisp_list(lisp_list(answer, test)), lisp_list(IF, answer, leave(answer), None))
        return _each(item, sequence, leaving, context=FIRST_SEQUENCE)

    return _leaving(loop, None)


@searching("EVERY")
def _every(item, test, sequence):
    return _leaving(lambda leave: _each(item, sequence, lisp_list(IF, test, None, leave(None)), context=FIRST_SEQUENCE), True)


@searching("NOTANY")
def _notany(item, test, sequence):
    return _leaving(lambda leave: _each(item, sequence, lisp_list(IF, test, leave(None), None), context=FIRST_SEQUENCE), True)


@searching("NOTEVERY")
def _notevery(item, test, sequence):
    return _leaving(lambda leave: _each(item, sequence, lisp_list(IF, test, None, leave(True)), context=FIRST_SEQUENCE), None)


@searching("POSITION-IF")
def _position_if(item, test, sequence):
    index = gensym("INDEX")
    onward = lisp_list(SETQ, index, lisp_list(PLUS_ONE, index))

    def loop(leave):
        return _each(item, sequence, lisp_list(PROGN, lisp_list(IF, test, leave(index), None), onward), whole=True)

    return lisp_list(LET, lisp_list(lisp_list(index, 0)), _leaving(loop, None))


@searching("COUNT-IF")
def _count_if(item, test, sequence):
    count = gensym("COUNT")
    counting = lisp_list(IF, test, lisp_list(SETQ, count, lisp_list(PLUS_ONE, count)), None)
    return lisp_list(LET, lisp_list(lisp_list(count, 0)), _each(item, sequence, counting, whole=True), count)


def _kept(item, sequence, chosen):
    """The elements for which the form ``chosen(keep)`` comes to evaluate ``keep``, as a sequence of the same kind."""
    whole, kept = gensym("SEQUENCE"), gensym("KEPT")
    bindings = lisp_list(lisp_list(whole, sequence), lisp_list(kept, lisp_list(SUPPORT, "vector")))
    loop = _each(item, whole, chosen(lisp_list(SUPPORT, "keep", kept, item)), whole=True)
    return lisp_list(LET, bindings, loop, lisp_list(SUPPORT, "same_kind", whole, kept))


@searching("REMOVE-IF")
def _remove_if(item, test, sequence):
    return _kept(item, sequence, lambda keep: lisp_list(IF, test, None, keep))


@searching("REMOVE-IF-NOT")
def _remove_if_not(item, test, sequence):
    return _kept(item, sequence, lambda keep: lisp_list(IF, test, keep, None))


def _maphash(variables, body, table, *more):
    if more:
        return None
    items = [gensym("KEY"), gensym("VALUE")]
    value = Cons(LET, Cons(list_from(map(lisp_list, variables, items)), body))
    return lisp_list(EACH, lisp_list(list_from(items), table, "each_entry", ""), value)


def _reduce(variables, body, sequence, *rest):
    if len(rest) != 2 or rest[0] is not INITIAL_VALUE:
        return None
    whole, item, result = gensym("SEQUENCE"), gensym("ITEM"), gensym("RESULT")
    value = Cons(LET, Cons(list_from(map(lisp_list, variables, (result, item))), body))
    loop = _each(item, whole, lisp_list(SETQ, result, value), whole=True)
    return lisp_list(LET, lisp_list(lisp_list(whole, sequence), lisp_list(result, rest[1])), loop, result)


# -------------------------------------------------------------------------------------------------------- next methods

CALL, EXISTS = sym("CALL-NEXT-METHOD"), sym("NEXT-METHOD-P")
NEXT_VALUES, NEXT_METHOD_EXISTS = sym("CRAMHY::NEXT-VALUES"), sym("CRAMHY::NEXT-METHOD-EXISTS")


def next_method(name, body):
    """What the local function ``name`` with the forms ``body`` means: its name, the variables of the next method and of that for other
    arguments, and those of the arguments; ``None`` if it is none of the two functions."""
    form = body.car if isinstance(body, Cons) else None
    if not isinstance(form, Cons) or "next-methods" not in ON:
        return None
    if name is CALL and form.car is NEXT_VALUES:
        _, following, changed, _, *given = form
        return name, following, changed, given
    if name is EXISTS and form.car is NEXT_METHOD_EXISTS:
        return name, form.cdr.car, None, None
    return None


def call_of_next(analyzer, meaning, form, env):
    """The node of the call ``form`` of one of the two."""
    name, following, changed, given = meaning
    changes = name is CALL and form.cdr is not None
    function = env.variable(changed if changes else following).used_from(env.scope)
    if name is EXISTS:
        if form.cdr is not None:
            analyzer.fail("~S takes no arguments: ~S", EXISTS, form)
        return Support("next_method_exists", [LocalVariable(function)])
    arguments = analyzer.arguments(form, env) if changes else [analyzer.form(variable, env) for variable in given]
    return CallLocal(function, arguments)
