"""Saving and loading episodes.

A file is text, one JSON value a line, so that it can be looked at and cut off nowhere without notice: a head with the version, the plan
and its times; a line for each node of the task tree, parents first; one for each traced fluent with its records; and a last line
that counts the others. What the values are like stands in ``values_on_file.py``. Loading runs no code of the file's, and one that is
cut off, foreign, or of another version is an error that says so; an error while saving leaves an old file as it was.

Of a task are kept its name, result, status, times and the name of its status fluent; of what it ran the form and the arguments.
Source: projection-and-events.md C1.
"""

from __future__ import annotations


from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.cpl.failures.failure_types import PlanFailure, opened
from cramhy_runtime.cpl.statuses import ALL, FAILED
from cramhy_runtime.cpl.tree.task_tree import Code, TaskTreeNode
from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import UNSUPPLIED
from cramhy_runtime.lisp_core.keyword_calls import lispify
from ...pathnames.pathnames import pathname
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import princ_to_string
from ...streams.basic_streams import Stream
from ...files.file_streams import open_whole, with_open_file, with_open_stream
from ...streams.streams import input_stream, output_stream
from cramhy_runtime.episodes.knowledge import checked, current_episode, last_episode, stamp, with_episode_knowledge
from .offline import OfflineEpisodeKnowledge, OfflineTask
from cramhy_runtime.episodes.tracing import TracedFluent
from cramhy_runtime.episodes.trees import nodes_of
from .values_on_file import BadFile, Reader, Writer

FORMAT, VERSION = "episode", 1
INPUT, IF_EXISTS = map(keyword, ("INPUT", "IF-EXISTS"))


# ------------------------------------------------------------------------------------------------------------------- saving


def save_episode_knowledge(destination, *arguments):
    """``(save-episode-knowledge destination [episode] &key (if-exists :error))``: returns ``destination``.

    ``destination``: a string or pathname, which the file gets, or a stream. ``if_exists``: as for ``open``. The episode is
    ``*episode-knowledge*`` unless it is given.
    """
    if arguments and not isinstance(arguments[0], type(IF_EXISTS)):
        episode, *arguments = arguments
    else:
        episode = current_episode()
    _save(destination, checked(episode), *arguments)
    return destination


def save_last_episode_knowledge(destination, *, if_exists=UNSUPPLIED):
    """Save the episode of the plan that ended last; returns ``destination``."""
    save_to(destination, checked(last_episode()), if_exists)
    return destination


def save_to(destination, episode, if_exists=UNSUPPLIED):
    """Save ``episode`` under a name or to a stream."""
    text = episode_text(episode)  # the whole of it, before a file is touched
    if isinstance(destination, Stream):
        output_stream(destination).write(text)
    else:
        with_open_stream(lambda stream: None if stream is None else stream.write(text), open_whole(destination, if_exists))


_save = lispify(lambda destination, episode, *, if_exists=UNSUPPLIED: save_to(destination, episode, if_exists))


def episode_text(episode):
    """What a file of ``episode`` contains."""
    import json  # here, since a session starts without it

    writer = Writer()
    lines = [
        {"cramhy": FORMAT, "version": VERSION, "plan": writer.write(episode.plan_name), "zero": episode.zero_time, "end": episode.end_time}
    ]
    root = episode.tree()
    numbers = {}
    for node in [] if root is None else nodes_of(root, newest_first=False):
        numbers[node] = len(numbers)
        lines.append(_node(node, numbers, writer))
    for name, records in episode.traces.items():
        lines.append(
            {"fluent": writer.write(name), "records": [[writer.write(record.traced_value), float(record.timestamp)] for record in records]}
        )
    lines.append({"lines": len(lines)})
    return "".join(json.dumps(line, separators=(",", ":")) + "\n" for line in lines)


def _node(node, numbers, writer):
    code, task = node.code, node.code.task
    result = opened(task.result) if isinstance(task.result, PlanFailure) else task.result
    return {
        "node": numbers[node],
        "below": numbers.get(node.parent),
        "path": writer.write(node.path),
        "task": task.name,
        "status": task.status.name,
        "result": writer.write(result),
        "started": stamp(task, task.started_at),
        "ended": stamp(task, task.ended_at),
        "status-fluent": writer.write(task.status_fluent.name),
        "form": writer.write(code.sexp),
        "function": writer.write(code.function),
        "parameters": writer.write(code.parameters),
        "called-with": writer.write(code.called_with),
    }


