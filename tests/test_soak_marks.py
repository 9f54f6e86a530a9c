"""The mark ``soak``: it means cases that exist, and `make test` keeps a way through each program, and a test of each law."""

from __future__ import annotations

import ast
import functools
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
import soak_marks
import test_invariants
from source_trees import tree_of

TESTS = Path(__file__).parent
WAYS = {
    "the live page, with a session": "view/test_page_of_a_session.py::test_the_keys_drive_the_turtle_while_the_prompt_waits",
    "the live page": "view/test_page.py::test_who_comes_late_sees_all_that_was_drawn",
    "Emacs": "swank/test_emacs.py::test_every_line_of_the_lectures_answers_as_at_the_prompt",
    "VS Code": "lsp/test_vscode.py::test_the_client_speaks_with_the_server",
    "a notebook": "jupyter/test_notebooks.py::test_the_notebook_of_lecture_34_runs_and_shows_the_turtle",
    "WebAssembly, in Node": "webassembly/test_in_node.py::test_a_room_passes_its_tests",
    "a page for a browser's tab": "webassembly/test_tab_page.py::test_the_lesson_is_read_typed_copied_and_its_task_is_hinted_at_and_checked",
    "rosbridge, from Python": "rosbridge/test_roslibpy.py::test_it_drives_the_turtle",
    "rosbridge, from Node": "rosbridge/test_bridge_page.py::test_the_example_of_roslib",
    "a real ROS": "rosbridge/test_ros1.py::test_joining_is_over_when_the_services_are_known",
    "a second terminal": "slides/test_ros_commands.py::test_another_terminal_commands_the_turtle_of_the_repl",
    "the kitchen": "tutorials/test_kitchen.py::test_the_packages_own_tests_pass",
    "the robot, in Python": "robot/test_robot_in_python.py::test_a_cup_is_carried_to_the_table",
    "the robot, in Lisp": "robot_world/test_pick_and_place.py::test_a_bottle_goes_from_the_table_to_the_island",
    "the lectures in Lisp, 34": "slides/test_lecture_34.py::test_every_line_of_the_lecture_answers_as_the_slides_show",
    "the lectures in Lisp, 38": "slides/test_lecture_38.py::test_drive_answers_as_the_slide_shows",
    "the lectures at Hy's prompt": "hy_door/test_lectures.py::test_common_lisp_at_the_prompt_of_hy_is_answered_as_by_roslisp_repl",
    "the course in a terminal": "course/test_in_a_terminal.py::test_the_first_lesson_is_typed_and_its_tasks_are_solved",
    "the course at the prompt": "course/test_every_door.py::test_at_the_prompt",
    "grading": "grading/test_submissions.py::test_the_command_writes_its_reports_and_says_by_its_status_what_came_of_it",
    "the wheel": "test_wheel.py::test_the_wheel_teaches_the_course",
    "README's first hour": "newcomer/test_first_hour.py::test_the_last_command_of_the_readme_opens_a_prompt_and_a_page",
    "the pages": "docs/test_pages.py::test_what_happens_is_what_the_page_shows",
}
"""What users start → the test that `make test` keeps of it."""


def soaks(nodes):
    """The marks ``soak`` in some nodes of a syntax tree, as texts."""
    found = [
        node for each in nodes for node in ast.walk(each) if isinstance(node, ast.Attribute) and ast.unparse(node) == "pytest.mark.soak"
    ]
    calls = {id(node.func): node for each in nodes for node in ast.walk(each) if isinstance(node, ast.Call)}
    return [ast.unparse(calls.get(id(node), node)) for node in found]


@functools.cache
def functions():
    """Each test function by its name, as ``room/test_file.py::test_name`` → whether `make test` runs none of it."""
    found = {}
    for path in sorted(TESTS.rglob("test_*.py")):
        tree, file = tree_of(path), path.relative_to(TESTS).as_posix()
        for_all = [node for node in tree.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "pytestmark"]
        for cls in [tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))]:
            for node in cls.body:
                if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                    name = node.name if cls is tree else f"{cls.name}::{node.name}"
                    marks = [mark for mark in node.decorator_list if getattr(getattr(mark, "func", None), "attr", "") != "parametrize"]
                    found[f"{file}::{name}"] = "pytest.mark.soak" in soaks([*for_all, *getattr(cls, "decorator_list", ()), *marks])
    return found


