"""``roscore`` and ``rosrun``, and ``cramhy turtlesim`` and ``teleop``: programs that run on the graph, and their terminals.

All nodes live in one process, the session; a terminal that starts a program shows its log and ends it with Ctrl-C. Where does it run?
In the session of this machine, if there is one (`ros_tools.hosting`). If there is none, this process becomes a session itself, with the
clock of the wall, until a REPL starts: then the program begins anew over there, and this terminal goes on with its log. When the REPL
ends, the program comes back. So a student may start the simulator and the REPL in any order, as with ROS, and the REPL's own turtle,
which the plan moves in the plan's time, is the one that everybody sees.
"""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

from cramhy_runtime.kernel import signals

from .lisp_executables import Processes

LOOK_AGAIN = 1.0  # s between two looks for a session that has started elsewhere
KEYBOARD = ("turtlesim", "turtle_teleop_key")
"""What drives by the keys of its terminal."""
RUN_USAGE = """Usage: rosrun PACKAGE EXECUTABLE [ARGS]
  rosrun starts EXECUTABLE of PACKAGE with ARGS, such as __name:=x, __ns:=/y, a:=b and _parameter:=value."""


class Program(NamedTuple):
    """A program to be started: an executable of a package, the words of its command line; ``label`` is roslaunch's name of it."""

    package: str
    executable: str
    arguments: list
    label: str = ""


def roscore(arguments):
    """``roscore``: there is nothing to start. What the original tells of the master it tells of the session that runs here, if one does."""
    from cramhy_runtime.ros_tools import remote_graph
    from cramhy_runtime.ros_tools.graph_access import NoSession, SessionEnded

    print("No master is needed: the ROS graph lives in the process of roslisp_repl.")
    try:
        graph = remote_graph.current()
        try:
            parameters = {name: graph.parameter(name) for name in graph.parameter_names()}
            print(f"It runs already, as process {graph.pid}, and serves at {graph.address}.\n")
            print(summary(parameters, [(name, "") for name in graph.nodes()]))
        finally:
            graph.close()
    except (NoSession, SessionEnded) as problem:
        print(str(problem) or "No session serves here yet. Start one with: roslisp_repl --serve, or rosrun turtlesim turtlesim_node")


def summary(parameters, nodes):
    """What roscore and roslaunch print of parameters, values by name, and of nodes, pairs of a name and what is said of it."""
    lines = ["SUMMARY", "========", "", "PARAMETERS"]
    lines += [f" * {name}: {_shown(value)}" for name, value in sorted(parameters.items())]
    lines += ["", "NODES"]
    spaces = {}
    for name, about in nodes:
        space, _, last = ("/" + name.lstrip("/")).rpartition("/")
        spaces.setdefault(space + "/", []).append(f"    {last}{about}")
    for space, found in spaces.items():
        lines += [f"  {space}", *sorted(found)]
    return "\n".join([*lines, ""])


def _shown(value):
    text = str(value).strip()  # that of /rosdistro ends in a newline
    return text if len(text) <= 20 else text[:17] + "..."


def rosrun(arguments):
    """``rosrun PACKAGE EXECUTABLE [ARGS]``."""
    if len(arguments) < 2 or arguments[0].startswith("-"):
        print(RUN_USAGE)
        return 0
    package, executable, *words = arguments
    of_lisp = _of_lisp(package)
    if executable in of_lisp:
        from . import lisp_executables

        return lisp_executables.run(package, of_lisp[executable], words)
    status = _known(package, executable)
    if status:
        return status
    if (package, executable) == KEYBOARD:
        from . import keyboard

        return keyboard.teleop(words)
    return run([Program(package, executable, words)])


def _of_lisp(package):
    """The Lisp executables of a package of the user's, by name; none of a package that is part of cramhy."""
    from cramhy_runtime.ros_tools import executables

    from .lisp_executables import lisp_executables
    from .workspace import folder_of

    return {} if executables.executables(package) else lisp_executables(folder_of(package))


