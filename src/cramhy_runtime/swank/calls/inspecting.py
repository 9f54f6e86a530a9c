"""Calls of the inspector."""

from __future__ import annotations

from ..inspector import Inspector, text_of
from ..presentations import of
from ..rpcs import Refused, rpc, text
from .evaluating import evaluated


def inspector_of(call):
    """The `Inspector` of the connection. `Refused` if nothing is inspected."""
    if call.connection.inspector is None:
        raise Refused("Nothing is inspected.")
    return call.connection.inspector


def inspect(call, obj):
    """Begin to inspect ``obj``."""
    call.connection.inspector = Inspector(obj)
    return call.connection.inspector.shown()


@rpc("init-inspector", evaluates=True)
def init_inspector(call, source):
    values = evaluated(call, text(source))
    return inspect(call, values[0] if values else None)


@rpc("inspect-presentation")
def inspect_presentation(call, id_, reset=None):
    obj = of(call.connection).find(id_)
    if call.connection.inspector is None or reset:
        return inspect(call, obj)
    return call.connection.inspector.go_to(obj)


@rpc("inspect-object")
def inspect_object(call, obj, reset=None):
    """Inspect what a call in the arguments gives, such as ``(swank-trace-dialog::find-trace 3)``; or a presentation, by its number."""
    return inspect_presentation(call, obj, reset) if isinstance(obj, int) else inspect(call, obj)


@rpc("inspect-nth-part")
def inspect_nth_part(call, index):
    return inspector_of(call).go_to(inspector_of(call).part(index))


@rpc("inspector-nth-part")
def inspector_nth_part(call, index):
    return text_of(inspector_of(call).part(index))


@rpc("pprint-inspector-part")
def pprint_part(call, index):
    return text_of(inspector_of(call).part(index), pretty=True)


@rpc("inspector-call-nth-action", evaluates=True)
def call_nth_action(call, index, *_):
    return inspector_of(call).act(index)


@rpc("inspector-range")
def inspector_range(call, start, end):
    return inspector_of(call).chunk(start, end)


@rpc("inspector-pop")
def inspector_pop(call):
    return inspector_of(call).back()


@rpc("inspector-next")
def inspector_next(call):
    return inspector_of(call).forth()


@rpc("inspector-reinspect")
def reinspect(call):
    return inspector_of(call).shown()


@rpc("inspector-toggle-verbose")
def toggle_verbose(call):
    return inspector_of(call).shown()


@rpc("inspector-history")
def history(call):
    return inspector_of(call).history()


@rpc("inspector-eval", evaluates=True)
def inspector_eval(call, source):
    """A form in which ``*`` is the object that is shown."""
    from cramhy_runtime.lisp_core.dynamic import binding
    from cramhy_runtime.session.session import HISTORY

    from .evaluating import echo

    with binding(HISTORY[0], inspector_of(call).object):
        return echo(evaluated(call, text(source)))


@rpc("quit-inspector")
def quit_inspector(call):
    call.connection.inspector = None
