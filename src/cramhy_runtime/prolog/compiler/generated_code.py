"""Python source while it is written: lines, functions, the constants in them, and the variables of their clause.

This is the part of the compiler of clauses that knows nothing of Prolog. `Source` collects the text of functions and compiles it. A
function may be written in the middle of another one, since the goals after a call need a function of their own.
"""

from __future__ import annotations

from cramhy_runtime.kernel.budget import budget
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.utilities.generated_functions import define_functions
from cramhy_runtime.utilities.lazy_lists import LazyTail
from cramhy_runtime.utilities.patterns import ANONYMOUS, same_atom, variable

from ..builtins import function_calls as lisp_calls
from ..engine import machine
from ..engine.list_shapes import index_key
from ..terms.terms import UNSET, TermTail, Var, deref, ground, undo, unify

GLOBALS = {
    "Cons": Cons,
    "new": Cons.__new__,
    "Var": Var,
    "UNSET": UNSET,
    "unify": unify,
    "undo": undo,
    "deref": deref,
    "ground": ground,
    "same_atom": same_atom,
    "LazyTail": LazyTail,
    "TermTail": TermTail,
    "index_key": index_key,
    "Symbol": Symbol,
    "fail": machine.fail,
    "proceed": machine.proceed,
    "settle": machine.settle,
    "give_up": machine.give_up,
    "budget": budget,
    "lisp_value": lisp_calls.lisp_value,
    "lisp_fun": lisp_calls.lisp_fun,
    "lisp_pred": lisp_calls.lisp_pred,
    "compare": lisp_calls.compare,
    "resolve_argument": lisp_calls.resolve_argument,
    "raw_argument": lisp_calls.raw_argument,
    "as_variable": lisp_calls.as_variable,
    "ONCE": (None,),
}


class Source:
    """The text of functions that belong together. ``emit`` adds a line to the function that is being written.

    ``failing`` is the statement that leaves on failure where the next line stands.
    """

    failing = "return fail(m)"

    def __init__(self, title):
        self.title = title
        self.functions, self.lines, self.depth = [], [], 0
        self.space = dict(GLOBALS)
        self.constants = {}
        self.owners = {}  # function name → the clause that it belongs to
        self.owner = None
        self.counter = 0

    def define(self, name, parameters, body):
        """Write the function ``name``; ``body()`` emits its lines."""
        outer = self.lines, self.depth
        self.lines, self.depth = [], 0
        body()
        self.functions.append((name, parameters.split(", "), self.lines))
        self.owners[name] = self.owner
        self.lines, self.depth = outer

    def emit(self, line):
        self.lines.append("    " * self.depth + line)

    def assign_arguments(self, given):
        """Emit the assignment of the expressions ``given`` to the arguments, for the next turn; ``None``: an argument stays as it is."""
        moved = [(f"a{i}", item) for i, item in enumerate(given) if item is not None and item != f"a{i}"]
        if moved:
            self.emit(f"{', '.join(a for a, _ in moved)} = {', '.join(item for _, item in moved)}")

    def fresh(self, prefix):
        """A new Python name."""
        self.counter += 1
        return f"{prefix}{self.counter}"

    def constant(self, value):
        """An expression for the Lisp data ``value``."""
        if value is None:
            return "None"
        if value is True:
            return "True"
        if value.__class__ is int and abs(value) < 2**31:
            return repr(value)
        name = self.constants.get(id(value))
        if name is None:
            name = self.constants[id(value)] = f"C{len(self.constants)}"
            self.space[name] = value
        return name

    def make(self):
        """Compile all functions and put them in ``space``, each with its clause."""
        define_functions(self.title, self.functions, self.space)
        for name, owner in self.owners.items():
            self.space[name].clause = owner


def is_ground(item):
    """Whether Lisp data, or a list of it, contains no variable."""
    stack = list(item) if isinstance(item, list) else [item]
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            stack.append(item.cdr)
            item = item.car
        if isinstance(item, (Rest, LazyTail)) or variable(item):
            return False
    return True


def variables(item, found=None):
    """The variables of Lisp data except ``?_``, as a dict in order of occurrence."""
    found = {} if found is None else found
    stack = [item]
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            stack.append(item.cdr)
            item = item.car
        if variable(item) and item is not ANONYMOUS:
            found.setdefault(item)
    return found


def proper(goal):
    """Whether ``goal`` is a proper list."""
    while isinstance(goal, Cons):
        goal = goal.cdr
    return goal is None


class Rest:
    """The variable after the dot of a clause head, for goals with ``count`` more arguments."""

    def __init__(self, name, count):
        self.name, self.count = name, count