def _is_of_lisp(program):
    """Whether a program that a launch file starts is a Lisp executable. ``rosrun`` has looked itself."""
    return bool(program.label) and program.executable in _of_lisp(program.package)


def _known(package, executable):
    """0 when there is such an executable; else the exit status, after the complaint."""
    from cramhy_runtime.ros_tools import executables
    from cramhy_runtime.ros_tools.arguments import meant

    from .workspace import folder_of

    if executables.complaint(package, executable) is None:
        return 0
    folder = folder_of(package)
    if folder is None:
        print(f"[rospack] Error: package '{package}' not found", file=sys.stderr)
        sys.stderr.write(meant(package, list(executables.EXECUTABLES)))
        return 2
    print(f"[rosrun] Couldn't find executable named {executable} below {folder}", file=sys.stderr)
    there = executables.executables(package) or sorted(_of_lisp(package))
    if there:
        print(f"[rosrun] {package} has the executables {', '.join(there)}.", file=sys.stderr)
    elif os.path.exists(os.path.join(folder, "CMakeLists.txt")):
        print("[rosrun] Its CMakeLists.txt names no Lisp program: add_lisp_executable(NAME SYSTEM PACKAGE:FUNCTION).", file=sys.stderr)
    return 3


# ------------------------------------------------------------------------------------------------------------ where to run


def run(programs, parameters=None, port=None, view=None, time=None):
    """Run programs, in the session that there is or in this process, until they end or Ctrl-C; the exit status.

    parameters: values by global name, which are set before. port: where a session of this process listens. view: whether to open the page
    of the session; ``None``: if a simulator is among the programs, and in a browser only on a desktop. time: what ``--time`` says of a
    session of this process, or ``None``: what CRAMHY_TIME says, or the wall's.
    """
    from cramhy_runtime.ros_tools import remote_graph
    from cramhy_runtime.ros_tools.graph_access import NoSession, Refused, SessionEnded

    from . import servers

    told = None
    try:
        servers.require("serve", "To run a program outside of roslisp_repl")
        while True:
            try:
                graph = remote_graph.current()
            except NoSession as problem:
                if str(problem):
                    raise servers.NotPossible(str(problem)) from None
                if told is not None:
                    _tell(f"The session has ended: {told} here again.")
                status = _run_here(programs, parameters, port, view, time, again=told is not None)
                if status != "moved":
                    return status
                told = _what(programs)
                _tell(f"A session has started: {told} there now.")
                continue
            try:
                return _run_there(graph, programs, parameters, view)
            except SessionEnded:
                told = _what(programs)
            finally:
                graph.close()
    except (servers.NotPossible, Refused) as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 0


def _what(programs):
    return "the turtle lives" if any(each.package == "turtlesim" for each in programs) else "the program runs"


def _has_window(programs):
    """Whether one of the programs opens a window in ROS: a simulator."""
    from cramhy_runtime.ros_tools.hosting import SHARED

    return any((each.package, each.executable) in SHARED for each in programs)


def _tell(text):
    print(f"; {text}", file=sys.stderr, flush=True)


def show(line):
    """A line of a program's log: warnings and errors go to the other stream, as roscpp has it."""
    print(line, file=sys.stderr if line.startswith(("[ WARN]", "[ERROR]", "[FATAL]")) else sys.stdout, flush=True)


def _started(program, number, pid):
    """What roslaunch prints when it has started a program; its name and number, for the end."""
    if program.label:
        print(f"process[{program.label}-{number}]: started with pid [{pid}]", flush=True)
    return [f"{program.label}-{number}"] if program.label else []


def _reads_keys(program):
    """Whether the program gets the keys of this terminal: in a launch file, where ``rosrun`` has not seen to that, and on a terminal."""
    from cramhy_runtime.kernel.terminals import is_terminal

    return (program.package, program.executable) == KEYBOARD and is_terminal(0)


