"""Plans, reasoning and ROS need no language: the rooms below ``languages`` are imported and used where there is none.

Each test runs in a fresh interpreter in which an import of ``cramhy_runtime.languages``, or of the Hy macros in ``cramhy``, is an error.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "cramhy_runtime"
ROOMS = ("kernel", "lisp_core", "utilities", "transforms", "cpl", "prolog", "ros", "designators", "turtlesim", "episodes", "actionlib")
ABOVE = ("occasions", "tf", "process_modules", "projection")
NO_LANGUAGES = """
import sys

class NoLanguages:
    def find_spec(self, name, path=None, target=None):
        if name == "cramhy" or name.startswith(("cramhy.", "cramhy_runtime.languages")):
            raise ImportError(f"{name} is absent here")

sys.meta_path.insert(0, NoLanguages())
"""


SOURCES = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (ROOT / "src", ROOT / "tutorials")))}


def without_languages(program, *arguments):
    done = subprocess.run(
        [sys.executable, "-c", NO_LANGUAGES + program, *arguments], capture_output=True, text=True, timeout=120, env=SOURCES
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def modules_of(room):
    return [
        ".".join(["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__")
        for path in sorted((SOURCE / room).rglob("*.py"))
    ]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("room", [*ROOMS, *ABOVE])
def test_every_module_of_a_room_is_imported_without_languages(room):
    without_languages("import importlib\nfor name in sys.argv[1:]:\n    importlib.import_module(name)\n", *modules_of(room))


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("room", ["cpl", "prolog", "designators", "process_modules", "ros", "turtlesim"])
def test_importing_a_room_loads_nothing_of_languages(room):
    program = f"import cramhy_runtime.{room}, sys; print([name for name in sys.modules if 'languages' in name or name == 'hy'])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert (done.stdout, done.stderr) == ("[]\n", "")


def test_importing_plans_loads_no_library_of_python_that_only_languages_need():
    program = "import sys; before = set(sys.modules); import cramhy_runtime.cpl; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-S", "-c", program], capture_output=True, text=True, timeout=120, env=SOURCES)
    assert done.stderr == ""
    assert not {"re", "fractions", "decimal", "typing", "dataclasses", "inspect", "asyncio"} & set(done.stdout.split())


PAGE_PROGRAM = """
import contextlib, io, json
from cramhy_runtime import kernel

names, printed = {"__name__": "page"}, []
with contextlib.ExitStack() as stack:
    if sys.argv[2] == "aside":
        stack.enter_context(kernel.aside())
    for code in json.loads(sys.argv[1]):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(code, names)
        printed.append(out.getvalue())
print(json.dumps(printed))
"""


@pytest.mark.parametrize("page, clock", [("plans-in-python.md", "aside"), ("reasoning-in-python.md", "")])
def test_the_examples_of_a_page_run_without_languages(page, clock):
    blocks = re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", (ROOT / "docs" / page).read_text(), re.S)
    assert len(blocks) >= 8
    printed = json.loads(without_languages(PAGE_PROGRAM, json.dumps([code for code, _ in blocks]), clock).splitlines()[-1])
    for (code, wanted), given in zip(blocks, printed, strict=True):
        assert given == wanted, code


FAILING = """
from cramhy_runtime import cpl

def main():
    cpl.fail("The cup is ~a: ~s, ~d of ~{~a~^, ~}.", "gone", "red cup", 1200, [1, 2])

try:
    cpl.run(main)
except cpl.PlanFailure as failure:
    print(failure)
print(cpl.make_fluent(name="speed", value=2.5))
"""


def test_failures_and_fluents_are_readable_without_languages():
    shown = without_languages(FAILING)
    assert 'The cup is gone: "red cup", 1200 of' in shown
    assert "#<FLUENT speed [2.5]>" in shown


def test_a_node_with_a_service_an_action_and_a_log_needs_no_language():
    program = """
from cramhy_runtime import kernel
from cramhy_runtime.actionlib.python import action_client, action_server, call_goal, succeed_current
from cramhy_runtime.ros.python import call_service, register_service, ros_info, ros_node

kernel.start(clock="virtual")
with ros_node("driver"):
    register_service("add", "roscpp_tutorials/TwoInts", lambda request: {"sum": request.a + request.b})
    action_server("count", "actionlib_tutorials/FibonacciAction")(lambda goal: succeed_current(sequence=[goal.order]))
    result, state = call_goal(action_client("count", "actionlib_tutorials/FibonacciAction"), order=4)
    ros_info(("base", "drive"), f"{call_service('add', 'roscpp_tutorials/TwoInts', a=3, b=4).sum} {list(result.sequence)} {state}")
"""
    assert re.search(r"\(BASE DRIVE\) INFO\] [0-9.]+: 7 \[4\] :SUCCEEDED", without_languages(program))
