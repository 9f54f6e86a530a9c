"""ARCHITECTURE.md and its picture tell of the code that is there: its floors, its rooms, its files and what is defined in them."""

from __future__ import annotations

import ast
import functools
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from test_house import FLOORS, ROOT, SOURCE, TEXTS, offences

PAGE = (ROOT / "ARCHITECTURE.md").read_text()
PICTURE = ROOT / "docs" / "explanation" / "architecture.svg"
SVG = "{http://www.w3.org/2000/svg}"
ROOMS = {path.parent.name for path in SOURCE.glob("*/__init__.py")} | {path.stem for path in SOURCE.glob("*.py")}

PATH = r"`([\w./-]+(?:\.(?:py|hy|md|svg|js)|/))`"
NAMED = re.compile(PATH + r"((?:,?\s`[\w.!?*<>=%-]+`)*)")
"""A path in backquotes, and the names that follow it directly, each in backquotes, with commas between."""


def found(path):
    """The file or folder that a path of the page means: below the runtime's folder, or below the root."""
    return next((place / path for place in (SOURCE, ROOT) if (place / path).exists()), None)


@functools.cache
def definitions(file):
    """The names that a file defines: functions, classes and variables of a module, and ``Class.method``; macros of a Hy file."""
    text = file.read_text()
    if file.suffix == ".hy":
        return {name.strip('"') for name in re.findall(r"^\((?:def[\w-]*) ([^\s()\[\]]+)", text, re.M)}
    return set(_defined(ast.parse(text).body, ""))


def _defined(body, prefix):
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield prefix + node.name
        if isinstance(node, ast.ClassDef):
            yield from _defined(node.body, f"{prefix}{node.name}.")
        for target in getattr(node, "targets", [getattr(node, "target", None)]):
            if isinstance(target, ast.Name):
                yield prefix + target.id


NAMES = [
    (path, name)
    for path, names in NAMED.findall(PAGE)
    if path.endswith((".py", ".hy"))
    for name in re.findall(r"`([^`]+)`", names)
    if "/" not in name
]


def test_the_page_has_the_floors_of_the_house_in_order():
    floors = re.split(r"^### Floor (\d+)\n", PAGE.partition("## The way of a form")[0], flags=re.M)[1:]
    assert [int(number) for number in floors[::2]] == list(range(len(FLOORS)))
    assert [re.findall(r"^\* `(\w+)`: ", text, re.M) for text in floors[1::2]] == FLOORS


def test_every_room_is_on_the_page_and_in_the_picture():
    told = set(re.findall(r"^\* `(\w+)`: ", PAGE, re.M))
    drawn = {text.strip() for text in ElementTree.parse(PICTURE).getroot().itertext()}
    assert ROOMS == told
    assert ROOMS - {"__init__"} <= drawn
    assert "](docs/explanation/architecture.svg)" in PAGE


def test_the_picture_has_the_floors_in_order():
    floors, tops = [], []
    for floor in ElementTree.parse(PICTURE).getroot().iter(f"{SVG}g"):
        rooms = [text for text in floor.iter(f"{SVG}text") if text.get("class") == "room"]
        floors.append(["".join(text.itertext()) for text in sorted(rooms, key=lambda text: float(text.get("x")))])
        tops.append(float(re.match(r"translate\(\S+ (\S+)\)", floor.get("transform"))[1]))
    assert tops == sorted(set(tops))  # from the roof down
    assert floors[::-1] == [[room for room in rooms if room != "__init__"] for rooms in FLOORS]


def test_the_picture_has_words_for_those_who_do_not_see_it():
    root = ElementTree.parse(PICTURE).getroot()
    assert root.get("role") == "img"
    assert root.find(f"{SVG}title").text.strip() and root.find(f"{SVG}desc").text.strip()


def test_every_path_on_the_page_is_there():
    assert [path for path in set(re.findall(PATH, PAGE)) if found(path) is None] == []


def test_what_the_page_finds_in_a_file_is_defined_there():
    assert [(path, name) for path, name in set(NAMES) if name not in definitions(found(path))] == []


def test_the_page_is_linked_from_the_readme():
    assert "](ARCHITECTURE.md)" in (ROOT / "README.md").read_text()
    assert all(Path(ROOT / link).exists() for link in re.findall(r"\]\(((?!#|https?:)[^)#]+)\)", PAGE))


CODE = [path for path in TEXTS if path.relative_to(ROOT).parts[0] in ("src", "hy_src")]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "tutorials").glob("*.md"), *(ROOT / "docs").rglob("*.md")])


def test_every_file_that_the_code_names_is_there():
    def missing(file):
        # The path begins in the folder of the file that names it, or in one around that; the macros name files of the plan language.
        folders = [folder for folder in file.parents if folder == ROOT or ROOT in folder.parents] + [SOURCE, SOURCE / "cpl"]
        named = re.findall(r"`([\w/.-]+\.(?:py|hy))`", file.read_text())
        return [path for path in named if not any((folder / path).exists() for folder in folders)]

    assert offences(missing, CODE) == {}


def test_every_file_that_a_page_names_is_there():
    named = re.compile(r"`((?:src|hy_src|docs|tests|tutorials|benchmarks)/[\w/.-]*)(?:::\w+)?`|`([\w.-]+/[\w/.-]+\.py)`")
    packages = [ROOT / "tutorials" / package for package in ("cram_my_beginner_tutorial", "kitchen/cram_my_pick_place_tutorial")]

    def missing(page):
        paths = ["".join(path) for path in named.findall(page.read_text())]
        return [path for path in paths if not found(path) and not any((package / path).exists() for package in packages)]

    assert offences(missing, PAGES) == {}
