"""The bodies of operators in Hy: functions that a reader of the program does not see.

``(par (setv found "cup") (sleep 1))`` calls a function with two functions, one for each branch. For Python their variables are their
own, and a ``return`` ends such a function. A reader sees forms in a row. So the bodies are compiled as they are read:

* What a body assigns by ``setv``, ``setx``, ``+=``, ``del`` or ``defn`` is a variable of the function around the operator, if that
  function, or another body in it, has or reads a variable of that name. Otherwise it is the body's own: branches do not share what only
  they have. ``for``, ``with``, ``except`` and ``import`` bind variables of the body in any case, since branches at once would take them
  from each other.
* ``(return value)`` in a clause of ``with-failure-handling`` leaves that form, as ``return`` of Lisp does. In any other body it would
  end the body alone, and so would ``break`` and ``continue`` lose the loop around the operator, and ``yield`` make a generator of the
  body. They are refused. Only ``return`` may stand in an operator that is the last form of the function around it, whose value that is.

The macro ``_body`` stands in each such function before its forms. It leaves a `Mark` there, which `settle` finds when the whole form of
the file is compiled; only then is it known which variables there are. `settle` adds ``nonlocal`` and ``global`` to Python's syntax tree.
"""

from __future__ import annotations

import ast
import builtins

from hy import models
from hy.compiler import Result
from hy.errors import HySyntaxError
from hy.scoping import OuterVar, ScopeFn, ScopeGen, ScopeGlobal, ScopeLet

from ..operators import IN_PLACE as RUNS_IN_PLACE, TABLES

IN_PLACE = {name.lower() for table in TABLES for name, operator in table.items() if RUNS_IN_PLACE in operator.marks} | {"block"}
"""The operators that run their body where they stand, and whose value is the body's. A ``block`` is in what a definition stands for."""

CLAUSE = "clause of with-failure-handling"
"""What a handler of ``with-failure-handling`` is called: its ``return`` leaves the form."""

HIDDEN = models.Expression(map(models.Symbol, (".", "hy", "R", "cramhy", "_body")))


def hidden(function, operator):
    """The Hy form of ``function``, a ``(fn [...] form...)``, as the body of the operator of that name, or as a `CLAUSE`."""
    head, parameters, *forms = function
    return models.Expression([head, parameters, models.Expression([HIDDEN, models.String(operator), *forms])])


class Mark(ast.Pass):
    """Stands for the beginning of a body. ``operator``: whose; ``compiler``: Hy's; ``generators``: how many of Hy's functions for
    comprehensions are around it, up to the user's function."""

    def __init__(self, operator, compiler, generators):
        super().__init__(lineno=1, col_offset=0)
        self.operator, self.compiler, self.generators = operator, compiler, generators


class BodyScope(ScopeFn):
    """What Hy knows of the variables of a body: those of a ``let`` around the operator are assigned, where a function would hide them.

    scope: that of the function that the body is for Hy. It is the same scope by another class: what one of them learns, both know.
    """

    def __init__(self, scope):
        self.__dict__ = vars(scope)
        self.parameters = frozenset(self.defined)

    def assign(self, node, index=None):
        name = getattr(node, "name", None) or getattr(node, "id", None)
        if name not in self.defined:
            scope = self.parent
            while isinstance(scope, (ScopeLet, ScopeGen, BodyScope)):
                if isinstance(scope, ScopeLet) and name in scope.bindings:
                    return self.access(node, *(() if index is None else (index,)))
                if isinstance(scope, BodyScope) and name in scope.parameters or isinstance(scope, ScopeGen) and name in scope.iterators:
                    break
                scope = scope.parent
            if name in getattr(scope, "nonlocal_vars", ()) and not isinstance(scope, ScopeGlobal):
                return self.access(node, *(() if index is None else (index,)))
        return super().assign(node)


