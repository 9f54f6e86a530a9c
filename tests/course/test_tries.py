"""Each task of the course: what right and wrong students type at its page, and what the check says.

A solution passes; nothing, and the code to begin with, do not. Of the tries in ``tries/`` a sample is typed, and by `make soak` all of
them, in processes that begin with the page as the student has come to the task.

All pages share a folder, as they do for a student, so each is walked from the state in which others leave it: in the order of the pages
here, and by `make soak` each one after each other one. What is compiled there is compiled once.
"""

from __future__ import annotations

import random

import pytest

from cramhy_runtime.course import contents, reading
from cramhy_runtime.grading import in_session
from systems import SOAK, needs_processes

from .tries import Tries, tries_at
from .walking import Walk
from .walks import WITHOUT_ROBOT, orders

LANGUAGES = ("lisp", "hy")
TASKS = [task.name for page in reading.pages() for task in page.tasks]
SAMPLE = {"right": 1, "wrong": 2}
"""So many tries of a task in a language are typed, if not all of them are."""


@pytest.mark.soak(all_but=19)
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("task", TASKS)
def test_each_task_has_right_and_wrong_tries_of_different_kinds(task, language):
    tries = tries_at(task, language)
    kinds = {sort: [tried.kind for tried in tries if tried.sort == sort] for sort in SAMPLE}
    assert len(kinds["right"]) >= 3 and len(kinds["wrong"]) >= 5
    assert all(len(set(each)) == len(each) for each in kinds.values())
    assert len({tried.text for tried in tries}) == len(tries)
    assert all(tried.missing for tried in tries if tried.sort == "wrong")


def sampled(page, language):
    """The tries at the tasks of a page that are typed: each time the same ones."""
    found = set()
    for task in reading.page(page).tasks:
        for sort, count in SAMPLE.items():
            tries = [tried for tried in tries_at(task.name, language) if tried.sort == sort]
            found.update(tries if SOAK else random.Random(f"{task.name} {language} {sort}").sample(tries, count))
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("course")


@pytest.mark.soak
@needs_processes
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", contents.NAMES)
def test_a_student_who_types_everything_comes_through_the_page_and_wrong_tries_are_refused(name, language, folder, monkeypatch):
    if name in contents.WITH_ROBOT:
        pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    if not SOAK:
        monkeypatch.setattr(in_session, "fresh_seed", lambda: 4711)
    wanted = sampled(name, language)
    walk = Tries(name, language, folder, wanted.__contains__)
    assert walk.status == 0
    assert {key: passed for key, passed in walk.verdicts.items() if passed != (key[1] == "solution")} == {}, walk.text
    assert {key[0] for key in walk.verdicts} == {task.name for task in reading.page(name).tasks}
    assert "This is the end of the " in walk.text and walk.wrong == []
    assert {verdict.tried for verdict in walk.results} == wanted
    assert [f"{verdict.tried.name}: {verdict.said or 'passed'}" for verdict in walk.results if not verdict.just] == []
    for verdict in walk.results:
        told = [line for line in verdict.said.splitlines() if line and line != "Not yet." and not line.startswith("; :hint")]
        assert verdict.passed or told, f"{verdict.tried.name} was refused without a reason"


@pytest.mark.skipif(not SOAK, reason="the test above has the order of the pages; by make soak")
@pytest.mark.parametrize("language", LANGUAGES)
def test_each_page_goes_well_after_each_other_page(language, tmp_path):
    for number, names in enumerate(orders(WITHOUT_ROBOT, language, "terminal")):
        for name in names:
            walk = Walk(name, language, tmp_path / str(number))
            assert (walk.status, walk.wrong) == (0, []), f"{name}, after {names[: names.index(name)]}"
            assert {key: passed for key, passed in walk.verdicts.items() if passed != (key[1] == "solution")} == {}
