"""A report names the file of the clause that failed, also where the clause is a library's and the user's text only loaded it."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for
from cramhy_runtime.prolog.engine import database
from cramhy_runtime.repl.session import Session

LIBRARIES = ("cram-designator-specification", "cram-mobile-pick-place-plans", "cram-location-costmap", "cram-plan-occasions-events")


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    for library in LIBRARIES:
        made.evaluate_text(f"(asdf:load-system :{library})")
    yield made
    kernel.stop()


def test_the_report_of_a_failed_grounding_names_the_files_of_libraries(session):
    with pytest.raises(Condition) as problem:
        session.evaluate_text("(desig:reference (desig:an action (type nonsense)))")
    report = hint_for(problem.value)
    assert re.search(r"clause 3 of \S*gripper-actions at \S*cram-mobile-pick-place-plans/atomic-actions\.lisp:\d+:3", report)
    assert re.search(r"\S*all-designator-specs at \S*cram-designator-specification/property\.lisp:\d+:3", report)
    assert "at <repl" not in report


@pytest.mark.parametrize("library", LIBRARIES)
def test_each_clause_of_a_library_has_a_place_in_its_files(session, library):
    places = [
        clause.position
        for entry in database.functors.values()
        for clause in entry.clauses
        if clause.position is not None and f"/{library}/" in clause.position[0].replace("\\", "/")
    ]
    assert places
    for file, line, _ in places:
        with open(file, encoding="utf-8") as text:
            assert text.readlines()[line - 1].lstrip(" `,@").startswith(("(<-", "(def-fact-group", "(define-"))


def test_a_clause_of_the_user_keeps_its_own_place(session):
    text = "(prolog:def-fact-group of-mine (mine)\n  (prolog:<- (mine ?x)\n    (prolog:== ?x 1)))"
    symbol = session.evaluate_text(f"{text} 'mine", "mine.lisp")[-1]
    assert [clause.position[:2] for clause in database.functors[symbol].clauses] == [("mine.lisp", 2)]