@contextmanager
def _keys(wanted):
    """``with _keys(wanted) as read:`` gives what was typed on this terminal within a moment, or ``None``, if it is ``wanted``."""
    from cramhy_runtime.kernel.terminals import keys_one_by_one
    from cramhy_runtime.turtlesim.teleop import BANNER

    from .keyboard import PACE

    if wanted is None:
        yield lambda: None
        return
    print(BANNER, end="", flush=True)
    with keys_one_by_one() as read:
        yield lambda: read(PACE)


def _without(program, problem):
    """Go on without a program that does not start: one of several in a launch file. Otherwise ``problem`` is raised."""
    if not program.label:
        raise problem
    there = _of_lisp(program.package)
    if there:
        problem = f"{program.package} has the executables {', '.join(sorted(there))}."
    print(f"ERROR: cannot launch node of type [{program.package}/{program.executable}]: {problem}", file=sys.stderr, flush=True)


def _closing(labels):
    """Print what roslaunch prints when it ends its programs, the last first. A signal that asked for that was answered by it."""
    signals.answered()
    for label in labels:
        print(f"[{label}] killing on exit")
    if labels:
        print("shutting down processing monitor...\n... shutting down processing monitor complete\ndone", flush=True)


def _run_there(graph, programs, parameters, view):
    """Run programs in the session of another process. A closed window, or another end of this process, ends them as Ctrl-C does."""
    from cramhy_runtime.kernel.errors import Terminated
    from cramhy_runtime.ros_tools.graph_access import Refused

    from . import live_page

    for name, value in (parameters or {}).items():
        graph.set_parameter(name, value)
    ours, shown, labels, keyboard, statuses = [], set(), [], None, [0]
    with graph.listen("/cramhy/program_log", "cramhy_msgs/ProgramLine") as log, Processes(lambda wait: wait()) as processes:
        try:
            for number, program in enumerate(programs, 1):
                if _is_of_lisp(program):
                    labels = _started(program, number, processes.start(program, number)) + labels
                    continue
                wanted = {"package": program.package, "executable": program.executable, "arguments": list(program.arguments)}
                try:
                    answer = graph.call("/cramhy/start_program", "", wanted)
                except Refused as problem:
                    _without(program, problem)
                    continue
                shown.add(answer["node"])
                keyboard = answer["node"] if _reads_keys(program) else keyboard
                if answer["there"]:
                    _tell(f"{answer['node']} runs in the session of process {graph.pid} already. This is its log; Ctrl-C leaves it alone.")
                else:
                    ours.append(answer["node"])
                labels = _started(program, number, graph.pid) + labels
                for line in answer["lines"]:
                    show(line)
            if view or view is None and _has_window(programs):
                try:
                    _tell(f"The page: {live_page.show_session(graph, asked=bool(view))}")
                except Refused as problem:  # of a session that offers no page
                    if view:
                        _tell(problem)
            with _keys(keyboard) as read:
                while processes.running() or shown:
                    typed = read() if keyboard in shown else None
                    if typed:
                        graph.call("/cramhy/feed_program", "", {"node": keyboard, "keys": list(typed)})
                    heard = log.take(_until(graph, processes, keyboard in shown))
                    while heard is not None:
                        message = heard[1]
                        if message["node"] in shown and not message["ended"]:
                            show(message["line"])
                        elif message["ended"] and message["node"] in shown:
                            shown.discard(message["node"])
                            statuses.append(message["status"])
                        heard = log.take(graph.now()) if shown else None
        except (KeyboardInterrupt, Terminated):
            _closing(labels)
            for node in reversed(ours):
                if node in shown:
                    graph.kill(node)
            return 0
    return 0 if labels else max(statuses)  # roslaunch ends well, whatever became of its programs


