"""pytest reads test files and packages in Hy as Hy, also those whose assertions it would rewrite if they were Python."""

from __future__ import annotations

import pytest

ALONE = ("-m", "pytest", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin")
TESTS = """\
(require cramhy *)
(import cramhy-runtime [kernel])

(defn test-a-plan [virtual-time]
  (assert (= (top-level (sleep 2) (try-all 1 2)) 1))
  (assert (= (virtual-time.now) 2)))

(defn test-another []
  (assert (= (top-level (seq 1 2)) 2)))
"""
PACKAGE = "(require cramhy *)\n(defn drive [] ; metres, isn't it\n  (top-level (seq 1 2)))\n"


@pytest.fixture
def run_pytest(python):
    """``run_pytest("test_x.hy")``: (code of exit, what is printed) of pytest with these words and no plugin but ours."""

    def run_pytest(*words):
        done = python(*ALONE, *words, PYTEST_DISABLE_PLUGIN_AUTOLOAD="1")
        return done.returncode, done.stdout + done.stderr

    return run_pytest


@pytest.mark.parametrize(
    "words, passed",
    [
        ([], 2),
        (["."], 2),
        (["test_plan.hy"], 2),
        (["test_plan.hy::test_another"], 1),
        (["--import-mode=importlib", "test_plan.hy"], 2),
        (["--assert=plain", "test_plan.hy"], 2),
        (["-o", "python_files=*plan*", "."], 2),
    ],
)
def test_a_test_file_is_run_however_it_is_named(write, run_pytest, words, passed):
    write("test_plan.hy", TESTS)
    code, shown = run_pytest(*words)
    assert code == 0 and f"{passed} passed" in shown, shown


def test_a_package_whose_assertions_are_rewritten_may_have_modules_in_hy(write, run_pytest, tmp_path):
    (tmp_path / "robot").mkdir()
    write("robot/__init__.py", "import hy\n")
    write("robot/plans.hy", PACKAGE)
    write("robot/checks.py", "def check(value):\n    assert value == 3\n")
    write("conftest.py", "import pytest\npytest.register_assert_rewrite('robot')\n")
    write(
        "test_robot.py",
        "import pytest\nfrom robot import checks, plans\n\ndef test_both():\n    assert plans.drive() == 2\n"
        "    with pytest.raises(AssertionError, match='assert 2 == 3'):\n        checks.check(plans.drive())\n",
    )
    code, shown = run_pytest()
    assert code == 0 and "1 passed" in shown, shown


def test_a_form_that_cannot_be_compiled_is_told_without_the_frames_of_the_compiler(write, run_pytest):
    write("test_plan.hy", "(require cramhy *)\n(defn test-a [] (par (if)))\n")
    write("drives.hy", "(require cramhy *)\n(defn drive []\n  (par (if)))\n")
    write("test_it.py", "import hy\n\ndef test_it():\n    import drives\n")
    _, shown = run_pytest("test_plan.hy")
    assert "The if form is malformed: it ends too early; expected: form.\n  at test_plan.hy:2:" in shown, shown
    assert "It is written (if test then else)." in shown and "compiler.py" not in shown, shown
    _, shown = run_pytest("test_it.py")
    assert "The if form is malformed: it ends too early; expected: form." in shown and "It is written (if test then else)." in shown
    assert "import drives" in shown and "compiler.py" not in shown and "parser.py" not in shown, shown