def test_marks_with_words_or_numbers_mean_cases_that_are_there(request):
    assert request.config.stash[soak_marks.WRONG] == []


def test_marks_with_words_or_numbers_stand_on_functions():
    wrong = {}
    for path in sorted(TESTS.rglob("test_*.py")):
        text = path.read_text(encoding="utf-8")
        if path != Path(__file__) and (count := len(re.findall(r"mark\.soak\(", text))):
            tests = [node for node in ast.walk(tree_of(path)) if isinstance(node, ast.FunctionDef)]
            on_tests = sum(mark.startswith("pytest.mark.soak(") for test in tests for mark in map(ast.unparse, test.decorator_list))
            if count != on_tests:
                wrong[path.name] = count - on_tests
    assert wrong == {"test_page_by_port.py": 1}, "there the mark is called with a function that the file makes"


@pytest.mark.parametrize("name", WAYS.values(), ids=WAYS)
def test_a_way_through_each_program_is_kept(name):
    assert functions()[name] is False


def test_each_room_keeps_tests():
    rooms = {name.partition("/")[0] for name in functions() if "/" in name}
    assert rooms == {name.partition("/")[0] for name, left_out in functions().items() if "/" in name and not left_out}


def test_each_invariant_keeps_a_test():
    without_classes = {f"{name.split('::')[0]}::{name.split('::')[-1]}": left_out for name, left_out in functions().items()}
    left = {
        f"{page} {number}": tests
        for page, numbers in test_invariants.marks().items()
        for number, tests in numbers.items()
        if all(without_classes[test] for test in tests)
    }
    assert left == {}


# ------------------------------------------------------------------------------------------------------------- what marks mean


class Case:
    """A case of a test, as pytest collects it."""

    def __init__(self, test, id, *marks):
        self.nodeid, self.callspec, self.own_markers = f"{test}[{id}]", SimpleNamespace(id=id), list(marks)

    def iter_markers(self, name):
        return (mark for mark in self.own_markers if mark.name == name)


def left_out(ids, mark, soaked=()):
    """(the ids that `make test` leaves out, what is wrong) if a test with these cases has MARK; SOAKED ones have one of their own."""
    cases = [Case("test_x", id, mark.mark, *([pytest.mark.soak.mark] if id in soaked else [])) for id in ids]
    wrong = soak_marks.leave_on_cases(cases)
    return [case.callspec.id for case in cases if any(case.iter_markers("soak"))], wrong


@pytest.mark.parametrize(
    ("mark", "soaked", "expected"),
    [
        (pytest.mark.soak, (), ["lisp-a", "hy-a", "lisp-b", "hy-b", "hyx-c", "c-lisp"]),
        (pytest.mark.soak(only=("hy",)), (), ["hy-a", "hy-b"]),
        (pytest.mark.soak(only=("hy", "c")), (), ["hy-a", "hy-b", "hyx-c", "c-lisp"]),
        (pytest.mark.soak(all_but=1), (), ["lisp-a", "hy-a", "lisp-b", "hyx-c", "c-lisp"]),
        (pytest.mark.soak(all_but=2), (), ["lisp-a", "lisp-b", "hy-b", "c-lisp"]),
        (pytest.mark.soak(only=("hy",), all_but=1), (), ["lisp-a", "hy-a", "lisp-b", "hy-b", "c-lisp"]),
        (pytest.mark.soak(all_but=1), ("lisp-a", "hy-a", "lisp-b", "hy-b"), ["lisp-a", "hy-a", "lisp-b", "hy-b", "hyx-c"]),
    ],
    ids=["plain", "a word", "words", "but one", "but two", "both", "beside marks of cases"],
)
def test_what_a_mark_leaves_out(mark, soaked, expected):
    assert left_out(["lisp-a", "hy-a", "lisp-b", "hy-b", "hyx-c", "c-lisp"], mark, soaked) == (expected, [])


@pytest.mark.parametrize(
    ("mark", "wrong"),
    [
        (pytest.mark.soak(only=("threads",)), ["test_x: no case has the word 'threads'"]),
        (pytest.mark.soak(all_but=2), ["test_x: all_but=2 leaves out none of its 2 cases"]),
    ],
    ids=["a word", "a number"],
)
def test_a_mark_that_means_nothing_is_told(mark, wrong):
    assert left_out(["a", "b"], mark) == ([], wrong)
