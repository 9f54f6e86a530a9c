"""Location designators of the course: nine thirds of the world, points in them, and who may go where."""

from __future__ import annotations

import pytest

from cramhy_runtime.designators.classes import DesignatorError
from cramhy_runtime.lisp_core.conditions import Condition

from .course import SEEDS, STEP, course, seeded

COLUMNS, ROWS = (":left", ":center", ":right"), (":bottom", ":center", ":top")
THIRDS = [(column, row) for column in COLUMNS for row in ROWS]
THIRD = 11 / 3
NEAR = 0.1 + STEP
pytestmark = pytest.mark.usefixtures("language")


@pytest.fixture
def turtle(backend):
    with course(backend) as made:
        yield made


def in_third(column, row, x, y, margin=0.0):
    """Whether (x, y) is in a third of the world, and no nearer to the walls than half a metre."""
    return all(
        max(0.5, index * THIRD) - margin <= value <= min(10.5, (index + 1) * THIRD) + margin
        for index, value in ((COLUMNS.index(column), x), (ROWS.index(row), y))
    )


@pytest.mark.soak
@pytest.mark.parametrize("seed", SEEDS)
def test_the_turtle_ends_in_the_third_that_it_was_sent_to(seed, capsys):
    with seeded(seed) as turtle:
        for column, row in THIRDS:
            capsys.readouterr()
            turtle(f"(goto-location {column} {row})")
            assert in_third(column, row, *turtle.place, margin=NEAR), (column, row)
            assert "TURTLE-PROCESS-MODULES) INFO" in (told := capsys.readouterr().out) and "Goint to point #<3D-VECTOR (" in told
            assert "WARNING" not in told or "node-status equalled RUNNING" in told
        assert turtle.stands_still() and turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_place_has_at_most_five_solutions_all_of_them_in_its_third(seed):
    with seeded(seed) as turtle:
        for column, row in THIRDS:
            try:
                solutions = turtle(
                    f"""(force-ll (desig:designator-solutions
                    (desig:a location (horizontal-position {column}) (vertical-position {row}))))""".replace("force-ll", "cut:force-ll")
                )
            except DesignatorError:
                continue
            points = [] if solutions is None else list(solutions)
            assert len(points) <= 5
            assert all(in_third(column, row, point.x, point.y) and point.z == 0 for point in points)


def test_the_generator_gives_five_points_walls_or_not(turtle):
    points = turtle("(navigation-goal-generator (desig:a location (horizontal-position :left) (vertical-position :bottom)))")
    assert len(points) == 5 and all(0 <= point.x < THIRD and 0 <= point.y < THIRD for point in points)


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "x, y, verdict", [(0.5, 10.5, "ACCEPT"), (5, 5, "ACCEPT"), (0.4999, 5, None), (5, 10.5001, None), (10.6, 5, None), (5, -1, None)]
)
def test_points_near_a_wall_are_not_accepted(turtle, x, y, verdict):
    answer = turtle(f"""(navigation-goal-validator (desig:a location (horizontal-position :left) (vertical-position :top))
                                                   (make-3d-vector {x} {y} 0))""")
    assert (answer and getattr(answer, "name", answer).upper()) == verdict  # a string in Hy


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "location, solution",
    [
        ("(horizontal-position :left)", "(make-3d-vector 5 5 0)"),
        ("(vertical-position :top)", "(make-3d-vector 5 5 0)"),
        ("(horizontal-position :left) (vertical-position :top)", "(list 5 5 0)"),
        ("(on table)", "(make-3d-vector 5 5 0)"),
    ],
)
def test_other_places_and_other_things_are_not_accepted(turtle, location, solution):
    assert turtle(f"(navigation-goal-validator (desig:a location {location}) {solution})") is None


def test_a_place_of_another_kind_has_no_points(turtle):
    assert turtle("(navigation-goal-generator (desig:a location (on table)))") is None


@pytest.mark.soak(all_but=2)
def test_a_misspelled_third_is_told(turtle, language):
    told = text_of_error(turtle, "(goto-location :leftt :top)")
    texts = {
        "lisp": ":LEFTT fell through ECASE expression. Wanted one of (:LEFT :CENTER :RIGHT).",
        "hy": "'leftt'",  # of a KeyError
    }
    assert told.split() == texts[language].split()
    assert turtle.left() == []


@pytest.mark.soak(all_but=1)
def test_points_are_generated_four_times_before_a_place_is_given_up(turtle, language, capsys):
    turtle("(setf *min-bound* 20)")
    try:
        told = text_of_error(turtle, "(goto-location :left :top)")
    finally:
        turtle("(setf *min-bound* 0.5)")
    left, top = ("LEFT", "TOP") if language == "lisp" else ("left", "top")
    assert (
        told
        == f"""\
Unable to resolve designator `#<A LOCATION
    (HORIZONTAL-POSITION {left})
    (VERTICAL-POSITION {top})>'"""
    )
    assert capsys.readouterr().out.count("TurtleSim navigation invoked") == 4
    assert turtle.commands == [] and turtle.left() == []


def text_of_error(turtle, form):
    """Without the error itself, which would hold on to the plan that it came out of."""
    try:
        turtle(form)
    except (Condition, ValueError, KeyError) as problem:
        return str(problem)
    return None
