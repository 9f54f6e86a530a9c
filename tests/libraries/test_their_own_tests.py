"""The libraries of all Lisps that cramhy brings for those who have not the real ones: they pass the tests of the real ones.

The tests are those of Debian's packages (cl-alexandria, cl-split-sequence, cl-utilities, cl-bordeaux-threads), read where they are installed.
"""

from __future__ import annotations

from pathlib import Path

import pytest

SOURCES = Path("/usr/share/common-lisp/source")
RT = "(progn (asdf:load-system :sb-rt) (unless (find-package :rtest) (rename-package :sb-rt :sb-rt '(:rtest :rt))))"


@pytest.fixture
def load(session):
    """A function that loads a system of cramhy's and a file of the real one's tests; it returns the values of a form."""

    def loaded(system, file, form, first="(asdf:load-system :fiveam)"):
        path = SOURCES / file
        if not path.is_file():
            pytest.skip(f"Debian's package with {path} is not installed")
        session.evaluate_text(first)
        session.evaluate_text(f"(asdf:load-system :{system})")
        session.evaluate_text(f'(load "{path}")')
        return session.evaluate_text(form)

    return loaded


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("system", "file", "suite"),
    [
        ("cl-utilities", "cl-utilities/test.lisp", "'cl-utilities-tests::cl-utilities-suite"),
        ("bordeaux-threads", "bordeaux-threads/test/bordeaux-threads-test.lisp", ":bordeaux-threads"),
    ],
)
def test_a_library_passes_the_tests_of_the_real_one(load, system, file, suite):
    assert load(system, file, f"(5am:run! {suite})") == [True]


@pytest.mark.soak
def test_split_sequence_passes_the_tests_of_the_real_one(load):
    """All but a million random cases, of which it takes a thousand."""
    run = """(progn (split-sequence/tests::fuzz :repetitions 1000 :verbose nil)
                    (5am:rem-test 'split-sequence/tests::split-sequence.fuzz)
                    (5am:run! :split-sequence))"""
    assert load("split-sequence", "cl-split-sequence/tests.lisp", run) == [True]


@pytest.mark.soak
@pytest.mark.parametrize("part", ["alexandria-1", "alexandria-2"])
def test_alexandria_passes_the_tests_of_the_real_one(load, part):
    assert load("alexandria", f"alexandria/{part}/tests.lisp", "(progn (sb-rt:do-tests) (sb-rt:pending-tests))", RT) == [None]


def test_debians_own_alexandria_is_loaded_and_passes_its_tests(session, monkeypatch):
    """Not ours: the sources of the package, which are found where ROS packages are."""
    folder = SOURCES / "alexandria"
    if not (folder / "alexandria-tests.asd").is_file():
        pytest.skip(f"Debian's package with {folder} is not installed")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(folder))
    session.evaluate_text("(asdf:load-system :alexandria-tests)")
    (found,) = session.evaluate_text("(namestring (asdf:system-source-file (asdf:find-system :alexandria)))")
    assert found == f"{folder}/alexandria.asd"
    assert session.evaluate_text("(length (sb-rt:pending-tests))") == [249]
    assert session.evaluate_text("(progn (sb-rt:do-tests) (sb-rt:pending-tests))") == [None]
