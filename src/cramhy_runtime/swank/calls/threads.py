"""Calls of the buffer that lists threads: the tasks of the session, as a tree."""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.session import requests

from ..rpcs import Refused, rpc
from ..wire import Name


def in_order(tasks):
    """(depth, task) for all ``tasks``: each below its parent."""
    children = {}
    for task in tasks:
        children.setdefault(task.parent if task.parent in tasks else None, []).append(task)

    def walk(parent, depth):
        for task in children.get(parent, ()):
            yield depth, task
            yield from walk(task, depth + 1)

    return list(walk(None, 0))


def state(task):
    """What a task does, in a few words."""
    if task is kernel.current():
        return "runs"
    return "is ready" if task.ready else f"waits for {task.describe_why()}" if task.why else task.state


@rpc("list-threads")
def list_threads(call):
    found = in_order(kernel.active().tasks)
    call.connection.threads = [task for _, task in found]
    rows = [[task.id, f"{'  ' * depth}{task.name}", state(task)] for depth, task in found]
    return [[Name(":id"), Name(":name"), Name(":status")], *rows]


def _thread(call, index):
    threads = call.connection.threads
    if not isinstance(index, int) or not 0 <= index < len(threads):
        raise Refused(f"There is no thread {index} in the list. List them again.")
    return threads[index]


@rpc("kill-nth-thread")
def kill_nth_thread(call, index):
    task = _thread(call, index)
    if task is kernel.active().main:
        raise Refused("The main task cannot be killed. To end the session, type (quit).")
    if task is kernel.current() or task.dead:
        return
    request = getattr(task.local, "request", None)
    if request is not None:
        request.interrupt()
    elif task.owner is not None and hasattr(task.owner, "evaporate"):
        task.owner.evaporate()
    else:
        task.cancel("it was killed from Emacs")


@rpc("debug-nth-thread")
def debug_nth_thread(call, index):
    """Open the debugger in a task at its next waiting point."""
    task = _thread(call, index)
    request = requests.request_of(task)
    if request is None or task is kernel.current() or getattr(request.owner, "connection", None) is not call.connection:
        raise Refused("Only tasks that a form from this Emacs has started can be stopped in its debugger.")
    from cramhy_runtime.lisp_core import conditions

    task.interject(lambda: conditions.break_("Stopped from Emacs."))


@rpc("quit-thread-browser")
def quit_thread_browser(call):
    call.connection.threads = []


@rpc("start-swank-server-in-thread")
def start_server(call, *_):
    raise Refused("A session listens once. Connect to the same port again.")
