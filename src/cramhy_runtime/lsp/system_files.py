"""Files that define systems: ``.asd`` files, of which only ``defsystem`` and what goes into packages takes effect."""

from __future__ import annotations

from pathlib import Path

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Condition, SimpleWarning
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.lisp_core.packages import is_symbol, near_names, symbol_name
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import PACKAGE, evaluate
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.languages.commonlisp.systems.loader import locate
from cramhy_runtime.languages.commonlisp.systems.system_definitions import define_system

from .findings import meant, meant_in_lisp

COMPONENTS = ("FILE", "MODULE", "STATIC-FILE", "DOC-FILE", "HTML-FILE", "CL-SOURCE-FILE")
OPTIONS = """DEPENDS-ON COMPONENTS SERIAL PATHNAME IF-FEATURE WEAKLY-DEPENDS-ON DEFSYSTEM-DEPENDS-ON IN-ORDER-TO PERFORM AROUND-COMPILE
NAME AUTHOR MAINTAINER LICENSE LICENCE DESCRIPTION LONG-DESCRIPTION VERSION LONG-NAME MAILTO HOMEPAGE BUG-TRACKER SOURCE-CONTROL CLASS
ENCODING DEFAULT-COMPONENT-CLASS BUILD-OPERATION BUILD-PATHNAME ENTRY-POINT EXPLAIN FEATURE""".split()
_EVALUATED = ("IN-PACKAGE", "DEFPACKAGE")


MOST_BELOW = 6
_DEPTH = 4


def below(folder):
    """The first `MOST_BELOW` ``.asd`` files in ``folder`` and in the folders in it, not below hidden ones, nor deeper than four."""
    found, waiting = [], [(Path(folder), 0)]
    while waiting and len(found) < MOST_BELOW:
        place, depth = waiting.pop(0)
        try:
            entries = sorted(place.iterdir())
        except OSError:
            continue
        found += [entry for entry in entries if entry.suffix == ".asd" and entry.is_file()]
        if depth < _DEPTH:
            waiting += [(entry, depth + 1) for entry in entries if not entry.name.startswith((".", "node_modules")) and entry.is_dir()]
    return found[:MOST_BELOW]


def check(text, filename, fail):
    """Read the definitions in ``text``, of the file ``filename``. Returns the package at its end. fail: called with each condition."""
    reader, end = Reader(text, filename=filename), object()
    while True:
        try:
            form = reader.read(eof_error=False, eof_value=end)
        except (Exception, Condition) as problem:
            fail(from_python(problem))
            break
        if form is end:
            break
        name = symbol_name(form.car) if isinstance(form, Cons) and is_symbol(form.car) else None
        try:
            if name == "DEFSYSTEM":
                before = set(systems.systems)
                system = define_system(form, Path(filename).parent, Path(filename), reader.positions, lambda *ignored, **options: None)
                _check_system(system or _new(before), form, reader, fail)
                _check_words(form, reader, fail)
            elif name in _EVALUATED:
                evaluate(form, filename, reader.positions)
            elif name is not None and (near := near_names(name, ("DEFSYSTEM", *_EVALUATED))):
                hint = meant_in_lisp(near[:1])
                _warn(fail, f"A file of systems has no {name.lower()}.", name.lower(), hint, reader, reader.positions.get(id(form), (1, 1)))
        except (Exception, Condition) as problem:
            condition = from_python(problem)
            locate(condition, filename, reader.positions.get(id(form)))
            fail(condition)
    return PACKAGE.value


def _check_words(form, reader, fail):
    """Tell of options and kinds of components that ASDF does not know."""
    for item, place in _lists(form, reader):
        words = [each for each in item if isinstance(each, Keyword)]
        kind = item.car if isinstance(item.car, Keyword) else None
        if kind is not None:
            _check_word(kind, "component", COMPONENTS, reader, place, fail)
        for option in words[1 if kind is not None else 0 :]:
            _check_word(option, "option", OPTIONS, reader, place, fail)


def _check_word(word, what, known, reader, place, fail):
    """Tell of a keyword that is none of the ``known`` names, if it is almost one of them."""
    near = near_names(word.name, known) if word.name not in known else ()
    if near:
        written = f":{word.name.lower()}"
        _warn(fail, f"There is no {what} {written}.", written, meant_in_lisp(near, ":"), reader, place)


def _lists(form, reader):
    """(list, place) of the ``defsystem`` form and of those in it that are components."""
    yield form, reader.positions.get(id(form), (1, 1))
    waiting = [form.cdr]
    while waiting:
        cell = waiting.pop()
        while isinstance(cell, Cons):
            if isinstance(cell.car, Cons):
                waiting.append(cell.car)
                if isinstance(cell.car.car, Keyword) and isinstance(cell.car.cdr, Cons) and isinstance(cell.car.cdr.car, (str, Symbol)):
                    yield cell.car, reader.positions.get(id(cell.car), (1, 1))
            cell = cell.cdr


def _new(before):
    return next((system for name, system in systems.systems.items() if name not in before), None)


def _check_system(system, form, reader, fail):
    if not isinstance(system, systems.System):
        return
    start = reader.positions.get(id(form), (1, 1))
    known = systems.known_systems()
    for name, _ in system.depends_on:
        name = str(name).lower()
        if name not in known and not systems.is_provided(name) and systems.find_asd(name) is None and name not in systems.systems:
            near = near_names(name, known)
            _warn(fail, f"There is no system {name}.", name, meant(near), reader, start)
    missing = {}
    for component in systems.files_of(system):
        module = component.parent
        if module is not system and not module.pathname.is_dir():
            missing[module.name] = module.pathname
            continue
        if not component.pathname.is_file():
            there = [path.stem for path in component.pathname.parent.glob("*") if path.suffix in (".lisp", ".hy")]
            near = near_names(component.name, there)
            hint = meant(near) or f"There is no file {component.pathname}."
            _warn(fail, f"The file of the component {component.name} is missing.", component.name, hint, reader, start)

    for name, folder in missing.items():
        near = near_names(name, [path.name for path in folder.parent.glob("*") if path.is_dir()])
        hint = meant(near) or f"There is no folder {folder}."
        _warn(fail, f"The folder of the module {name} is missing.", name, hint, reader, start)


def _warn(fail, message, name, hint, reader, start):
    """Tell of ``name``, at the place where it stands in the text of ``reader`` behind ``start`` (line, column)."""
    condition = conditions.from_python(SimpleWarning(message.replace("~", "~~")))
    text, offset = reader.text, 0
    for _ in range(start[0] - 1):
        offset = text.find("\n", offset) + 1
    lower = text.lower()
    at = lower.find(f'"{name}"', offset)
    at = at if at >= 0 else lower.find(name, offset)
    condition.position = (reader.filename, *reader.place(at if at >= 0 else offset)[:2])
    condition.hint = hint
    fail(condition)