def body(_hy_compiler, operator, *forms):
    """The macro around the forms of a body: what Hy's compiler makes of them, behind a `Mark` where there is something to settle."""
    scope = _hy_compiler.scope
    _hy_compiler.scope = BodyScope(scope) if type(scope) is ScopeFn else scope
    try:
        made = _hy_compiler._compile_branch(forms)
    finally:
        _hy_compiler.scope = scope
    if made.stmts or made.expr is not None and any(isinstance(node, _SETTLED) for node in _own(made.expr)):
        for statement in made.stmts:
            for node in _own(statement):
                if isinstance(node, ast.Return):
                    node.by_user = True
        expression, made.expr = made.expr, None
        marked = Result(stmts=[Mark(str(operator), _hy_compiler, _generators(scope))]) + made
        return marked if expression is None else marked + Result(expr=expression)
    return made


def _generators(scope):
    found, scope = 0, scope.parent
    while isinstance(scope, (ScopeLet, ScopeGen)):
        found += isinstance(scope, ScopeGen)
        scope = scope.parent
    return found


MACROS = {"_body": body}

# --------------------------------------------------------------------------------------------------------- Python's syntax tree

_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
_SCOPES = (*_FUNCTIONS, ast.ClassDef)
_COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
_YIELDS = (ast.Yield, ast.YieldFrom, ast.Await)
_SETTLED = (ast.NamedExpr, *_YIELDS)


def _own(node):
    """``node`` and what is in it, without what is in other functions."""
    rest = [node]
    while rest:
        node = rest.pop()
        yield node
        if not isinstance(node, _SCOPES):
            rest += ast.iter_child_nodes(node)


