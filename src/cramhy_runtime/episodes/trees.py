"""The task tree of an episode: what ran, without the nodes that did not.

The plan's own tree cannot stand for it. Nodes of earlier runs are in it, and when the plan runs again its nodes get new tasks. So
the episode has nodes of its own, one for each node that ran and always the same one, with the code that ran there.

The root is the node of the function that the plan called. A plan that called several, or none but tasks below its root, has a root of
its own, with the task of the top-level. (The original takes one of several and loses the others.) Source: projection-and-events.md C1.
"""

from __future__ import annotations

from cramhy_runtime.cpl.tree.task_tree import Code, TaskTreeNode
from cramhy_runtime.lisp_core.conditions import error


def task_tree(episode):
    """The root of the tree of a live episode, up to date while it runs; ``None`` when nothing ran."""
    task = episode.task
    if task is None:
        return None
    if episode.root is not None:
        return episode.root
    codes = task.__dict__.get("codes")
    code_of = (lambda node: node.effective_code) if codes is None else codes.get
    tops = _children(task.tree, code_of, episode.nodes, None)
    if not tops:
        root = None
    elif len(tops) == 1:
        (root,) = tops.values()
        root.parent = None
    else:
        root = _own_node(task.tree, episode.nodes)
        root.code, root.children = Code(task=task), tops
        for top in tops.values():
            top.parent = root
    if not episode.running:
        episode.root, episode.nodes = root, {}
    return root


def _children(node, code_of, nodes, parent):
    found = {}
    for key, child in node.children.items():
        code = code_of(child)
        if code is not None and code.task is not None:
            own = found[key] = _own_node(child, nodes)
            own.code, own.parent = code, parent
            own.children = _children(child, code_of, nodes, own)
    return found


def _own_node(node, nodes):
    own = nodes.get(node)
    if own is None:
        own = nodes[node] = TaskTreeNode(node.path)
    return own


def tree_or_error(episode):
    """The root of the tree of any episode; an error when nothing ran."""
    root = episode.tree()
    if root is not None:
        return root
    return error("Task tree has no top level node.")


def nodes_of(root, newest_first=True):
    """All nodes, parents before children, the newest or the oldest child first, as a Python list."""
    found = []
    waiting = [root]
    while waiting:
        node = waiting.pop()
        found.append(node)
        waiting.extend(node.children.values() if newest_first else reversed(node.children.values()))
    return found
