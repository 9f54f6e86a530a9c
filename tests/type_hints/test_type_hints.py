"""What type checkers, and editors, know of the library: programs of users pass ``mypy --strict``, mistakes are told, and public names
have types. mypy runs once, over all of it (`checking.Checked`)."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy", reason="the types are looked at with it: pip install 'mypy==2.4.*'")

from checking import ROOMS, ROOT, Checked, known_figures, page_as_program  # noqa: E402

HERE = Path(__file__).parent
PROGRAMS = sorted((HERE / "programs").glob("*.py"))
TUTORIALS = [ROOT / "tutorials" / "plans_in_python.py", ROOT / "tutorials" / "reasoning_in_python.py"]
MISTAKES = sorted((HERE / "mistakes").glob("*.py"))
PAGES = [
    page for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))] if "\n```python\n" in page.read_text(encoding="utf-8")
]
WITHOUT_TYPES = {"operators.md", "python.md"}
"""Pages whose examples have no types: one-liners beside the same in Lisp and Hy, and a module that Lisp has made."""
SHOWN_AS_A_MISTAKE = "for mistake in (lambda: Driving(sped=1.0), lambda: motion.sped):"
TYPED_ROOMS = "kernel cpl prolog designators process_modules ros turtlesim testing".split()


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Page → its program."""
    folder = tmp_path_factory.mktemp("pages")
    return {page: page_as_program(page, folder) for page in PAGES if page.name not in WITHOUT_TYPES}


@pytest.fixture(scope="module")
def checked(pages):
    return Checked([*PROGRAMS, *TUTORIALS, *MISTAKES, *pages.values()])


@pytest.mark.parametrize("program", [*PROGRAMS, *TUTORIALS], ids=lambda path: path.stem)
def test_a_program_of_a_user_passes(checked, program):
    assert checked.about(program) == []


@pytest.mark.parametrize("page", [page for page in PAGES if page.name not in WITHOUT_TYPES], ids=lambda page: page.stem)
def test_what_stands_on_a_page_passes(checked, pages, page):
    lines = page.read_text(encoding="utf-8").splitlines()
    found = checked.about(pages[page])
    assert [each for each in found if lines[int(each.partition(":")[0]) - 1] != SHOWN_AS_A_MISTAKE] == []


def test_there_are_pages():
    assert len(PAGES) > 12


def test_a_mistake_that_a_page_shows_is_seen(checked, pages):
    (program,) = [program for page, program in pages.items() if page.name == "reasoning-in-python.md"]
    assert len(checked.about(program)) == 2


@pytest.mark.parametrize("path", MISTAKES, ids=lambda path: path.stem)
def test_a_mistake_is_told(checked, path):
    """Each line that says so has that error (or one of several, with strokes between them), and no other line has one."""
    lines = path.read_text().splitlines()
    wanted = {number: line.partition("# error: ")[2] for number, line in enumerate(lines, 1) if "# error: " in line}
    told = {}
    for complaint in checked.about(path):
        number, _, text = complaint.partition(": ")
        told.setdefault(int(number), []).append(text)
    assert len(wanted) > 40 and told.keys() == wanted.keys(), told.keys() ^ wanted.keys()
    for number, texts in wanted.items():
        assert any(text in each for text in texts.split("|") for each in told[number]), (lines[number - 1], told[number])


def test_the_programs_can_be_imported():
    """What stands in annotations is there when the code runs, too; the programs have no ``from __future__ import annotations``."""
    code = "import sys; sys.path[:0] = sys.argv[1:2]\nfor name in sys.argv[2:]: __import__(name)"
    names = [path.stem for path in PROGRAMS]
    done = subprocess.run([sys.executable, "-c", code, str(HERE / "programs"), *names], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("room", TYPED_ROOMS)
def test_every_public_name_has_a_type(checked, room):
    """Else the wheel may not have ``py.typed``, by which type checkers believe us."""
    assert [name for name, lack in checked.names_of(room).items() if lack == "untyped"] == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("room", ROOMS)
def test_no_figure_rises(checked, room):
    """The ratchet. What is counted: ``python tests/type_hints/checking.py --list ROOM``; without --list lower figures are written down."""
    known, now = known_figures()[room], checked.figures()[room]
    risen = {what: f"{known[what]} -> {now[what]}" for what in known if now[what] > known[what]}
    assert not risen, f"Give what is new in {room} types: python tests/type_hints/checking.py --list {room}"


def test_what_has_no_type_is_counted(checked):
    """The counting itself: of the rooms that have not been looked at yet some names have none."""
    lacks = [lack for room in ROOMS for lack in checked.names_of(room).values()]
    assert lacks.count(None) > 1000 and lacks.count("any") and lacks.count("untyped")


@pytest.mark.soak
def test_plans_load_no_typing():
    code = "import sys, cramhy_runtime.cpl; print(sorted({'typing', 'typing_extensions'} & set(sys.modules)))"
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout.strip() == "[]"
