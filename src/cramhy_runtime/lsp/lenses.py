"""Lenses: ``Run`` above plans that take no arguments and above top-level calls of ``top-level``, ``Test`` above tests.

What a lens starts is `Errand`: which program runs, in a process of its own, so that a plan that never ends is the user's to interrupt and
the server goes on.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import NamedTuple

from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.session.lookup import bare_name

from . import neighbours, outlines
from .meanings import package_name_at
from .texts import Form

RUN, TEST = "Run", "Test"
_TESTS = frozenset(("define-test", "deftest", "def-test", "test"))
_PLANS = frozenset(("top-level", "def-top-level-cram-function"))
_FUNCTIONS = frozenset(("defun", "defn", "def-top-level-cram-function"))
_CLI = (sys.executable, "-m", "cramhy_runtime.cli")


class Lens(NamedTuple):
    """start, end: offsets of the form in the text. title: `RUN` or `TEST`. name: of the plan or test; "" for the form itself."""

    start: int
    end: int
    title: str
    name: str


class Errand(NamedTuple):
    """What runs. words: the command. folder: where it runs. what: as the user is told."""

    words: tuple
    folder: str
    what: str


def lenses(document):
    """The `Lens`es of a text."""
    if document.kind not in ("lisp", "hy"):
        return []
    found = []
    for form in document.text.forms:
        operator = form.word(0).lower().rpartition(":")[2]
        name = form.word(1)
        if operator in _TESTS and name or document.kind == "hy" and operator == "defn" and name.startswith("test-"):
            found.append(Lens(form.start, form.end, TEST, name))
        elif operator in _FUNCTIONS and name and _takes_none(form) and _is_plan(form):
            found.append(Lens(form.start, form.end, RUN, name))
        elif operator == "top-level" and document.kind == "lisp":
            found.append(Lens(form.start, form.end, RUN, ""))
    return found


def _takes_none(form):
    parameters = form.items[2] if len(form.items) > 2 else None
    if not isinstance(parameters, Form):
        return False
    first = parameters.items[0] if parameters.items else None
    return first is None or isinstance(first, Form) or first.text.startswith("&")  # a list there has a default: [goal None]


def _is_plan(form):
    """Whether a plan is begun in ``form``."""
    waiting = [form]
    while waiting:
        each = waiting.pop()
        if each.word(0).lower().rpartition(":")[2] in _PLANS:
            return True
        waiting += [item for item in each.items if isinstance(item, Form)]
    return False


def errand(document, title, name):
    """The `Errand` of the lens ``title`` above ``name``; `LookupError` if the text has none.

    A plan wants a node of ROS, so the function ``init`` of its system runs before it, if there is one that takes no arguments.
    """
    lens = next((each for each in lenses(document) if each.title == title and each.name == name), None)
    if lens is None:
        raise LookupError(f"There is no {title} above {name or 'a form'} in {Path(document.filename).name}.")
    path = Path(document.path)
    if document.kind == "hy":
        return _of_hy(document, path, title, name)
    if title == TEST:
        return Errand((*_CLI, "test", str(path), "--only", bare_name(name)), str(path.parent), f"the test {name}")
    asd = document.in_image(lambda: _system_file(path))
    package = (package_name_at(document.text, lens.start) or "CL-USER").lower()
    form = f"({package}::{name.lower().rpartition(':')[2]})" if name else None
    begin = f"({package}::init)" if asd and name.lower() != "init" and _defines_init(document) else None
    forms = [each for each in (begin, form) if each]
    if not name:  # the file itself ends with it
        return Errand((*_CLI, "run", str(path)), str(path.parent), str(path.name))
    words = [word for each in forms for word in ("--eval", each)]
    return Errand((*_CLI, "run", str(asd or path), *words), str(path.parent), " ".join(forms))


def _system_file(path):
    """The ``.asd`` file of the system that ``path`` belongs to, or ``None``."""
    for system in list(systems.systems.values()):
        if isinstance(system, systems.System) and system.file and any(part.pathname == path for part in systems.files_of(system)):
            return system.file
    return None


def _defines_init(document):
    for text in [document.text, *(text for _, text in neighbours.texts(document))]:
        for form in text.forms:
            if form.word(0).lower() in _FUNCTIONS and form.word(1).lower() == "init" and _takes_none(form):
                return True
    return False


def _of_hy(document, path, title, name):
    if title == TEST:
        words = (sys.executable, "-m", "pytest", "-q", f"{path}::{name.replace('-', '_')}")
        return Errand(words, str(path.parent), f"the test {name}")
    package = path.parent.name.replace("-", "_") if re.search(r"\(import[^()]*\s\.", document.text.text) else None
    module = f"{package}.{path.stem}" if package else path.stem
    folder = path.parent.parent if package else path.parent
    begins = any(operator == "defn" and each == "init" for operator, each, *_ in outlines.definitions(document.text)) and name != "init"
    calls = ["init", name] if begins else [name]
    program = (
        "import hy, importlib, sys; from cramhy_runtime.session.boot import fresh_start; "
        f"sys.path.insert(0, {str(folder)!r}); fresh_start(); m = importlib.import_module({module!r}); "
        + "; ".join(f"r = getattr(m, hy.mangle({call!r}))()" for call in calls)
        + "; print(hy.repr(r)) if r is not None else None"
    )
    return Errand((sys.executable, "-c", program), str(path.parent), " ".join(f"({call})" for call in calls))
