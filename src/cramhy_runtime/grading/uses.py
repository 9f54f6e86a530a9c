"""What a submission does to the world beside commands and services of turtles, noticed in its own process and told at once.

A use is told before it happens, through a pipe from which nothing can be taken back. So a program that gets at the inside of this process
by way of Python has already said so when it gets there. `allowances` says what it costs.
"""

from __future__ import annotations

import os
import re
import sys
from contextlib import contextmanager

from cramhy_runtime.lisp_core import packages
from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.languages.commonlisp.python import python_calls
from cramhy_runtime.ros import graph

MOST_TOLD = 20
"""So many uses of a kind are told."""
_KEPT_CODE = b"# cramhy"
"""So begins a file of compiled code."""
_OF_THE_PROCESS = ("/proc/", "/dev/fd", "/dev/std")
"""Here a process finds its own memory, and the pipe through which it is told of."""
_OTHER_LANGUAGES = (".hy", ".py", ".pyc", ".so")


class Uses:
    """Notices uses while `watching`, and tells them by ``tell("used", what=..., name=...)``. files: the names of those handed in.

    folder: where they are, a path; ``None`` if nothing is loaded.
    """

    def __init__(self, tell, files=(), folder=None):
        self.tell = tell
        self.own = {os.path.realpath(os.path.join(folder, name)) for name in files} if folder is not None else set()
        self.folder = os.path.realpath(folder) + os.sep if folder is not None and files else None
        self.told = {}
        self.parameters = None
        self.on, self.nodes = False, True
        self.functions = {}

    def use(self, what, name):
        """Tell a use, if it is a new one."""
        told = self.told.setdefault(what, set())
        if name not in told and len(told) < MOST_TOLD:
            told.add(name)
            self.tell("used", what=what, name=str(name)[:500])

    @contextmanager
    def watching(self):
        """In the block, uses are the submission's."""
        self.on = True
        before = python_calls.watch.function
        python_calls.watch.function = self._python
        active = graph.active()
        active.on_change.append(self._changed)
        try:
            yield
        finally:
            self.on = False
            python_calls.watch.function = before
            if self._changed in active.on_change:
                active.on_change.remove(self._changed)

    @contextmanager
    def paused(self):
        """In the block, nodes are the exercise's."""
        before, self.nodes = self.nodes, False
        try:
            yield
        finally:
            self.nodes = before

    def hear_audit(self, event, arguments):
        """An audit hook of Python, which tells if a program opens code that nobody has handed in (compiled Lisp, Python, Hy), or what the
        system shows of this process.
        """
        if event != "open" or not self.on or self.folder is None or not isinstance(arguments[0], (str, bytes)):
            return
        name = os.fsdecode(arguments[0])
        path = os.path.realpath(name)
        if any(each.startswith(_OF_THE_PROCESS) for each in (path, os.path.abspath(name))):
            self.use("inside", name)
        if not path.startswith(self.folder) or path in self.own:
            return
        self.on = False  # looking opens the file, too
        try:
            if path.endswith(_OTHER_LANGUAGES) or _begins_as_code(path):
                self.on = True
                self.use("code", os.path.relpath(path, self.folder))
        finally:
            self.on = True

    def _python(self, name):
        self.use("python", name)

    def _changed(self, kind, name, there):
        if kind == "node" and there and self.nodes:
            self.use("node", name)

    # ------------------------------------------------------------------------------------------- functions that a check calls

    def keep_functions(self, words):
        """Remember what ``words`` mean, a dictionary from (package, word) to symbols: the submission must not change their functions."""
        self.functions = {place: (symbol, _function(symbol)) for place, symbol in words.items() if _function(symbol) is not None}

    def look_at_functions(self):
        """Tell which of the words that were remembered means something else now."""
        for (package, word), (symbol, function) in self.functions.items():
            if meant(word, package) is not symbol or _function(symbol) is not function:
                self.use("function", f"{symbol.package.name}::{symbol.name}".lower() if symbol.package else word.lower())

    # ------------------------------------------------------------------------------------------------------- the simulator

    def keep_simulator(self, simulator):
        """Remember the parameters of the simulator, which the submission must not change."""
        active, name = graph.active(), simulator.node.name
        self.parameters = active.parameters.get(name) if active.parameters.has(name) else {}
        self.parameters = dict(self.parameters)

    def look_at_simulator(self, simulator):
        """Tell what is not as the simulator has made it: its parameters, its topics and services, and whether it still runs."""
        active, node = graph.active(), simulator.node
        if active.nodes.get(node.name) is not node:
            self.use("simulator", "ends")
            return
        if self.parameters is not None:
            now = active.parameters.get(node.name) if active.parameters.has(node.name) else {}
            now = now if isinstance(now, dict) else {}
            for name in sorted({*self.parameters, *now}):
                if self.parameters.get(name) != now.get(name):
                    self.use("parameter", f"{node.name}/{name}")
        for inhabitant in simulator.inhabitants.values():
            for name in (inhabitant.pose.name, inhabitant.colour.name):
                topic = active.topics.get(name)
                if topic is not None and any(each.node is not node and not each.node.hidden for each in topic.publications):
                    self.use("publication", name)
        for name in _services(simulator):
            service = active.services.get(name)
            if service is not None and service.node is not node:
                self.use("service", name)


def _services(simulator):
    """The names of the services that the simulator offers."""
    names = {simulator.node.resolve(name) for name in ("clear", "reset", "spawn", "kill")}
    return sorted(names.union(*({service.name for service in each.services} for each in simulator.inhabitants.values())))


def _begins_as_code(path):
    try:
        with open(path, "rb") as file:
            return file.read(len(_KEPT_CODE)) == _KEPT_CODE
    except OSError:
        return False


_WORD = re.compile(r"""\|[^|]*\||"(?:\\.|[^"\\])*"|;[^\n]*|[^\s()'`,"#;|]+""", re.S)


def words_in(text, package):
    """The symbols that the text of a form names, a dictionary from (package, word). package: the name of the one in which it is read.

    Nothing is interned.
    """
    words = {word.upper() for word in _WORD.findall(text) if word[0] not in '"|;:'}
    return {(package, word): symbol for word in sorted(words) if (symbol := meant(word, package)) is not None}


def meant(word, package):
    """The symbol that ``word`` means in the package of that name; ``None`` if there is none."""
    prefix, _, name = word.rpartition(":")
    home = packages.find_package(prefix.rstrip(":") or package)
    symbol = home.lookup(name)[0] if home is not None else None
    return symbol if isinstance(symbol, Symbol) else None


def _function(symbol):
    """The function or macro of a symbol; ``None`` if it has none."""
    found = getattr(symbol, "macro", None) or getattr(symbol, "function", None)
    return None if isinstance(found, UndefinedFunction) else found


def listen_to_audit(uses):
    """Let ``uses`` hear what this process opens, until the process ends."""
    sys.addaudithook(uses.hear_audit)
