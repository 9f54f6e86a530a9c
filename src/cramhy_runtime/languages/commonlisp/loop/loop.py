"""LOOP: from the sentence to the loop.

``(loop for x in list when (oddp x) collect x)`` is read clause by clause, left to right, and every clause contributes to the
parts of one loop, as in the MIT LOOP that SBCL and the standard build on:

    (block NAME
      (let* (BINDINGS...)
        (tagbody
          PROLOGUE...           initially
          FIRST...              tests and settings before the first turn
         next-loop
          COMMON...             what FIRST and NEXT end in alike, once
          BODY...               do, collect, when, ...
          NEXT...               tests and settings before the other turns
          (go next-loop)
         end-loop
          EPILOGUE...)          finally
        RESULT))

A ``while`` or ``until`` that comes before any other body clause belongs to FIRST and NEXT, so that it guards the ``for`` clauses
behind it. The parts are: tokens and complaints in ``loop_tokens.py``, ``for``, ``as``, ``with`` and ``repeat`` in
``loop_iteration.py``, ``collect`` and its kin in ``loop_accumulation.py``, what runs inside a loop in ``loop_support.py``. Loop
keywords are recognized by name, in any package. Source: ANSI 6.1; message texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from
from ..syntax.lambda_lists import gensym
from cramhy_runtime.lisp_core.packages import is_symbol, sym, symbol_name
from . import loop_accumulation, loop_iteration
from .loop_support import END_LOOP, NEXT_LOOP
from .loop_tokens import Tokens

BLOCK, TAGBODY, GO, IF, LET, LET_STAR, PROGN, DECLARE, IGNORABLE = map(sym, "BLOCK TAGBODY GO IF LET LET* PROGN DECLARE IGNORABLE".split())
RETURN_FROM, MACROLET, QUOTE, LOOP_FINISH, NOT = map(sym, "RETURN-FROM MACROLET QUOTE LOOP-FINISH NOT".split())


def expand(forms):
    """The form that the loop with the clauses or forms ``forms``, a list, stands for."""
    items = list(forms or ())
    if all(isinstance(item, Cons) for item in items):
        return _simple(items)
    return Loop(items).form()


def _simple(forms):
    again = gensym("NEXT")
    return lisp_list(BLOCK, None, lisp_list(TAGBODY, again, *forms, lisp_list(GO, again)))


class Loop:
    """A loop being put together; the clauses add to its lists."""

    def __init__(self, items):
        self.tokens = Tokens(items)
        self.items = items
        self.name = None
        self.groups = []  # bindings: lists of (variable, form), each made in parallel, one after the other
        self.variables = set()
        self.prologue, self.first, self.next, self.epilogue = [], [], [], []
        self.body = []
        self.target = self.body
        self.body_begun = False
        self.conditional = None  # the keyword of the innermost conditional clause around
        self.it = None
        self.it_used = False
        self.accumulators = {}
        self.aggregates = False  # whether a clause such as ALWAYS decides about the value
        self.default_result = None

    # ------------------------------------------------------------------------------------------------------------- clauses

    def form(self):
        """Read all clauses and return the form."""
        tokens = self.tokens
        while tokens:
            self.clause()
        return self.assemble()

    def value_form(self):
        """The form of a clause that may say ``it`` for the value of the test around it."""
        tokens = self.tokens
        if self.it is not None and tokens and tokens.next_is("IT"):
            tokens.take()
            self.it_used = True
            return self.it
        return tokens.form()

    def clause(self):
        tokens = self.tokens
        tokens.begin_clause()
        keyword = tokens.keyword("LOOP keyword")
        handler = CLAUSES.get(keyword)
        if handler is None:
            if keyword in ("ELSE", "AND", "END"):
                tokens.fail("secondary clause misplaced at top level in LOOP macro: ~A", keyword)
            tokens.unknown(keyword, CLAUSES)
        handler(self, keyword)

    def emit(self, form):
        """Add ``form`` to the body, or to the conditional clause being read."""
        self.body_begun = True
        self.target.append(form)

    def leave(self, value):
        return lisp_list(RETURN_FROM, self.name, value)

    def bind(self, bindings):
        """Bind variables: ``bindings`` are (variable, form) made in parallel, after all earlier ones."""
        for variable, _ in bindings:
            if is_symbol(variable) and symbol_name(variable) and variable in self.variables:
                self.tokens.fail("Duplicated variable ~S", variable)
            self.variables.add(variable)
        if bindings:
            self.groups.append(list(bindings))

    def temporary(self, prefix, form=None):
        """A new variable, bound to the value of ``form`` at the start."""
        variable = gensym(prefix)
        self.bind([(variable, form)])
        return variable

    # ------------------------------------------------------------------------------------------------------------ assembly

    def assemble(self):
        first, after = self.first, self.next
        common = 0
        while common < min(len(first), len(after)) and first[-1 - common] is after[-1 - common]:
            common += 1
        shared = first[len(first) - common :]
        first, after = first[: len(first) - common], after[: len(after) - common]
        tagbody = lisp_list(
            TAGBODY, *self.prologue, *first, NEXT_LOOP, *shared, *self.body, *after, lisp_list(GO, NEXT_LOOP), END_LOOP, *self.epilogue
        )
        result = loop_accumulation.result(self)
        inner = [tagbody] if result is None else [tagbody, result]
        for bindings in self._nested_bindings():
            unread = lisp_list(DECLARE, Cons(IGNORABLE, list_from([binding.car for binding in bindings[1] or ()])))
            inner = [Cons(bindings[0], Cons(bindings[1], Cons(unread, list_from(inner))))]
        if _mentions(self.items, LOOP_FINISH):
            finish = lisp_list(LOOP_FINISH, None, lisp_list(QUOTE, lisp_list(GO, END_LOOP)))
            inner = [Cons(MACROLET, Cons(lisp_list(finish), list_from(inner)))]
        return Cons(BLOCK, Cons(self.name, list_from(inner)))

    def _nested_bindings(self):
        """(operator, binding list), innermost first; groups of one variable are joined to a LET*."""
        nested = []
        for group in self.groups:
            if len(group) == 1 and nested and nested[-1][0] is LET_STAR:
                nested[-1][1].extend(group)
            else:
                nested.append((LET_STAR if len(group) == 1 else LET, list(group)))
        return [(operator, list_from([lisp_list(*pair) for pair in pairs])) for operator, pairs in reversed(nested)]


def _mentions(items, symbol):
    pending, seen = list(items), set()
    while pending:
        item = pending.pop()
        if item is symbol:
            return True
        if isinstance(item, Cons) and id(item) not in seen:
            seen.add(id(item))
            pending += [item.car, item.cdr]
    return False


# --------------------------------------------------------------------------------------------------------- simple clauses


def _do(loop, keyword):
    for form in loop.tokens.compound_forms():
        loop.emit(form)


def _initially(loop, keyword):
    _top_level_only(loop, keyword)
    loop.prologue.extend(loop.tokens.compound_forms())


def _finally(loop, keyword):
    _top_level_only(loop, keyword)
    loop.epilogue.extend(loop.tokens.compound_forms())


def _named(loop, keyword):
    _top_level_only(loop, keyword)
    name = loop.tokens.take()
    if not is_symbol(name):
        loop.tokens.fail("~S is an invalid name for your LOOP", name)
    if loop.body_begun or loop.groups or loop.first or loop.prologue or loop.epilogue:
        loop.tokens.fail("The NAMED ~S clause occurs too late.", name)
    loop.name = name


def _return(loop, keyword):
    loop.emit(loop.leave(loop.value_form()))


def _while(loop, keyword):
    _top_level_only(loop, keyword)
    test, leave = loop.tokens.form(), lisp_list(GO, END_LOOP)
    form = lisp_list(IF, test, None, leave) if keyword == "WHILE" else lisp_list(IF, test, leave, None)
    if loop.body_begun:
        loop.emit(form)
    else:
        loop.first.append(form)
        loop.next.append(form)


def _always(loop, keyword):
    test, leave = loop.tokens.form(), loop.leave(None)
    _aggregate(loop, keyword)
    loop.emit(lisp_list(IF, test, None, leave) if keyword == "ALWAYS" else lisp_list(IF, test, leave, None))
    loop.default_result = True


def _thereis(loop, keyword):
    found, form = gensym("FOUND"), loop.tokens.form()
    _aggregate(loop, keyword)
    loop.emit(lisp_list(LET, lisp_list(lisp_list(found, form)), lisp_list(IF, found, loop.leave(found), None)))


def _aggregate(loop, keyword):
    """Note a clause that decides about the value of the loop; there may be none that accumulates it, too (ANSI 6.1.4)."""
    _top_level_only(loop, keyword)
    if None in loop.accumulators:
        loop.tokens.fail("This LOOP clause is not permitted with anonymous collectors.", hint=loop_accumulation.WITH_INTO)
    loop.aggregates = True


def _top_level_only(loop, keyword):
    if loop.conditional is not None:
        loop.tokens.fail("~A does not introduce a LOOP clause that can follow ~A.", keyword, loop.conditional)


def _conditional(loop, keyword):
    """``if``, ``when``, ``unless``: a test, clauses joined by ``and``, perhaps ``else`` and more of them, perhaps ``end``."""
    tokens = loop.tokens
    test = tokens.form()
    outer = loop.it, loop.it_used, loop.target, loop.conditional
    it = gensym("IT")
    loop.it, loop.it_used, loop.conditional = it, False, keyword

    def clauses():
        loop.target = []
        while True:
            inner = tokens.keyword("LOOP keyword")
            handler = CLAUSES.get(inner)
            if handler is None:
                tokens.unknown(inner, CLAUSES)
            handler(loop, inner)
            loop.it = None  # only the first clause may say IT
            if not (tokens and tokens.next_is("AND")):
                return _progn(loop.target)
            tokens.take()

    consequent, alternative = clauses(), None
    if tokens and tokens.next_is("ELSE"):
        tokens.take()
        alternative = clauses()
    if tokens and tokens.next_is("END"):
        tokens.take()
    used = loop.it_used
    loop.it, loop.it_used, loop.target, loop.conditional = outer
    condition = it if used else test
    form = lisp_list(IF, condition, alternative, consequent) if keyword == "UNLESS" else lisp_list(IF, condition, consequent, alternative)
    loop.emit(lisp_list(LET, lisp_list(lisp_list(it, test)), form) if used else form)


def _progn(forms):
    return forms[0] if len(forms) == 1 else Cons(PROGN, list_from(forms))


CLAUSES = {
    "NAMED": _named,
    "INITIALLY": _initially,
    "FINALLY": _finally,
    "DO": _do,
    "DOING": _do,
    "RETURN": _return,
    "WHILE": _while,
    "UNTIL": _while,
    "ALWAYS": _always,
    "NEVER": _always,
    "THEREIS": _thereis,
    "IF": _conditional,
    "WHEN": _conditional,
    "UNLESS": _conditional,
    **{name: (lambda loop, keyword: (_top_level_only(loop, keyword), loop_iteration.for_clause(loop, keyword))) for name in ("FOR", "AS")},
    "WITH": lambda loop, keyword: (_top_level_only(loop, keyword), loop_iteration.with_clause(loop)),
    "REPEAT": lambda loop, keyword: (_top_level_only(loop, keyword), loop_iteration.repeat_clause(loop)),
    **{name: loop_accumulation.clause for name in loop_accumulation.KINDS},
}
"""What each loop keyword that can begin a clause does."""
