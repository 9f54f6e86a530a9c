"""What a submission may use to change the world, as the exercise allows it; every other use costs the check, by its name.

A submission may send commands to turtle1. Services of the simulator, other turtles, nodes, parameters, and Python from Lisp must stand in
the exercise's ``allow``, or a service in the check's ``services``. So what carries the turtle cannot be forgotten: it is not allowed unless
somebody has written it down.
"""

from __future__ import annotations

from .problems import ExerciseError

SERVICES = ("set_pen", "teleport_absolute", "teleport_relative", "spawn", "kill", "clear", "reset")
CARRYING = ("teleport_absolute", "teleport_relative", "reset")
ALLOWED = {
    "python": "Python, from Lisp; a file in Python or Hy that is handed in has it always",
    "turtles": "commands to other turtles than turtle1",
    "nodes": "further nodes and simulators, such as the demonstrations of turtlesim",
    "parameters": "parameters of the simulator, such as its background",
    "early": "commands and services before the plan is called",
}
"""What stands in ``allow`` beside the names of services."""
OF_USE = {
    "python": ("python", "The program calls Python ({name}), which this exercise does not allow. Write it in Lisp."),
    "code": ("python", "The program loads code from {name}, which was not handed in and is not Lisp."),
    "inside": (
        "python",
        "The program opens {name}, where the system shows this process itself. An exercise has nothing to look for there.",
    ),
    "node": ("nodes", "The program starts the node {name}, which this exercise does not allow. The check starts all that is needed."),
    "simulator": ("nodes", "The program {name} the simulator, which this exercise does not allow."),
    "parameter": ("parameters", "The program changes the parameter {name}, which this exercise does not allow."),
    "publication": ("nodes", "The program publishes on {name}, which only the simulator does. Choose a topic of your own."),
    "service": ("nodes", "The program offers the service {name}, which is the simulator's. Give yours another name."),
    "function": (None, "The program changes {name}, which the check calls. Give yours another name."),
    "early": (
        "early",
        "The program {name} before it is asked to. That does not count. Do it in the function that the check calls, and not while the "
        "file is loaded.",
    ),
}
"""For each use that a process tells of: what allows it, and the sentence if nothing does."""


def checked(allow, where):
    """``allow`` of an exercise or a check, a list of names, if all mean something. Raises `ExerciseError`."""
    if not isinstance(allow, list) or not all(isinstance(name, str) for name in allow):
        raise ExerciseError(f'allow of {where} is {allow!r}, and not a list of texts, such as ["set_pen"].')
    unknown = [name for name in allow if name not in SERVICES and name not in ALLOWED]
    if unknown:
        names = ", ".join((*SERVICES, *ALLOWED))
        raise ExerciseError(f"allow of {where} has {', '.join(unknown)}, which means nothing. There are {names}.")
    return allow


def allowed(exercise, table):
    """The names that a check allows: those of the exercise, its own, and the services that it counts. table: of the check."""
    names = {*exercise.allow, *table.get("allow", ()), *table.get("services", ())}
    names |= set(CARRYING) if table.get("teleports", 0) != 0 else set()
    if any(name.endswith((".py", ".hy")) for name in exercise.submission):
        names.add("python")
    return names


def faults(allow, told):
    """What a submission used without being allowed to, as sentences. allow: a set of names. told: a `Told`."""
    wrong = []
    for what, name in told.uses:
        needed, sentence = OF_USE[what]
        if needed not in allow:
            wrong.append(sentence.format(name=name))
    begin = told.run["begin"] if told.run else 0
    for tick, kind, turtle, *_ in told.heard:
        if kind != "command" and kind not in allow:
            wrong.append(f"The program calls the service {kind}, which this exercise does not allow.{_MORE.get(kind, '')}")
        elif kind == "command" and turtle != "turtle1" and "turtles" not in allow:
            wrong.append(f"The program drives {turtle}, which this exercise does not allow. Drive turtle1.")
        if tick < begin and "early" not in allow:
            wrong.append(OF_USE["early"][1].format(name="drives" if kind == "command" else f"calls the service {kind}"))
    return list(dict.fromkeys(wrong))[:6]


_MORE = {name: " A turtle that is carried has not driven. Send commands, as send-vel-cmd does." for name in (*CARRYING, "spawn", "kill")}
