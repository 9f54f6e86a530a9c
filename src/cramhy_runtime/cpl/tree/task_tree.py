"""The task tree: where in a plan each task belongs.

A path is a Lisp list of parts, the deepest first: ``((tagged a) (drive-home) (top-level lecture))``. A node of the tree stands for a
path. It holds the code that runs there and the task that ran it last. So users can look at a plan during and after its run, and
replace a step for the next run. Repetitions of a part go to sibling nodes ``(a :call 2)``. Source: cpl.md section 7.
"""

from __future__ import annotations


from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.utilities import patterns
from cramhy_runtime.lisp_core.conditions import as_name, error, type_error
from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from, python_list, truth
from cramhy_runtime.lisp_core.packages import keyword
from . import finished_plans
from ..tasks.branches import run_one
from ..hooks import on_finishing_task_execution, on_preparing_task_execution
from ..symbols import sym
from ..current import current_task
from ..statuses import CREATED
from ..tasks.tasks import Task
from ..type_checks import of, parts_of

CALL = keyword("CALL")
_goal_marks = (sym("CPL-IMPL::GOAL"), sym("CPL-IMPL::GOAL-CONTEXT"))
_named_trees = per_image({})


class Code:
    """The code of a node: the form ``sexp``, the ``function`` made from it, the ``task`` that runs it, and its ``parameters``.

    For a goal, ``called_with`` are the arguments of the call, and the parameters are the values of the pattern's variables.
    """

    __slots__ = ("sexp", "function", "task", "parameters", "called_with")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::CODE"

    def __init__(self, sexp=None, function=None, task=None, parameters=None):
        self.sexp, self.function, self.task, self.parameters = sexp, function, task, parameters
        self.called_with = None

    def copy(self):
        """The same code, in an object of its own."""
        made = Code(self.sexp, self.function, self.task, self.parameters)
        made.called_with = self.called_with
        return made


class TaskTreeNode:
    """A node: its ``path``, ``code``, ``replacements`` (newest first), ``parent`` and ``children`` (path part to node, in order)."""

    __slots__ = ("path", "code", "replacements", "parent", "children", "calls", "__weakref__")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::TASK-TREE-NODE"

    def __init__(self, path=None, parent=None, code=None):
        self.path, self.parent, self.code = path, parent, code
        self.replacements = []
        self.children = {}
        self.calls = 1  # repetitions of this part known to be taken

    @property
    def effective_code(self):
        """The code that runs here: the newest replacement, or else the node's own."""
        return self.replacements[0] if self.replacements else self.code

    @property
    def code_replacements(self):
        """The codes that replace the node's own, a Lisp list, the newest first."""
        return list_from(self.replacements)

    @code_replacements.setter
    def code_replacements(self, codes):
        self.replacements = python_list(codes)

    @property
    def children_alist(self):
        """Its children as an alist from path part to node, the newest first."""
        return list_from([Cons(child.path.car, child) for child in reversed(self.children.values())])

    @children_alist.setter
    def children_alist(self, alist):
        self.children = {_key(pair.car): pair.cdr for pair in reversed(python_list(alist))}

    def child(self, part, make=True):
        """The child node for the path part ``part`` (a Lisp list). If there is none, it is made, or with ``make`` false ``None``."""
        key = _key(part)
        node = self.children.get(key)
        if node is None and make:
            node = self.children[key] = TaskTreeNode(Cons(part, self.path), self)
        return node


def _key(part):
    if part.__class__ is not Cons:
        return part
    items = []
    while part.__class__ is Cons:
        element = part.car
        items.append(_key(element) if element.__class__ is Cons else element)
        part = part.cdr
    items.append(None)
    return tuple(items)


def ensure_node(path, tree):
    """The node for ``path`` below ``tree``. It and the nodes above it are made as needed."""
    node = tree
    for part in reversed(parts_of(path)):
        node = node.child(part)
    return node


def task_tree_node(path, node=None):
    """``(task-tree-node path)``: the node of a path below ``node`` (default: the tree of the current plan), or nil."""
    node = node or current_tree()
    if node is not None and not isinstance(node, TaskTreeNode):
        return type_error(node, "TASK-TREE-NODE")
    for part in reversed(parts_of(path)):
        if node is None:
            return None
        node = node.child(part, make=False)
    return node


def current_tree():
    """The task tree of the plan that runs, or nil."""
    task = current_task()
    return task.tree if task is not None else None


def current_path():
    """The path of the current task, or nil."""
    task = current_task()
    return task.path if task is not None else None


def _tree_or_error():
    tree = current_tree()
    if tree is None:
        type_error(
            None,
            "TASK-TREE-NODE",
            "\n(A plan function, goal or tag was used outside of a plan: call it inside (top-level ...), or from a function "
            "defined with def-top-level-cram-function.)",
        )
    return tree


