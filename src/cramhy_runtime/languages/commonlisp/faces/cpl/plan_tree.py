"""``expand-plan``: the tree of a plan before it runs, as far as its text tells (cpl.md 12).

The root is the form itself; below it is a node for each tag and, in them, for what stands in their bodies. A call of a plan
function is a node too, ``(name)`` or ``(top-level name)``, and the walk goes on in the body of that function, unless a local
function hides it or the walk is in it already: a plan that calls itself ends in a leaf. So the paths are those that the tasks of
a run have, and `find_plan_node` finds for the path of a task the text that it runs.

Repaired: the original looks the properties of plans up under a symbol of the wrong package, and follows no call.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.equality import equal
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.cpl.forms.plans import TOP_LEVEL, plan_property
from cramhy_runtime.cpl.tree.tags import TAGGED
from cramhy_runtime.cpl.type_checks import parts_of
from .walker import Walk, environment

TOP_LEVEL_PLAN = keyword("TOP-LEVEL-PLAN")


class PlanTreeNode:
    """A step of a plan: its form ``sexp``, its ``path`` (deepest part first), its ``parent`` and its ``children`` in textual order."""

    __slots__ = ("sexp", "path", "parent", "nodes", "__weakref__")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::PLAN-TREE-NODE"

    def __init__(self, sexp=None, path=None, parent=None):
        self.sexp, self.path, self.parent = sexp, path, parent
        self.nodes = []

    @property
    def children(self):
        """Its children as a Lisp list."""
        return list_from(self.nodes)

    @children.setter
    def children(self, children):
        self.nodes = python_list(children)

    def below(self, part, sexp):
        """A new child for the path part ``part``."""
        node = PlanTreeNode(sexp, Cons(part, self.path), self)
        self.nodes.append(node)
        return node


class _PlanWalk(Walk):
    """A walk that keeps the node it is at, and the plan functions that it is in."""

    def __init__(self, root):
        self.node = root
        self.plans = []

    def tag(self, form, name, body, env):
        outer, self.node = self.node, self.node.below(lisp_list(TAGGED, name), form)
        try:
            return super().tag(form, name, body, env)
        finally:
            self.node = outer

    def call(self, form, env):
        kind = plan_property(form.car, "PLAN-TYPE") if env.function(form.car) is None else None
        if kind is not None:
            self.follow(form, kind)
        return super().call(form, env)

    def follow(self, form, kind):
        """Make the node of a call of a plan function, and walk through its body."""
        name = form.car
        outer, self.node = self.node, self.node.below(lisp_list(TOP_LEVEL, name) if kind is TOP_LEVEL_PLAN else lisp_list(name), form)
        try:
            if name not in self.plans:
                self.plans.append(name)
                self.forms(plan_property(name, "PLAN-SEXP"), environment())
                self.plans.pop()
        finally:
            self.node = outer


def expand_plan(form):
    """``(expand-plan form)``: two values, the root `PlanTreeNode` and the expansion of ``form``."""
    root = PlanTreeNode(form)
    expansion = _PlanWalk(root).form(form, environment())
    return MultipleValues((root, expansion))


def find_plan_node(plan_tree, path):
    """``(find-plan-node tree path)``: the node at ``path`` (deepest part first) below ``plan_tree``; nil if there is none."""
    if not isinstance(plan_tree, PlanTreeNode):
        return type_error(plan_tree, "PLAN-TREE-NODE")
    node = plan_tree
    for part in reversed(parts_of(path)):
        node = next((child for child in node.nodes if equal(child.path.car, part)), None)
        if node is None:
            return None
    return node
