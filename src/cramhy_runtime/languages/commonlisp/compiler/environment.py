"""What a name means at a place in the program: the lexical environment of the compiler.

Variables, functions, blocks and tags have separate name spaces (Lisp-2), and all of them are lexically scoped. An `Env` is a
chain of scopes; looking a name up also notes *from where* it was used, because that decides how it can be compiled: a
variable used by an inner function is captured, a block left from an inner function needs an exception.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.packages import sym, symbol_name
from .core import HEADS
from .kinds import ANY

EXECUTE = {sym(":EXECUTE"), sym("EVAL")}
"""The situations of ``eval-when`` in which ``eval`` evaluates; a file is compiled and loaded at once, so it evaluates in all."""
SITUATIONS = EXECUTE | {sym(":LOAD-TOPLEVEL"), sym(":COMPILE-TOPLEVEL"), sym("LOAD"), sym("COMPILE")}


class FunctionScope:
    """One Python function to be generated. ``names`` (shared by the whole top-level form) keeps Python names unique."""

    def __init__(self, parent=None, names=None):
        self.parent = parent
        self.names = parent.names if parent else (names if names is not None else {})
        self.loop_depth = 0
        self.loops = False  # whether there is any tagbody in it
        self.catching_depth = 0
        self.nonlocals = set()
        self.exits_set = 0  # how many statements that leave a loop for an outer one have been generated
        self.frozen = {}  # variables of the parent that must be captured by value (see Variable.fresh)

    def unique(self, base):
        if base in HEADS:
            base += "_"
        count = self.names.get(base)
        self.names[base] = (count or 1) + 1 if count else 1
        if count is None:
            return base
        candidate = f"{base}_{count + 1}"
        return candidate if candidate not in self.names else self.unique(candidate)

    def path_to(self, owner):
        """The scopes from this one up to, but without, ``owner``."""
        path, scope = [], self
        while scope is not owner:
            path.append(scope)
            scope = scope.parent
        return path


class Variable:
    """A lexical variable: a Python local of ``owner``.

    A variable bound inside a loop and captured by a closure must be a new variable in each turn (``fresh``), while Python has
    one per function: then the closure receives its cell, or, when it is never assigned, its value, as a default argument.
    """

    special = False

    def __init__(self, symbol, owner, name=None):
        self.symbol = symbol
        self.owner = owner
        self.name = name or owner.unique(python_name(symbol_name(symbol)) or "v")
        self.in_loop = owner.loop_depth > 0
        self.captured = False
        self.assigned = False
        self.used = self.ignored = self.ignorable = False
        self.reads = self.writes = self.operand_uses = 0  # these and the next are found by ``facts.py``
        self.values = []
        self.kind = ANY
        self.raw = False  # whether a float that it holds stands for a double: see ``kinds.py``
        self.bits = self.never_negative = None  # asked for when code is made
        self.type = None  # the declared type, which assigned values are checked for
        self.proven = None  # the kind of a parameter whose type is checked on entry

    @property
    def fresh(self):
        return self.in_loop and self.captured

    @property
    def boxed(self):
        return self.fresh and self.assigned

    def used_from(self, scope, assign=False):
        self.used = True
        if assign:
            self.assigned = True
        if scope is not self.owner:
            self.captured = True
            path = scope.path_to(self.owner)
            path[-1].frozen[self] = True
            if assign:
                for inner in path:
                    inner.nonlocals.add(self)
        return self


class SpecialVariable:
    """A name that is bound dynamically at this place: declared or proclaimed special."""

    special = True

    def __init__(self, symbol):
        self.symbol = symbol


class SymbolMacro:
    def __init__(self, expansion):
        self.expansion = expansion


class LocalFunction:
    """A function of ``flet`` or ``labels``: the value of a variable. ``shape``: the calls that it takes.

    next: if it is ``call-next-method`` or ``next-method-p``, what it means (`open_coding.next_method`).
    """

    def __init__(self, variable, shape=None, next=None):
        self.variable = variable
        self.shape = shape
        self.next = next


class LocalMacro:
    def __init__(self, expander):
        self.expander = expander


def function_key(name):
    """What a function's name, a symbol or ``(setf symbol)``, is found by in a table."""
    return ("setf", name.cdr.car) if isinstance(name, Cons) else name


class _Exit:
    """A form that can be left from within: ``escapes`` when it is left from an inner function, which takes an exception."""

    def __init__(self, owner):
        self.owner = owner
        self.used = False
        self.escapes = False
        self.variable = None

    def used_from(self, scope):
        self.used = True
        if scope is not self.owner:
            self.escapes = True
            self.variable.used_from(scope)


class Block(_Exit):
    """A ``block`` with its name."""

    def __init__(self, symbol, owner):
        super().__init__(owner)
        self.symbol = symbol
        self.values = []  # what it is left with


class Tagbody(_Exit):
    """A ``tagbody``; its tags are (this, index). ``structured``: it became a loop of Python."""

    structured = False


class Env:
    """A lexical environment: the inner scope first.

    around: the next one outside that has functions, for few have. They are entered before an environment gets children.
    """

    __slots__ = ("parent", "around", "variables", "functions", "blocks", "tags", "scope")

    def __init__(self, parent=None, scope=None):
        self.parent = parent
        self.around = None if parent is None else parent if parent.functions else parent.around
        self.scope = scope or (parent.scope if parent else FunctionScope())
        self.variables = {}
        self.functions = {}
        self.blocks = {}
        self.tags = {}

    def child(self, scope=None):
        return Env(self, scope)

    def _find(self, table, name):
        env = self
        while env is not None:
            found = getattr(env, table).get(name)
            if found is not None:
                return found
            env = env.parent
        return None

    def variable(self, symbol):  # asked so often that it does not go through `_find`
        env = self
        while env is not None:
            found = env.variables.get(symbol)
            if found is not None:
                return found
            env = env.parent
        return None

    def function(self, name):
        found, env = self.functions.get(name), self.around
        while found is None and env is not None:
            found, env = env.functions.get(name), env.around
        return found

    def block(self, symbol):
        # nil as a block name is the key None, which a dictionary takes like any other
        return self._find("blocks", symbol)

    def tag(self, tag):
        return self._find("tags", tag)