def _current_node():
    """The node that the current task belongs to."""
    task = current_task()
    if task.node is None:
        task.node = ensure_node(task.path, _tree_or_error())
    return task.node


def _next_free(part, above):
    """The node for ``part`` below the node ``above``, or for its next repetition if the task there was executed already."""
    key, children = _key(part), above.children
    node = children.get(key)
    if node is None:
        node = children[key] = TaskTreeNode(Cons(part, above.path), above)
    elif _taken(node):
        first, number = node, node.calls
        start = key[:-1] if part.__class__ is Cons else ()
        while node is not None and _taken(node):
            number += 1
            key = (*start, CALL, number, None)
            node = children.get(key)
        first.calls = number
        if node is None:
            again = list_from(python_list(part), lisp_list(CALL, number))
            node = children[key] = TaskTreeNode(Cons(again, above.path), above)
    return node


def _taken(node):
    code = node.effective_code
    return code is not None and code.task is not None and not code.task.unexecuted


def make_task(*, name=None, sexp=None, function=None, path=None, parameters=None):
    """The task of the node for ``path`` (default: the current path), not executed yet. It is made if necessary.

    If the node's task has run already, it is the task of the next iteration path. A replacement of the node's code is used instead of
    the code. An empty path is an error. Source: cpl.md 7.5.
    """
    path = path or current_path()
    if not parts_of(path):
        error("There is no task at the root of the task tree: a path has one part at least.")
    task = _task_of(_next_free(path.car, ensure_node(path.cdr, _tree_or_error())), name, sexp, function, parameters)
    if finished_plans.observers.value:
        finished_plans.made(task)
    return task


def _task_of(node, name=None, sexp=None, function=None, parameters=None, called_with=None):
    code = node.effective_code
    if code is None:
        code = node.code = Code()
    replaced = code is not node.code
    if sexp is not None and not replaced:
        code.sexp = sexp
    if function is not None and not replaced:
        code.function = function
    if function is not None or parameters is not None:  # a call, and not only a name for the task
        code.parameters, code.called_with = parameters, called_with
    task = code.task
    if task is None:
        task = code.task = Task(None, name or (lambda: "[TASK]"), node.path)
        task.tree = current_tree()
        task.node = node
    elif name is not None:
        task._name = name
    task.code = code
    if code.function is not None:
        arguments = tuple(code.parameters or ())
        task.body = lambda: code.function(*arguments)
    return task


def task_at(path):
    """``(task path)``: the task of an absolute path. Its code need not be known yet."""
    return make_task(path=path)


def sub_task(path):
    """``(sub-task path)``: the task of a path relative to the current one."""
    return make_task(path=list_from(parts_of(path), current_path()))


def with_task_tree_node(
    path_part,
    function,
    *,
    name="WITH-TASK-TREE-NODE",
    sexp=None,
    lambda_list=None,
    parameters=None,
    log_parameters=None,
    log_pattern=None,
    called_with=None,
):
    """Run ``function(*parameters)`` in a new task at ``path_part`` below the current path, and wait for it. Returns its values.

    ``parameters`` is a Lisp list. ``name`` may be a function that makes the name when it is asked for. ``sexp`` and ``called_with`` are
    noted at the node (`Code`). The hooks get the other arguments. Outside of a plan it is a type error. Source: cpl.md 7.4.
    """
    _tree_or_error()
    observed = on_preparing_task_execution.methods or on_finishing_task_execution.methods
    label = name if callable(name) else (lambda: f"[{name}]")
    run_id = None
    if observed:
        run_id = on_preparing_task_execution.first(label()[1:-1], log_parameters, log_pattern, lambda_list, parameters)
    task = _task_of(_next_free(path_part, _current_node()), label, sexp, function, parameters, called_with)
    if not observed:
        return run_one(task, "TASK")
    try:
        return run_one(task, "TASK")
    finally:
        on_finishing_task_execution(run_id)


def replaceable_function(name, lambda_list, parameters, path_part, function, sexp=None):
    """``(replaceable-function name ...)``: `with_task_tree_node` under the name ``REPLACEABLE-FUNCTION-<name>``."""
    return with_task_tree_node(
        path_part,
        function,
        name=lambda: f"[REPLACEABLE-FUNCTION-{getattr(name, 'name', name)}]",
        sexp=sexp,
        lambda_list=lambda_list,
        parameters=parameters,
    )


def replace_task_code(sexp, function, path, tree=None):
    """Let the next executions at ``path`` call ``function`` instead. Returns the node.

    The newest replacement counts, and `clear_tasks` keeps it. Source: cpl.md 7.7.
    """
    node = ensure_node(path, tree or _tree_or_error())
    node.replacements.insert(0, Code(sexp, function))
    return node


