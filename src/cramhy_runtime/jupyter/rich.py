"""Values as a notebook shows them: always as text, as Lisp prints it, and some as HTML, too.

Answers of Prolog become tables, designators a table with their resolution, messages and poses trees, tasks and failures outlines.
All that comes from a program is escaped: a page shows it and runs nothing of it.
"""

from __future__ import annotations

from html import escape

from cramhy_runtime import kernel
from cramhy_runtime.cpl.fluents.fluents import Fluent
from cramhy_runtime.cpl.tasks.tasks import AbstractTask
from cramhy_runtime.designators import classes, resolution
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, list_end
from cramhy_runtime.lisp_core.printing import guarded, prin1_to_string
from cramhy_runtime.languages.commonlisp.objects.classes import class_of
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_type
from cramhy_runtime.prolog.explanations.explanations import Explanation
from cramhy_runtime.ros.messages import RosMessage
from cramhy_runtime.session.inspection import inspected
from cramhy_runtime.utilities.patterns import is_var

from . import outlines, plots

MOST_ROWS = 200
DEEPEST = 8
TABLE, CELL = "<table>", '<td style="text-align:left">'


def bundle(values, show=prin1_to_string, watched=None):
    """The mime bundle of the values of a cell; ``None`` if there are none.

    show: how a value is printed as text. watched: the `plots.Watched` of the notebook, for the past of fluents, or ``None``.
    """
    if not values:
        return None
    found = {"text/plain": "\n".join(map(show, values))}
    if len(values) == 1 and (shown := guarded(lambda: html(values[0], watched), lambda problem: None)):
        found["text/html"] = shown
    return found


def html(value, watched=None):
    """The HTML of a value, or ``None`` where its text says all. watched: see `bundle`."""
    if isinstance(value, RosMessage):
        return message(value)
    if isinstance(value, classes.Designator):
        return designator(value)
    if isinstance(value, AbstractTask):
        return task(value)
    if isinstance(value, Condition):
        return failure(value)
    if isinstance(value, Fluent):
        return fluent(value, watched)
    if isinstance(value, Explanation):
        return outlines.of_text(value.text)
    if isinstance(value, Cons) and (rows := answers(value)) is not None:
        return table(rows)
    return None


def text(value):
    """The value as Lisp prints it, escaped."""
    return escape(prin1_to_string(value))


# ------------------------------------------------------------------------------------------------------------------ Prolog


def items(value):
    """The elements of a proper list; ``None`` if ``value`` is none."""
    if value is not None and (not isinstance(value, Cons) or list_end(value) is not None):
        return None
    found = []
    while value is not None:
        found.append(value.car)
        value = value.cdr
    return found


def answers(value):
    """The answers of Prolog in a list of sets of bindings, dictionaries of a variable and its value; ``None`` if it is none."""
    rows = []
    for answer in items(value) or [None]:
        pairs = items(answer)
        if not pairs or not all(isinstance(pair, Cons) and is_var(pair.car) for pair in pairs):
            return None
        rows.append({pair.car.name: pair.cdr for pair in pairs})
    return rows


def table(rows):
    """The answers as a table: a column for each variable."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    body = "".join(
        "<tr>" + "".join(f"{CELL}<code>{text(row[name]) if name in row else ''}</code></td>" for name in names) + "</tr>"
        for row in rows[:MOST_ROWS]
    )
    more = f"<p>and {len(rows) - MOST_ROWS} more answers</p>" if len(rows) > MOST_ROWS else ""
    return f"{TABLE}<thead><tr>{''.join(f'<th>{escape(name)}</th>' for name in names)}</tr></thead><tbody>{body}</tbody></table>{more}"


# ---------------------------------------------------------------------------------------------------------------- messages


def message(value, depth=0):
    """A message as a tree: each part that is a message or a list can be folded."""
    rows = "".join(f"<li>{escape(name)}: {_field(getattr(value, name), depth)}</li>" for name in value.field_names)
    opened = " open" if depth < 2 else ""
    return f"<details{opened}><summary><b>{escape(value.ros_type)}</b></summary><ul>{rows}</ul></details>"


def _field(value, depth):
    if depth >= DEEPEST:
        return "<code>...</code>"
    if isinstance(value, RosMessage):
        return message(value, depth + 1)
    if isinstance(value, (list, tuple)) and value and isinstance(value[0], RosMessage):
        rows = "".join(f"<li>{message(each, depth + 1)}</li>" for each in value[:MOST_ROWS])
        return f"<details><summary>{len(value)} messages</summary><ol>{rows}</ol></details>"
    return f"<code>{text(value)}</code>"


# ------------------------------------------------------------------------------------------------------- designators, tasks


def designator(value):
    """A designator: its pairs, and what it was resolved to. Looking resolves nothing."""
    pairs = [(pair.car, classes.value_of(pair)) if isinstance(pair, Cons) else (pair, None) for pair in classes.pairs_of(value)]
    known = guarded(lambda: resolution.known(value), lambda problem: None)
    resolved = f"<code>{text(known)}</code>" if known is not None else "<i>not resolved yet</i>"
    rows = "".join(f"<tr><th>{text(key)}</th>{CELL}{_part(part)}</td></tr>" for key, part in pairs)
    return f"{TABLE}<caption>{escape(_name(value))}</caption><tbody>{rows}<tr><th>resolution</th>{CELL}{resolved}</td></tr></tbody></table>"


def _part(value):
    return designator(value) if isinstance(value, classes.Designator) else f"<code>{text(value)}</code>"


def _name(value):
    return prin1_to_string(class_of(value)).rpartition(":")[2].strip("<># ").replace("STANDARD-CLASS ", "").lower()


def facts(title, rows):
    """A table of facts."""
    body = "".join(f"<tr><th>{escape(label)}</th>{CELL}<code>{text(value)}</code></td></tr>" for label, value in rows)
    return f"{TABLE}<caption>{escape(title)}</caption><tbody>{body}</tbody></table>"


def fluent(value, watched):
    """A fluent: its name, its value and its pulses; and its values over time, if it is watched."""
    told = facts("fluent", [(part.label, part.value) for part in inspected(value).parts if part.label in ("Name", "Value", "Pulses")])
    series = watched.of(value) if watched is not None else None
    return told if series is None else told + plots.svg([series], kernel.now())


def task(value):
    """A task with the tasks below it, as an outline."""
    return outlines.of_tasks(outlines.task_lines([value]))


def failure(condition, depth=0):
    """A failure: its type, what it says, where and what to try, and below it the failures that belong to it."""
    told = f"<pre>{escape(explanation(condition))}</pre>"
    parts = [(label, each) for label, each in getattr(condition, "beside", ()) if isinstance(each, Condition)] if depth < DEEPEST else []
    items = "".join(f"<li>{escape(label)}{failure(each, depth + 1)}</li>" for label, each in parts)
    below = f"<ul>{items}</ul>" if items else ""
    return f"<details open><summary><b>{escape(str(condition_type(condition)))}</b></summary>{told}{below}</details>"
