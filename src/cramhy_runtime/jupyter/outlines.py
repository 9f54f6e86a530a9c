"""Outlines: texts in levels, as HTML that can be folded. The task tree, explanations of Prolog and failures are shown so.

Each row is a level, the HTML of its line, and what it is of, for its colour. Plain ``details`` and ``summary`` are enough for that: they
work in every front end, also in a page that is exported, and need no script.
"""

from __future__ import annotations

from html import escape

from cramhy_runtime.cpl.statuses import EVAPORATED, FAILED, SUCCEEDED, SUSPENDED
from cramhy_runtime.cpl.tree.tree_report import Forest

MOST = 300
"""Rows of an outline."""
DEEPEST_OPEN = 6
"""Rows of deeper levels are folded at first."""
COLOURS = {SUCCEEDED: "#2e8b57", FAILED: "#c62828", EVAPORATED: "#888888", SUSPENDED: "#b8860b"}
INDENT = "margin-left:1.2em"


def outline(rows):
    """The HTML of ``rows``, pairs of a level, 0 or more, and the HTML of a line."""
    rows = list(rows)
    left, rows = len(rows) - MOST, rows[:MOST]
    parts, opened = [], []
    for number, (level, line) in enumerate(rows):
        while opened and opened[-1] >= level:
            opened.pop()
            parts.append("</div></details>")
        if number + 1 < len(rows) and rows[number + 1][0] > level:
            fold = " open" if len(opened) < DEEPEST_OPEN else ""
            parts.append(f'<details{fold}><summary>{line}</summary><div style="{INDENT}">')
            opened.append(level)
        else:
            parts.append(f"<div>{line}</div>")
    parts += ["</div></details>"] * len(opened)
    return "".join(parts) + (f"<div>and {left} more</div>" if left > 0 else "")


def of_text(text):
    """The outline of a text whose levels are its indentation."""
    lines = [line for line in text.splitlines() if line.strip()]
    shown = outline(((len(line) - len(line.lstrip())) // 2, escape(line.strip())) for line in lines)
    return f'<div style="font-family:monospace">{shown}</div>'


def of_tasks(lines):
    """The outline of a report of tasks, `tree_report.Line`s."""
    return outline((line.level, f"<b>{escape(str(line.name))}</b> {_coloured(line)}") for line in lines)


def _coloured(line):
    colour = COLOURS.get(line.status)
    rest = escape(line.rest)
    return f'<span style="color:{colour}">{rest}</span>' if colour else rest


def task_lines(tasks, also=()):
    """The `tree_report.Line`s of ``tasks`` and of those below them. also: dead tasks that shall be among them."""
    forest = Forest(list(tasks))
    for task in also:
        forest.add(task)
    return forest.lines(None, True)
