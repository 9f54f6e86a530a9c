"""One run of mypy over the library and over programs that use it: what it complains of, and what it knows of public names.

``python tests/type_hints/checking.py`` writes those figures down that have become lower; with ``--list ROOM`` it shows what is counted.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections import Counter
from pathlib import Path

from mypy import build
from mypy.main import process_options
from mypy.modulefinder import BuildSource
from mypy.nodes import Decorator, FuncDef, MypyFile, OverloadedFuncDef, TypeAlias, TypeInfo, Var
from mypy.type_visitor import TypeQuery
from mypy.types import AnyType, TypeOfAny, get_proper_type

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src"
ROOMS = ["kernel", "cpl", "prolog", "designators", "process_modules", "ros", "turtlesim", "testing", "transforms", "tf", "robot"]
BY_MODULES = {"ros", "turtlesim", "transforms", "tf"}  # whose users import the modules; the other rooms export what is public

OPTIONS = """--strict --python-version 3.11 --platform linux --ignore-missing-imports --no-error-summary --hide-error-context
    --no-color-output --cache-dir""".split()
NOT_FOLLOWED = """PIL cbor2 coverage greenlet hy hyrule mcap numpy prompt_toolkit pygments rich roslibpy scipy uvicorn
    websockets yaml""".split()
"""Packages of others that need not be there, or may be of any version: what they say of themselves must not change our figures."""
FIGURES = Path(__file__).with_name("figures.json")
CONSEQUENCES = {"no-untyped-call"}  # of what is counted already: that the function which is called has no types

_COMPLAINT = re.compile(r"(?P<file>[^:]+):(?P<line>\d+): error: (?P<text>.*?)(?:  \[(?P<code>[\w-]+)\])?$")
_SPECIAL = {
    "__init__",
    "__call__",
    "__enter__",
    "__exit__",
    "__getattr__",
    "__getitem__",
    "__iter__",
    "__next__",
    "__len__",
    "__contains__",
}


class Checked:
    """What mypy found: ``complaints`` are (file, line, text, code), and `untyped_names` looks at the types of public names."""

    def __init__(self, files):
        """files: the programs, as paths. The rooms of the library are looked at as well."""
        sources, options = process_options([*OPTIONS, os.devnull, *(map(str, files) if files else ("-c", "pass"))])
        options.mypy_path = [str(SOURCE)]
        for package in NOT_FOLLOWED:
            options.per_module_options[package] = options.per_module_options[package + ".*"] = {"follow_imports": "skip"}
        sources += [
            BuildSource(str(path), _module_name(path))
            for room in ROOMS
            for path in sorted((SOURCE / "cramhy_runtime" / room).rglob("*.py"))
        ]
        result = build.build(sources, options)
        self.modules = result.files
        found = map(_COMPLAINT.match, result.errors)
        self.complaints = [(Path(each["file"]).resolve(), int(each["line"]), each["text"], each["code"]) for each in found if each]

    def about(self, path):
        """The complaints about one file, ``line: text  [code]``."""
        return [f"{line}: {text}  [{code}]" for file, line, text, code in self.complaints if file == Path(path).resolve()]

    def errors_of_rooms(self):
        """Room → how many complaints there are about its files."""
        counted = Counter()
        for file, _, _, code in self.complaints:
            if code not in CONSEQUENCES and file.is_relative_to(SOURCE / "cramhy_runtime"):
                counted[file.relative_to(SOURCE / "cramhy_runtime").parts[0]] += 1
        return {room: counted[room] for room in ROOMS}

    def figures(self):
        """Room → {"untyped": public names without a type, "any": with an Any in it, "errors": what mypy --strict says of the room}."""
        errors = self.errors_of_rooms()
        counted = {room: Counter(self.names_of(room).values()) for room in ROOMS}
        return {room: {"untyped": counted[room]["untyped"], "any": counted[room]["any"], "errors": errors[room]} for room in ROOMS}

    def names_of(self, room):
        """The public names of a room: dotted name → ``None`` when its type says something, else "untyped" or "any"."""
        package = f"cramhy_runtime.{room}"
        if room in BY_MODULES:
            modules = [module for name, module in self.modules.items() if name.startswith(package + ".")]
            nodes = [
                symbol.node
                for module in modules
                for name, symbol in module.names.items()
                if not name.startswith("_") and symbol.node is not None and symbol.node.fullname == f"{module.fullname}.{name}"
            ]
        else:
            public = self.modules[package].names.items()
            nodes = [symbol.node for name, symbol in public if symbol.module_public and not name.startswith("_")]
        found = {}
        for node in nodes:
            if not isinstance(node, (MypyFile, type(None))):
                found[node.fullname.removeprefix(package + ".")] = _lack(node)
                if isinstance(node, TypeInfo):
                    found.update(_members(node, package))
        return found


def _module_name(path):
    return ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__")


def _members(cls, package):
    """What a class has, with what it has from classes of the same room."""
    for base in cls.mro:
        if base.fullname.startswith(package + "."):
            for name, symbol in base.names.items():
                if symbol.node is not None and (not name.startswith("_") or name in _SPECIAL):
                    yield symbol.node.fullname.removeprefix(package + "."), _lack(symbol.node)


def _lack(node):
    """What the type of a name lacks: "untyped" if nobody has said it, "any" if it says Any somewhere, ``None`` if it is all there."""
    if isinstance(node, Decorator):
        return "untyped" if node.func.type is None else _any_in(node.var.type)
    if isinstance(node, OverloadedFuncDef):
        return _any_in(node.type) if node.type is not None else next(filter(None, map(_lack, node.items)), None)
    if isinstance(node, FuncDef):
        if node.type is None or any(map(_unsaid, [*node.type.arg_types, node.type.ret_type])):
            return "untyped"
        return _any_in(node.type)
    if isinstance(node, Var):
        return _any_in(node.type)
    return _any_in(node.target) if isinstance(node, TypeAlias) else None


def _unsaid(found):
    found = get_proper_type(found)
    return isinstance(found, AnyType) and found.type_of_any == TypeOfAny.unannotated


def _any_in(found):
    return "any" if found is None or found.accept(_HasAny()) else None


class _HasAny(TypeQuery):
    """Whether there is an Any in a type, besides the parameters of ``Callable[..., T]``."""

    def strategy(self, parts):
        return any(parts)

    def visit_any(self, found):
        return True

    def visit_callable_type(self, found):
        return found.ret_type.accept(self) if found.is_ellipsis_args else super().visit_callable_type(found)

    def visit_type_var(self, found):
        return False

    visit_param_spec = visit_type_var_tuple = visit_type_var

    def visit_tuple_type(self, found):
        return any(part.accept(self) for part in found.items)


def page_as_program(page, folder):
    """A page's Python blocks as one program in ``folder``, line by line where they stand on the page; its path."""
    lines, inside = [], False
    for line in page.read_text().splitlines():
        if line.startswith("```"):
            inside = line == "```python"
            lines.append("")
        else:
            lines.append(line if inside else "")
    path = folder / f"page_{page.stem.replace('-', '_').lower()}.py"
    path.write_text("\n".join(lines) + "\n")
    return path


def known_figures():
    """The figures that nobody may raise, as `Checked.figures` counts them."""
    return json.loads(FIGURES.read_text())


def main():
    checked = Checked([])
    if "--list" in sys.argv:
        room = sys.argv[-1]
        print(*(f"{lack}: {name}" for name, lack in checked.names_of(room).items() if lack), sep="\n")
        home = SOURCE / "cramhy_runtime" / room
        print(*(f"{file}:{line}: {text}  [{code}]" for file, line, text, code in checked.complaints
                if file.is_relative_to(home) and code not in CONSEQUENCES), sep="\n")  # fmt: skip
        return
    known = known_figures() if FIGURES.exists() else {}
    lower = {
        room: {what: min(count, known.get(room, {}).get(what, count)) for what, count in counts.items()}
        for room, counts in checked.figures().items()
    }
    FIGURES.write_text("{\n" + ",\n".join(f'  "{room}": {json.dumps(counts)}' for room, counts in lower.items()) + "\n}\n")


if __name__ == "__main__":
    main()