class Variables:
    """The names in one function, class, comprehension or module, and in those inside of it.

    node: its syntax tree. around: the `Variables` around it. mark: its `Mark` if it is the body of an operator.
    """

    def __init__(self, node, around=None):
        self.node, self.around, self.inside = node, around, []
        self.mark = next((each for each in getattr(node, "body", None) or () if isinstance(each, Mark)), None) if _is_def(node) else None
        self.read, self.assigned, self.bound, self.parameters = set(), set(), set(), set()
        self.declared = {}  # name → the statement that declares it ``nonlocal`` or ``global``
        if around is not None:
            around.inside.append(self)

    @property
    def is_function(self):
        return isinstance(self.node, _FUNCTIONS)

    def has(self):
        """The names of the variables that stand in this function as its own, or are declared in it."""
        return self.parameters | self.bound | self.assigned | self.declared.keys()

    def made(self):
        """The names that this function assigns, or that a body in it does."""
        inner = (each.made() for each in self.inside if each.mark is not None or isinstance(each.node, _COMPREHENSIONS))
        return self.assigned.union(*inner)

    def free(self):
        """The names that this function, or one in it, reads, and that are the variables of a function around it."""
        return self.reads() - self.parameters - self.bound - self.made() | self.declared.keys()

    def reads(self):
        return self.read.union(*(each.free() for each in self.inside))

    # ---------------------------------------------------------------------------------------------------------- collecting

    def add(self, node):
        """Enter the names in ``node``, which stands in this function."""
        if isinstance(node, _SCOPES):
            self._scope(node)
        elif isinstance(node, _COMPREHENSIONS):
            inner = Variables(node, self)
            for part in ast.iter_child_nodes(node):
                inner.add(part)
        elif isinstance(node, ast.NamedExpr):
            holder = self
            while isinstance(holder.node, _COMPREHENSIONS):
                holder = holder.around
            holder.assigned.add(node.target.id)
            self.add(node.value)
        elif isinstance(node, ast.Name):
            (self.read if isinstance(node.ctx, ast.Load) else self.assigned).add(node.id)
        elif isinstance(node, (ast.Global, ast.Nonlocal, OuterVar)):
            self.declared.update(dict.fromkeys(node.names, node))
        else:
            for field, part in ast.iter_fields(node):
                if field in ("target", "optional_vars") and isinstance(node, (ast.For, ast.AsyncFor, ast.withitem, ast.comprehension)):
                    self.bound.update(each.id for each in ast.walk(part or ast.Pass()) if isinstance(each, ast.Name))
                elif field in ("name", "rest", "asname") and isinstance(part, str) and not isinstance(node, ast.alias):
                    self.bound.add(part)  # of except and match
                else:
                    for each in part if isinstance(part, list) else [part]:
                        if isinstance(each, ast.alias):
                            self.bound.add((each.asname or each.name).partition(".")[0])
                        elif isinstance(each, ast.AST):
                            self.add(each)

    def _scope(self, node):
        if not isinstance(node, ast.Lambda):
            self.assigned.add(node.name)
        inner = Variables(node, self)
        for field, part in ast.iter_fields(node):
            if field == "args":
                inner.parameters.update(each.arg for each in ast.walk(part) if isinstance(each, ast.arg))
                for default in [*part.defaults, *part.kw_defaults]:
                    if default is not None:
                        self.add(default)
                continue
            for each in part if isinstance(part, list) else [part]:
                if isinstance(each, ast.AST):
                    (inner if field == "body" else self).add(each)

    # ------------------------------------------------------------------------------------------------------------ settling

    def settle(self, known):
        """Say in the bodies whose variables they assign, and refuse what would end in them."""
        if self.mark is not None:
            self.mark_replaced(self._declarations(known))
        for each in self.inside:
            each.settle(known)

    def mark_replaced(self, declarations):
        body, place = self.node.body, self.node.body.index(self.mark)
        where = body[place + 1] if place + 1 < len(body) else self.node
        body[place : place + 1] = [ast.fix_missing_locations(ast.copy_location(each, where)) for each in declarations]
        if not body:
            body.append(ast.copy_location(ast.Pass(), self.node))

    def _declarations(self, known):
        found = []
        for name in sorted(self.assigned - self.parameters - self.declared.keys()):
            owner = self._owner(name, known)
            if owner is not None:
                said = owner.declared.get(name) or (ast.Nonlocal if owner.is_function else ast.Global)([name])
                if isinstance(said, OuterVar):  # Hy will find out which of the two it is
                    said = OuterVar(said, said._scope, [name])
                self.declared[name] = said
                found.append(type(said)([name]) if isinstance(said, (ast.Nonlocal, ast.Global)) else said)
                if owner.is_function and name not in owner.has():
                    owner.make(name)
        return found

    def _owner(self, name, known):
        """The outermost `Variables` around this body that have the variable ``name``; ``None`` if it is the body's own."""
        owner, scope, in_place, skip = None, self, True, 0
        while True:
            if scope.mark is not None:
                in_place, skip = in_place and scope.mark.operator in IN_PLACE, scope.mark.generators
                if scope is not self and name in scope.parameters | (scope.bound - scope.assigned):
                    return scope
            scope = scope.around
            while skip and scope.is_function and scope.mark is None:  # a function that Hy made of a comprehension
                scope, skip = scope.around, skip - 1
            while isinstance(scope.node, _COMPREHENSIONS):
                scope = scope.around
            if isinstance(scope.node, ast.ClassDef):
                return owner
            if not scope.is_function:
                theirs = in_place and not name.startswith("_hy_")
                return scope if theirs or name in known or name in scope.has() or name in scope.reads() else owner
            if name in scope.has() or name in scope.reads() and name not in known and not hasattr(builtins, name):
                owner = scope
            if scope.mark is None:
                return owner

    def make(self, name):
        """Let the function have a variable ``name``: an annotation does, and takes no time."""
        self.assigned.add(name)
        target = ast.AnnAssign(ast.Name(name, ast.Store()), ast.Constant(None), None, 1)
        place = next((number + 1 for number, each in enumerate(self.node.body) if isinstance(each, Mark)), 0)
        self.node.body.insert(place, ast.fix_missing_locations(ast.copy_location(target, self.node.body[0])))


def _is_def(node):
    return isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))


def settle(statements, known):
    """Finish the bodies of operators in ``statements``, which Hy's compiler made of a form.

    known: the names that the module has already; a function that only reads one of them means the module's variable.
    """
    if not any(isinstance(node, Mark) for statement in statements for node in ast.walk(statement)):
        return
    module = Variables(ast.Module([], []))
    for statement in statements:
        Exits(None).visit(statement)
        module.add(statement)
    module.settle(known)


