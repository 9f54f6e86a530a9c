"""The program between reading and generating: what each form means, with all macros expanded and all names resolved.

A node is one meaning. ``single`` says that it never returns several values, so that no `one` is needed around it;
``boolean`` that it returns only ``t`` or ``nil``. ``position`` is (line, column, end line, end column) in the user's text.
"""

from __future__ import annotations

from cramhy_runtime.utilities.records import dataclass, field


@dataclass
class Node:
    single = False
    boolean = False
    position = None


@dataclass
class Constant(Node):
    """A quoted or self-evaluating object."""

    value: object
    single = True


@dataclass
class LocalVariable(Node):
    variable: object
    single = True


@dataclass
class GlobalVariable(Node):
    """A special variable, or a name not known to be anything: read at run time, an error if unbound."""

    symbol: object
    single = True


@dataclass
class SetLocal(Node):
    variable: object
    value: Node
    single = True


@dataclass
class SetGlobal(Node):
    symbol: object
    value: Node
    single = True


@dataclass
class Checked(Node):
    """``value``, the first of whose values must be of the declared ``type``. ``place``: the variable that is bound to it.

    entry: whether it is the check of a parameter, on which rests what the rest of the function takes for proven.
    """

    value: Node
    type: object
    place: object = None
    entry: bool = False

    @property
    def single(self):
        return self.value.single


@dataclass
class Call(Node):
    """A call of the global function of ``symbol``."""

    symbol: object
    arguments: list


@dataclass
class CallLocal(Node):
    """A call of a function of ``flet`` or ``labels``."""

    variable: object
    arguments: list


@dataclass
class CallValue(Node):
    """``funcall``: a call of the value of a form."""

    function: Node
    arguments: list


@dataclass
class CallSetf(Node):
    """A call of the function ``(setf name)``: the new value is the first argument."""

    symbol: object
    arguments: list


@dataclass
class CallSpread(Node):
    """A call whose arguments are all values of forms (``multiple-value-call``), or ``apply`` with ``spread_last``."""

    function: Node
    arguments: list


@dataclass
class Support(Node):
    """A call of a function of ``compiler/support.py``, by name."""

    name: str
    arguments: list
    single: bool = True


@dataclass
class FunctionReference(Node):
    """``#'name`` of a global function; ``setf`` for ``#'(setf name)``."""

    symbol: object
    setf: bool = False
    single = True


@dataclass
class Lambda(Node):
    """A function. ``body`` is a node; parameters as in `Parameters`; ``everywhere``: it is the global function of its name."""

    name: object
    parameters: Parameters
    body: Node
    scope: object
    documentation: object = None
    python_name: str = None
    everywhere = False
    single = True


@dataclass
class Parameters:
    """The parameters of a function after analysis.

    required: variables. optional and key: (variable, default node or None, supplied-p variable or None[, keyword]).
    ``specials`` are (special symbol, variable) pairs to bind on entry; ``auxiliary`` is folded into the body.
    """

    required: list = field(default_factory=list)
    optional: list = field(default_factory=list)
    rest: object = None
    keys: list = field(default_factory=list)
    has_keys: bool = False
    allow_other_keys: bool = False


@dataclass
class Progn(Node):
    forms: list


@dataclass
class If(Node):
    test: Node
    then: Node
    otherwise: Node


@dataclass
class Let(Node):
    """Bindings, evaluated in order, then all made; ``bindings`` is a list of (Variable or special Symbol, node)."""

    bindings: list
    body: Node


@dataclass
class Functions(Node):
    """``flet`` and ``labels``: (Variable, Lambda) pairs."""

    functions: list
    body: Node


@dataclass
class BlockNode(Node):
    block: object
    body: Node


@dataclass
class ReturnFrom(Node):
    block: object
    value: Node


@dataclass
class TagbodyNode(Node):
    """``segments`` are lists of nodes; segment 0 comes before the first tag."""

    tagbody: object
    segments: list
    single = True


@dataclass
class Each(Node):
    """``body`` for each item that ``source``, a function of ``compiler/support.py``, gives for a sequence. It is the value of the variable,
    or a tuple of the values of several."""

    variables: list
    sequence: Node
    body: Node
    source: str
    context: str
    single = True


@dataclass
class Go(Node):
    tagbody: object
    index: int


@dataclass
class UnwindProtect(Node):
    body: Node
    cleanup: Node


@dataclass
class Catching(Node):
    """``handler-case``: type specifiers (a Lisp list), the form, a variable for the condition, and a node for each clause."""

    types: object
    form: Node
    condition: object
    clauses: list


@dataclass
class Handling(Node):
    """``handler-bind``: type specifiers, the forms of their functions, and the body."""

    types: list
    functions: list
    body: Node


@dataclass
class MultipleValueBind(Node):
    variables: list
    values: Node
    body: Node


@dataclass
class MultipleValueProg1(Node):
    first: Node
    rest: list


@dataclass
class LoadTimeValue(Node):
    node: Node
    single = True