def _until(graph, processes, typing):
    """Until when to wait for a line of a log: for ever, unless keys may be typed or processes may end meanwhile."""
    if typing:
        return graph.now()
    return graph.now() + LOOK_AGAIN if processes.running() else None


def _run_here(programs, parameters, port, view, time=None, again=False):
    """Run programs in this process, which is a session until another one starts: then the result is ``"moved"``, else the exit status.

    again: whether they ran in another session before, so that no browser opens by itself.
    """
    from cramhy_runtime import kernel
    from cramhy_runtime.session import boot, time_setting
    from cramhy_runtime.ros import graph
    from cramhy_runtime.ros.services import Refusal
    from cramhy_runtime.turtlesim import window
    from cramhy_runtime.view import page

    from . import live_page, servers

    try:
        kernel.start(clock=time_setting.decide(time, time_setting.PROMPT))
    except ValueError as problem:
        raise servers.NotPossible(str(problem)) from None
    boot()
    if kernel.active().clock.virtual:
        kernel.pace().set_speed(1.0)  # the program is there to be watched, and nothing else tells virtual time where to stop
    labels = []
    with ExitStack() as closings:
        closings.callback(kernel.stop)
        try:
            live_page.offer()
            _, host = servers.serve(closings, port, bool(view))
            if kernel.run_blocking(_others):  # it began while we did, and is older: nobody would tell us of it later
                return "moved"
            for name, value in (parameters or {}).items():
                graph.active().parameters.set(name, value)
            nodes, keyboard, processes = [], None, closings.enter_context(Processes(kernel.run_blocking))
            for number, program in enumerate(programs, 1):
                if _is_of_lisp(program):
                    labels = _started(program, number, processes.start(program, number)) + labels
                    continue
                try:
                    name, _, lines = host.start_program(program.package, program.executable, program.arguments)
                except Refusal as problem:
                    _without(program, servers.NotPossible(str(problem)))
                    continue
                node = graph.active().nodes[name]
                nodes.append(node)
                keyboard = node if _reads_keys(program) else keyboard
                labels = _started(program, number, os.getpid()) + labels
                for line in lines:
                    show(line)
                node.program.echo = _both(node.program.echo)
            if view is None and _has_window(programs):
                _tell(f"The page: {window.page(show=page.opens_by_itself() and not again, asked=False).url}")
            ended = _wait(nodes, processes, keyboard)
            return ended if ended == "moved" else 0 if labels else max((node.program.status for node in nodes), default=0)
        except (KeyboardInterrupt, kernel.Terminated, kernel.Abandoned):
            _closing(labels)
            return 0


def _both(tell):
    def echo(line):
        show(line)
        tell(line)

    return echo


def _wait(nodes, processes, keyboard=None):
    """Wait until all nodes and processes have ended (``"ended"``) or a session has started elsewhere (``"moved"``).

    keyboard: the node that gets the keys of this terminal meanwhile.
    """
    from cramhy_runtime import kernel

    from . import live_page

    look = kernel.now() + LOOK_AGAIN
    with _keys(keyboard) as read:
        while processes.running() or any(node.alive for node in nodes):
            if keyboard is not None and keyboard.alive:
                typed = kernel.run_blocking(read)
                if typed:
                    keyboard.program.feed(typed)
                if kernel.now() < look:
                    continue
            else:
                kernel.sleep(LOOK_AGAIN)
            look = kernel.now() + LOOK_AGAIN
            newest = kernel.run_blocking(_newest)
            if newest is not None and newest.pid != os.getpid():
                live_page.follow()
                return "moved"
    return "ended"


def _others():
    """The sessions of other processes that live now."""
    from cramhy_runtime.rosbridge import sessions

    try:
        return [each for each in sessions.living() if each.pid != os.getpid()]
    except sessions.Unsafe:
        return []


def _newest():
    from cramhy_runtime.rosbridge import sessions

    try:
        return sessions.current()
    except sessions.Unsafe:  # what runs here goes on
        return None
