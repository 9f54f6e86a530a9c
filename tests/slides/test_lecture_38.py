"""Lecture 38 as it stands on the slides: process modules."""

from __future__ import annotations

import pytest

from .test_lecture_34 import LOAD, create_package

NODE = ['(start-ros-node "turtle1")', '(init-ros-turtle "turtle1")']
DRIVEN = """\
[(TURTLE-PROCESS-MODULES) INFO] TIME: TurtleSim navigation invoked with motion designator {quote}#<A MOTION
    (TYPE DRIVING)
    (SPEED {speed})
    (ANGLE {angle})>'."""
MOVED = """\
[(TURTLE-PROCESS-MODULES) INFO] TIME: TurtleSim navigation invoked with motion designator `#<A MOTION
    (TYPE MOVING)
    (GOAL ({x} {y} 0))>'."""
QUEUED = """\
WARNING:
   Process module #<TURTLESIM-NAVIGATION {ADDR}> already processing input. Waiting for it to become free."""


def modules_package(workspace, between_lectures, modules):
    create_package(workspace)
    workspace.copy("lecture-38/cram-my-beginner-tutorial.asd")
    workspace.copy("lecture-38/src/package.lisp", "src/package.lisp")
    workspace.copy("lecture-34/2-control/src/control-turtlesim.lisp", "src/control-turtlesim.lisp")
    workspace.write("src/simple-plans.lisp", between_lectures["simple-plans.lisp"])
    facts = (workspace.slides / "lecture-38/src/motion-designators-fact-group.lisp").read_text()
    workspace.write(
        "src/motion-designators.lisp",
        between_lectures["motions before the slide"] + facts + "\n\n" + between_lectures["motions after the slide"],
    )
    workspace.copy(f"lecture-38/src/{modules}", "src/process-modules.lisp")


def session_of(workspace, name):
    return (workspace.slides / "lecture-38" / "repl" / name).read_text().rstrip("\n").splitlines()


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("modules", ["process-modules-1.lisp", "process-modules-1-one-paren-too-many.lisp"])
def test_the_first_module_loads(workspace, between_lectures, modules):
    modules_package(workspace, between_lectures, modules)
    transcript = workspace.repl(*LOAD, "(get-process-module-names)")
    assert transcript.answers[2] == "(TURTLESIM-NAVIGATION)"
    assert (":COMPONENTS" in transcript.answers[0]) and "STYLE-WARNING" in transcript.answers[0]
    assert ("process-modules.lisp:12:" in transcript.answers[0]) == ("too-many" in modules)


@pytest.mark.soak(all_but=1)
def test_drive_answers_as_the_slide_shows(workspace, between_lectures, backend):
    modules_package(workspace, between_lectures, "process-modules-2.lisp")
    transcript = workspace.repl(*LOAD, *NODE, "(drive 5 2)", backend=backend)
    assert transcript.answers[4] == DRIVEN.format(quote="'", speed=5, angle=2) + "\n1"


@pytest.mark.soak
def test_the_slip_on_the_slide_names_the_package_that_was_meant(workspace, between_lectures):
    modules_package(workspace, between_lectures, "process-modules-3.lisp")
    transcript = workspace.repl(LOAD[0], "0")
    answer = transcript.answers[0]
    assert "Package DESIGN does not exist." in answer
    assert "process-modules.lisp:33:" in answer
    assert "There is no package DESIGN. Did you mean DESIG" in answer


def same_module(workspace, between_lectures, backend="threads", seed=None):
    modules_package(workspace, between_lectures, "process-modules-3-parts.lisp")
    transcript = workspace.repl(*LOAD, *NODE, *session_of(workspace, "par-same-module.lisp"), "(sleep 1.5)", backend=backend, seed=seed)
    return transcript.answers[4]


@pytest.mark.soak
def test_two_motions_for_one_module_are_done_one_after_the_other(workspace, between_lectures, backend):
    answer = same_module(workspace, between_lectures, backend)
    assert "\nT" in answer and "STYLE-WARNING: unmatched close parenthesis" in answer[answer.rindex("\nT") :] or answer.endswith("T")
    expected = [MOVED.format(x=9, y=1), QUEUED, DRIVEN.format(quote="`", speed=3, angle=8)]
    places = [answer.index(part) for part in expected]
    assert places == sorted(places)


@pytest.mark.soak
def test_two_modules_work_at_the_same_time(workspace, between_lectures, backend):
    modules_package(workspace, between_lectures, "process-modules-3-parts.lisp")
    transcript = workspace.repl(*LOAD, *NODE, *session_of(workspace, "par-two-modules.lisp"), "(value *turtle-pose*)", backend=backend)
    answer = transcript.answers[4]
    assert MOVED.format(x=9, y=9) in answer
    assert answer.count("TurtleSim pen control invoked with motion designator `#<A MOTION\n    (TYPE SETTING-PEN)") == 10
    assert "already processing" not in answer
    pose = transcript.answers[5].split()
    assert abs(float(pose[2][:-2]) - 9) < 0.2 and abs(float(pose[4][:-2]) - 9) < 0.2


@pytest.mark.soak
def test_the_opening_example_runs_once_a_module_is_there(workspace, between_lectures, backend):
    modules_package(workspace, between_lectures, "process-modules-2.lisp")
    example = " ".join(session_of(workspace, "with-designators.lisp"))
    transcript = workspace.repl(
        *LOAD,
        "(def-process-module navigation (designator) (description designator))",
        f"(top-level (with-process-modules-running ((:navigation navigation)) {example}))",
        backend=backend,
    )
    assert transcript.answers[3] == "(:CLOSE-TO :FRIDGE)"