class Exits(ast.NodeTransformer):
    """Goes through a function, or a body. ``mark``: of the body; in_loop: whether a loop of it is around; last: whether it is what the
    function around it returns."""

    def __init__(self, mark, last=False):
        self.mark, self.last, self.loops = mark, last, 0

    def visit_FunctionDef(self, node):
        mark = next((each for each in node.body if isinstance(each, Mark)), None)
        last = mark is not None and mark.operator in IN_PLACE and getattr(node, "is_last", False)
        if (last or mark is None) and node.body and isinstance(node.body[-1], ast.Return):
            _note_last(node)
        inner = Exits(mark, last)
        node.body = [each for statement in node.body for each in _listed(inner.visit(statement))]
        return node

    visit_AsyncFunctionDef = visit_FunctionDef

    def visit_Lambda(self, node):
        node.body = Exits(None).visit(node.body)
        return node

    def visit_ClassDef(self, node):
        inner = Exits(None)
        node.body = [each for statement in node.body for each in _listed(inner.visit(statement))]
        return node

    def _loop(self, node):
        self.loops += 1
        self.generic_visit(node)
        self.loops -= 1
        return node

    visit_For = visit_While = visit_AsyncFor = _loop

    def visit_Return(self, node):
        self.generic_visit(node)
        if self.mark is None or not hasattr(node, "by_user") or self.last:
            return node
        if self.mark.operator == CLAUSE:
            leave = ast.Call(ast.Name("leave", ast.Load()), [node.value or ast.Constant(None)], [])
            return ast.fix_missing_locations(ast.copy_location(ast.Expr(leave), node))
        if self.mark.operator in ("with-failure-handling", "try-in-order", "try-each-in-order", "with-parallel-childs"):
            remedy = "(leave value) leaves the operator with that value."
        elif self.mark.operator in IN_PLACE:
            remedy = "Let the value be that of the last form of the body, and return what the operator gives."
        else:
            remedy = "Keep the value by setv, or let it be that of the last form of the body."
        self._refuse(node, "return", f"ends the body alone, and not the function around {self.mark.operator}.", remedy)

    def _jump(self, node):
        if self.mark is not None and not self.loops:
            word = type(node).__name__.lower()
            why = f"is in no loop of that body; a loop around {self.mark.operator} cannot be reached from it."
            self._refuse(node, word, why, f"Note it by (setv left True), and write (when left ({word})) behind the operator.")
        return node

    visit_Break = visit_Continue = _jump

    def _yields(self, node):
        if self.mark is not None:
            word = "await" if isinstance(node, ast.Await) else "yield"
            why = {
                "yield": f"makes a generator of the body alone, which nobody runs, and not of the function around {self.mark.operator}.",
                "await": "is for functions of asyncio, and a plan waits without it: plan forms in the body park its task.",
            }[word]
            remedy = {
                "yield": "Collect the values in a list, or call a function that yields.",
                "await": "Await it before the operator, or call asyncio.run by run_blocking.",
            }[word]
            self._refuse(node, word, why, remedy)
        return self.generic_visit(node)

    visit_Yield = visit_YieldFrom = visit_Await = _yields

    def _refuse(self, node, word, why, remedy):
        compiler, operator = self.mark.compiler, self.mark.operator
        where = f"a {operator}" if operator == CLAUSE else f"the body of {operator}"
        text = f"({word}) in {where} {why}\n{remedy}"
        raise HySyntaxError(text, None, compiler.filename, compiler.source, node.lineno, node.col_offset + 1)


def _listed(made):
    return made if isinstance(made, list) else [] if made is None else [made]


def _note_last(function):
    """Tell those bodies that are arguments of the call whose value ``function`` returns."""
    value = function.body[-1].value
    names = {each.id for each in value.args if isinstance(each, ast.Name)} if isinstance(value, ast.Call) else ()
    for statement in function.body:
        if _is_def(statement) and statement.name in names:
            statement.is_last = True


__all__ = ["CLAUSE", "MACROS", "hidden", "settle"]