# ------------------------------------------------------------------------------------------------------------------ loading


def load_episode_knowledge(source):
    """The episode in the file ``source`` (a string or pathname), or that is read from a stream: an offline episode."""
    if isinstance(source, Stream):
        return read_episode(_all_of(input_stream(source)), source)
    return with_open_file(lambda stream: read_episode(_all_of(stream), pathname(source)), source, direction=INPUT)


def with_offline_episode_knowledge(source, body):
    """Values of ``body()`` about the episode in ``source``."""
    return with_episode_knowledge(load_episode_knowledge(source), body)


def _all_of(stream):
    lines, ended = [], False
    while not ended:
        line, ended = stream.read_line()
        lines.append(line)
    return "\n".join(lines)


def read_episode(text, source):
    """The episode that ``text`` tells; ``source`` is named in errors."""
    lines = text.split("\n")
    number = 0
    try:
        forms = []
        for number, line in enumerate(lines, 1):
            if line:
                forms.append(_parsed(line, number))
        head, last = forms[0] if forms else {}, forms[-1] if forms else {}
        number = 1
        if head.get("cramhy") != FORMAT:
            raise BadFile("it does not begin with the head of an episode")
        if head.get("version") != VERSION:
            raise BadFile(f"it is of version {head.get('version')}, and this cramhy reads version {VERSION}")
        number = len(forms)
        if last.get("lines") != len(forms) - 1:
            raise BadFile("its end is missing: it was cut off")
        episode = OfflineEpisodeKnowledge()
        reader, nodes = Reader(), {}
        for number, form in enumerate(forms[:-1], 1):
            if number == 1:
                episode.plan_name = reader.read(form["plan"])
                episode.zero_time, episode.end_time = _time(form["zero"]), _time(form["end"])
            elif "node" in form:
                _read_node(form, reader, nodes, episode)
            else:
                name = reader.read(form["fluent"])
                episode.traces[name] = [TracedFluent(name, reader.read(value), _time(time)) for value, time in form["records"]]
        return episode
    except BadFile as problem:
        return _refuse(source, number, str(problem))
    except KeyError as missing:
        return _refuse(source, number, f"{missing} is missing")
    except (TypeError, ValueError, AttributeError, IndexError, RecursionError, OverflowError, ZeroDivisionError) as problem:
        return _refuse(source, number, f"it is damaged ({problem})")


def _refuse(source, line, why):
    return error(SimpleError("~a is not a file of an episode that could be loaded: line ~d: ~a.", princ_to_string(source), line, why))


_PIECES = late_pattern(r'"(?:[^"\\]|\\.)*"?|[\[{]|[\]}]')
_DEEPEST_LINE = 2000


def _parsed(line, number):
    import json  # here, since a session starts without it

    depth = 0
    for piece in _PIECES.finditer(line):  # the parser of JSON would go as deep as the stack of the machine
        if piece[0] in "[{":
            depth += 1
            if depth > _DEEPEST_LINE:
                raise BadFile("it is nested too deep")
        elif piece[0] in "]}":
            depth -= 1
    try:
        form = json.loads(line)
    except ValueError:
        if number == 1:
            raise BadFile("it does not begin with the head of an episode") from None
        raise BadFile("it is cut off or damaged") from None
    if not isinstance(form, dict):
        raise BadFile("it is not part of an episode")
    return form


def _read_node(form, reader, nodes, episode):
    status = keyword(form["status"])
    if status not in ALL:
        raise BadFile(f"a task has no status {form['status']}")
    path = reader.read(form["path"])
    result = reader.read(form["result"])
    task = OfflineTask(
        str(form["task"]), status, result, path, _time(form["started"]), _time(form["ended"]), reader.read(form["status-fluent"])
    )
    if status is FAILED and not isinstance(result, BaseException):
        task.result = PlanFailure(princ_to_string(result))
    code = Code(reader.read(form["form"]), reader.read(form["function"]), task, reader.read(form["parameters"]))
    code.called_with = reader.read(form["called-with"])
    node = nodes[form["node"]] = TaskTreeNode(path, None, code)
    if form["below"] is None:
        episode.root = node
    else:
        node.parent = nodes[form["below"]]
        node.parent.children[len(nodes)] = node


def _time(seconds):
    return None if seconds is None else float(seconds)
