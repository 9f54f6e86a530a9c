"""The part of the tests that says whether cramhy works on a system or a Python: ``python tests/portable.py`` runs it with this one.

It needs pytest and hypothesis. The whole suite runs where development happens, on Linux; `test_missing_systems`, `test_interpreters` and
the workflow of GitHub run this part elsewhere.
"""

from __future__ import annotations

import sys
from pathlib import Path

TESTS = Path(__file__).parent
SUITES = {
    "kernel": "baton deadlock interrupts outside requests_to_end set_clock timers virtual_time wall_time",
    "cpl": "laws/failure_laws failures fluents operators python_blocks tasks",
    "prolog": "fact_groups patterns prolog_page python_rules queries trail",
    "designators": "descriptions designators_in_python resolution",
    "process_modules": "laws/asynchronous_laws laws/executive_laws executive modules performing running_modules",
}
"""The files of each room's tests that hold its main behaviour, without those that take long."""
PROMPTS = {"repl": "console prompt_words", "hy_door": "goes_on ways_in"}
"""Those of the prompts, which need a terminal of POSIX."""


def files(room: str) -> list[str]:
    """The paths of the files of a room's tests that belong to this part."""
    names = (name.rpartition("/") for name in {**SUITES, **PROMPTS}[room].split())
    return [str(TESTS / room / folder / f"test_{name}.py") for folder, _, name in names]


def main() -> int:
    """Run this part; pytest's exit status."""
    import pytest

    rooms = [*SUITES, *(() if sys.platform == "win32" else PROMPTS)]
    chosen = [file for room in rooms for file in files(room)]
    return pytest.main(["-q", "-p", "no:cacheprovider", "--rootdir", str(TESTS.parent), *sys.argv[1:], *chosen])


if __name__ == "__main__":
    sys.exit(main())
