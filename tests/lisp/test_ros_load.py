"""``(ros-load:load-system "package" :system)``: a package that does not exist is told of, with what is near."""

from __future__ import annotations

import pytest

from cramhy_runtime.ros import definition_files
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.repl.session import Session, condition_of


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    yield made
    kernel.stop()


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    """A package in a folder of another name, below a stack, and a system in a folder that is no package."""
    package = tmp_path / "src" / "stack" / "a_folder"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package>\n<name> wheel_control </name></package>")
    (package / "wheel-control.asd").write_text("(defsystem wheel-control)")
    plain = tmp_path / "src" / "plain_folder"
    plain.mkdir()
    (plain / "plain.asd").write_text("(defsystem plain)")
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def answer(session, workspace):
    """The value of a form, or what is told of its error."""

    def answer(form):
        try:
            return session.evaluate_text(form, "<repl test>")[0]
        except (Condition, Exception) as problem:
            return explanation(condition_of(problem))

    return answer


def told(package, form, hint=None):
    lines = [
        f"rospack find {package} returned 1 with stderr '[rospack] Error: package '{package}' not found'",
        "at <repl test>:1:1",
        f"  {form}",
        "  ^",
    ]
    return "".join(f"  {line}\n" for line in [*lines, *([hint] if hint else [])])[:-1]


@pytest.mark.parametrize(
    "words",
    ['"wheel_control" :wheel-control', '"a_folder" :wheel-control', '"stack" :wheel-control', '"plain_folder" :plain', '"src" "plain"',
     '"cram_language" :cram-language', '"cram_designators" :cram-language', '"turtlesim" "turtlesim-msg"', '"geometry_msgs" :geometry_msgs-msg',
     '"cram_my_beginner_tutorial" :cram-my-beginner-tutorial', ':wheel-control', '"wheel-control"', ":cram_language :cram-language"],
)  # fmt: skip
def test_a_package_that_is_there_is_loaded(answer, words):
    assert answer(f"(ros-load:load-system {words})") is True


@pytest.mark.parametrize(
    ("package", "system", "hint"),
    [
        ("wheel_contol", ":wheel-control", "The system wheel-control is in the package wheel_control."),
        ("wheel-control-tests", ":wheel-control", "The system wheel-control is in the package wheel_control."),
        (
            "cram_my_beginner_tutoriall",
            ":cram-my-beginner-tutorial",
            "The system cram-my-beginner-tutorial is in the package cram_my_beginner_tutorial.",
        ),
        ("cram_langage", ":cram-language", "Did you mean cram_language?"),
        ("turtelsim", '"turtlesim-msg"', "Did you mean turtlesim?"),
        ("plain_foldr", ":plain", None),
        ("zzzz", ":cram-language", None),
        ("zzzz", ":no-such-system", None),
    ],
)
def test_a_package_that_is_not_there_is_an_error_that_says_what_is_near(answer, package, system, hint):
    form = f'(ros-load:load-system "{package}" {system})'
    assert answer(form) == told(package, form, hint or f"No package {package} is below {definition_files.where_searched()}.")


def test_of_a_system_that_is_not_there_its_own_error_tells(answer):
    said = answer('(ros-load:load-system "wheel_control" :wheel-contrl)')
    assert 'Component "wheel-contrl" not found' in said and "Did you mean wheel-control" in said
    assert 'Component "wheel_contrl" not found' in answer('(ros-load:load-system "wheel_contrl")')
