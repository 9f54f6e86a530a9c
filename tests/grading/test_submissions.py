"""Submissions get the points that they must get, twice alike, and harm nothing. A part of them here, all of them in ``make soak``."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from systems import linux

from cramhy_runtime.grading import Grader
from cramhy_runtime.grading.exercise import Exercise, own_exercises
from cramhy_runtime.grading.processes import ForkServer

from .submissions import SHORT, cases, hand_in, says

pytestmark = linux


@pytest.fixture(scope="module")
def grader():
    with Grader() as made:
        yield made


@pytest.fixture(scope="module")
def exercises(tmp_path_factory):
    """A copy of the exercises, which a submission may try to delete."""
    folder = tmp_path_factory.mktemp("exercises")
    for name, place in own_exercises().items():
        shutil.copytree(place, folder / name)
    return folder


def graded(grader, exercises, case, folder, seconds=None):
    exercise = Exercise.read(exercises / case.exercise)
    if seconds is not None:
        exercise = exercise._replace(limits={**exercise.limits, "time": seconds})
    return exercise, grader.grade(exercise, hand_in(case, folder))


def check(case, exercise, report):
    text = report.text()
    assert report.points == (exercise.points if case.points is None else case.points), text
    assert says(report, case.words), text
    assert case.points == 0 or report.held, "nothing has run"


@pytest.mark.soak
@pytest.mark.parametrize("case", [case for case in cases() if case.name in SHORT], ids=lambda case: case.name)
def test_a_submission_gets_its_points(case, grader, exercises, tmp_path):
    if case.name == "deletes the exercise":
        case = next(each for each in cases(str(exercises), str(tmp_path)) if each.name == case.name)
    before = sorted((path, path.stat().st_mode, path.stat().st_size) for path in exercises.rglob("*"))
    exercise, report = graded(grader, exercises, case, tmp_path, 1 if "loop" in case.name else None)
    check(case, exercise, report)
    assert sorted((path, path.stat().st_mode, path.stat().st_size) for path in exercises.rglob("*")) == before
    assert [path for path in Path(tmp_path).rglob("*") if path.is_file() and path.parent.name != case.name.replace(" ", "-")] == []


def test_the_lists_of_cases_are_whole():
    names = [case.name for case in cases()]
    assert len(names) == len(set(names)) >= 60
    assert SHORT <= set(names)
    assert len(own_exercises()) >= 15


@pytest.mark.soak
@pytest.mark.timeout(3000)  # on a busy machine the wall clock says little; the processor time is checked below
def test_sixty_submissions_are_graded_twice_alike_in_two_minutes(exercises, tmp_path):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    read = [(case, Exercise.read(exercises / case.exercise)) for case in cases(str(exercises), str(tmp_path))]
    all_reports = []
    for number in range(2):
        with Grader() as grader:
            reports = grader.grade_all([(exercise, hand_in(case, tmp_path / str(number))) for case, exercise in read])
        for (case, exercise), report in zip(read, reports, strict=True):
            check(case, exercise, report)
        all_reports.append([[(result.title, result.points) for result in report.checks] for report in reports])
    assert all_reports[0] == all_reports[1]
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 240  # of two processors in two minutes


@pytest.mark.soak
@pytest.mark.parametrize("at_once", [1, 3])
def test_many_are_graded_at_once_each_as_if_it_were_alone_and_in_their_order(exercises, tmp_path, at_once):
    names = ["no text", "solution of dry-pen", "exit of the process", "start of dry-pen", "solution of first-lisp", "empty"]
    chosen = [next(case for case in cases() if case.name == name) for name in names]
    with Grader(at_once=at_once) as grader:
        reports = grader.grade_all([(Exercise.read(exercises / case.exercise), hand_in(case, tmp_path)) for case in chosen])
        for case, report in zip(chosen, reports, strict=True):
            check(case, Exercise.read(exercises / case.exercise), report)
        assert len(grader.fork_servers) <= at_once * 2  # the exercises build on two lists of systems
        assert grader.grade_all([]) == []


@pytest.mark.soak
def test_a_fork_server_that_is_lost_costs_one_submission_only(exercises, tmp_path, monkeypatch):
    chosen = [next(case for case in cases() if case.name == name) for name in ("empty", "solution of dry-pen")]
    handed_in = [(Exercise.read(exercises / case.exercise), hand_in(case, tmp_path)) for case in chosen]
    with Grader(at_once=1) as grader:
        ask = ForkServer.ask
        jobs = []

        def ask_and_kill(self, job):
            ask(self, job)
            jobs.append(job)
            if len(jobs) == 1:
                self.process.kill()

        monkeypatch.setattr(ForkServer, "ask", ask_and_kill)
        lost, other = grader.grade_all(handed_in)
    assert lost.points == 0 and "The program ended the process that grades it." in lost.text()
    assert other.points == other.most


def run(*words, cwd=None):
    return subprocess.run([sys.executable, "-m", "cramhy_runtime.cli", *map(str, words)], capture_output=True, text=True, cwd=cwd)


def test_the_command_writes_its_reports_and_says_by_its_status_what_came_of_it(tmp_path):
    good, bad = (next(case for case in cases() if case.name == name) for name in ("solution of dry-pen", "no text"))
    done = run("grade", "dry-pen", hand_in(good, tmp_path), "--json", tmp_path / "r.json", "--junit", tmp_path / "r.xml", "--seeds", 1)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("A pen that dries: 6 of 6 points\n\npassed  1/1  ")
    assert '"points": 6' in (tmp_path / "r.json").read_text() and 'failures="0"' in (tmp_path / "r.xml").read_text()
    done = run("grade", "square", hand_in(bad, tmp_path), "--format", "vpl")
    assert done.returncode == 1 and done.stdout.endswith("Grade :=>> 0\n")
    done = run("grade", "nothing", tmp_path)
    assert done.returncode == 2 and done.stderr.startswith("cramhy: There is no folder nothing, and no exercise of that name. cramhy has ")
    done = run("grade", "square", tmp_path / "nothing.lisp")
    assert done.returncode == 2 and "There is no file or folder" in done.stderr


def test_a_link_to_somewhere_else_is_not_followed(tmp_path, exercises, grader):
    (tmp_path / "secret").write_text("(secret)")
    place = tmp_path / "submission"
    place.mkdir()
    os.symlink(tmp_path / "secret", place / "square.lisp")
    report = grader.grade(Exercise.read(exercises / "square"), place)
    assert report.points == 0 and "The file square.lisp is not there." in report.text() and "secret" not in report.text()


@pytest.mark.soak
def test_a_place_that_is_odd_costs_its_own_points_and_the_class_goes_on(tmp_path, exercises):
    places = [tmp_path / name for name in ("nothing", "pipe", "folder", "circle", "empty")]
    for place in places[2:]:
        place.mkdir()
    os.mkfifo(places[1])
    (places[2] / "dry-pen.lisp").mkdir()
    (places[3] / "dry-pen.lisp").symlink_to("dry-pen.lisp")
    good = next(case for case in cases() if case.name == "solution of dry-pen")
    exercise = Exercise.read(exercises / "dry-pen")
    exercise = exercise._replace(checks=exercise.checks[:1])
    with Grader(at_once=1) as grader:
        *odd, last = grader.grade_all([(exercise, place) for place in (*places, hand_in(good, tmp_path))])
    assert [report.points for report in odd] == [0] * 5 and last.points == 1
    assert all("The file dry-pen.lisp is not" in report.text() for report in odd)