def register_task_code(sexp, function, *, path=None, task_tree=None, replace_registered=None):
    """Set the code of a node if it has none, or always with ``replace_registered``. Returns its code. Source: cpl.md 7.7."""
    node = ensure_node(path or current_path(), task_tree or _tree_or_error())
    if node.code is None:
        node.code = Code()
    if node.code.function is None or truth(replace_registered):
        node.code.sexp, node.code.function = sexp, function
        task = node.code.task
        if task is not None and task.status is CREATED:
            code = node.code
            task.body = lambda: code.function(*(code.parameters or ()))
    return node.code


# ------------------------------------------------------------------------------------------------------- looking at the tree


def get_top_level_task_tree(name):
    """The tree of the named top-level. It is empty at first and stays after the run. Source: cpl.md 5.4."""
    tree = _named_trees.get(as_name(name))
    if tree is None:
        tree = _named_trees[name] = TaskTreeNode()
    return tree


def named_tree(name):
    """The tree stored under ``name``, or ``None``."""
    return _named_trees.get(as_name(name))


def remove_top_level_task_tree(name):
    """Forget the tree stored under ``name``."""
    _named_trees.pop(as_name(name), None)


@of(TaskTreeNode)
def clear_tasks(node):
    """Forget the code, tasks and parameters of what ran. Nodes and replacements stay."""
    return cleared(node)


def cleared(node, kept=None):
    """As `clear_tasks`. ``kept``, a dict, gets the code that ran at each node."""
    node.calls = 1
    if kept is not None and _taken(node):
        code = node.effective_code
        kept[node] = code.copy() if node.replacements else code
    if node.code is not None:
        node.code = Code()
    for replacement in node.replacements:
        replacement.task = replacement.parameters = None
    for child in node.children.values():
        cleared(child, kept)
    return node


@of(TaskTreeNode)
def stale_task_tree_node_p(node):
    """True if the node's own code did not run in the latest run."""
    return True if node.code is None or node.code.task is None else None


@of(TaskTreeNode)
def task_tree_node_effective_code(node):
    """The code that runs at ``node``: the newest replacement, or else its own."""
    return node.effective_code


@of(TaskTreeNode)
def task_tree_node_parameters(node):
    """The parameters of the latest run at ``node``, or nil."""
    return node.code.parameters if node.code else None


@of(TaskTreeNode)
def task_tree_node_status_fluent(node):
    """The fluent of the status of the task at ``node``, or nil."""
    return node.code.task.status_fluent if node.code and node.code.task else None


@of(TaskTreeNode)
def task_tree_node_result(node):
    """The result of the task at ``node``, or nil."""
    return node.code.task.result if node.code and node.code.task else None


@of(TaskTreeNode)
def flatten_task_tree(tree):
    """All nodes as a list, parents before children, the newest child first."""
    found = []

    def visit(node):
        found.append(node)
        for child in reversed(node.children.values()):
            visit(child)

    visit(tree)
    return list_from(found)


def filter_task_tree(predicate, tree):
    """A copy of ``tree`` without the nodes for which ``predicate`` is false, and without all below them. For the root it must be true."""
    if not isinstance(tree, TaskTreeNode):
        return type_error(tree, "TASK-TREE-NODE")
    if not truth(predicate(tree)):
        error("The assertion (FUNCALL PREDICATE TREE) failed.")
    copy = TaskTreeNode(tree.path, None, tree.code)
    copy.replacements = list(tree.replacements)
    for key, child in tree.children.items():
        if truth(predicate(child)):
            below = filter_task_tree(predicate, child)
            below.parent = copy
            copy.children[key] = below
    return copy


@of(TaskTreeNode)
def goal_task_tree_node_p(node):
    """True if the node belongs to a goal."""
    part = node.path.car if node.path is not None else None
    return True if isinstance(part, Cons) and part.car in _goal_marks else None


@of(TaskTreeNode)
def goal_task_tree_node_pattern(node):
    """``(name . pattern)`` of a goal's node. Other nodes are an error."""
    if goal_task_tree_node_p(node) is None:
        error("The assertion (GOAL-TASK-TREE-NODE-P NODE) failed.")
    return node.path.car.cdr.car


@of(TaskTreeNode)
def goal_task_tree_node_parameter_bindings(node):
    """The variables of a goal's pattern and their values in the latest run, an alist; the last variable comes first, as in ``vars-in``."""
    variables = patterns.vars_in(goal_task_tree_node_pattern(node).cdr)
    return list_from([Cons(*pair) for pair in zip(variables or (), task_tree_node_parameters(node) or (), strict=False)])


@of(TaskTreeNode)
def goal_task_tree_node_goal(node):
    """The goal as it was called in the latest run, ``(name . arguments)``. If it did not run, the pattern."""
    pattern = goal_task_tree_node_pattern(node)
    if node.code is not None and node.code.called_with is not None:
        return Cons(pattern.car, node.code.called_with)
    return patterns.substitute_vars(pattern, goal_task_tree_node_parameter_bindings(node))
