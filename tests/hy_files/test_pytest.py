"""pytest reads test files and packages in Hy as Hy, also those whose assertions it would rewrite if they were Python."""

from __future__ import annotations

import re

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


@pytest.mark.soak
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


@pytest.mark.soak
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


@pytest.mark.soak
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


# ---------------------------------------------------------------------------------------------------- every test is collected

ODD = """\
(require cramhy *)
(import pytest unittest)

(defmacro deftest [name #* body]
  `(defn ~name [] ~@body))

(defn test-foo->bar [] (assert (= 1 2)))
(defn test-maybe? [] (assert (= 1 2)))
(defn test-plan! [] (assert (= 1 2)))
(defn test-a/b [] (assert (= 1 2)))
(deftest test-by-a-macro (assert (= 1 2)))
  (defn test-indented [] (assert True))
(defclass TestDriving []
  (defn test-drive->stop [self] (assert True))
  (defn test-turn [self] (assert True))
  (defn helper [self] (assert False)))
(defclass Cases [unittest.TestCase]
  (defn setUp [self] (setv self.two 2))
  (defn test-case? [self] (self.assertEqual self.two 2))
  (defn test-plain [self] (self.assertEqual self.two 2)))
(defn [(pytest.mark.parametrize "x" [1 2])] test-each->x [x] (assert (< x 3)))
(defn [pytest.fixture] half-full? [] 5)
(defn test-with-fixture? [half-full?] (assert (= half-full? 5)))
(defn [pytest.mark.xfail] test-marked! [] (assert False))
(defn :async test-later? [] (assert True))
(setv test-value 3)
(defn testing-nothing [] (assert False))
"""
ODD_NAMES = {
    *("test-foo->bar", "test-maybe?", "test-plan!", "test-a/b", "test-by-a-macro", "test-indented", "TestDriving::test-drive->stop"),
    *("TestDriving::test-turn", "Cases::test-case?", "Cases::test-plain", "test-each->x[1]", "test-each->x[2]", "test-with-fixture?"),
    *("test-marked!", "test-later?", "testing-nothing"),
}


def collected(shown):
    """The names of the tests that pytest -v shows, without those of files."""
    return sorted(line.split(" ")[0].partition("::")[2] for line in shown.splitlines() if re.match(r"\S+\.hy::\S+ [A-Z]+ ", line))


@pytest.mark.soak
def test_each_test_is_collected_once_under_its_name_in_lisp_and_run(write, run_pytest):
    write("test_odd.hy", ODD)
    code, shown = run_pytest("-v")
    assert collected(shown) == sorted(ODD_NAMES) and code == 1
    assert "7 failed, 8 passed, 1 xfailed" in shown, shown
    assert "async def functions are not natively supported" in shown


@pytest.mark.soak
@pytest.mark.parametrize(
    "words, names",
    [
        (
            [
                *(
                    "test-foo->bar",
                    "test_indented",
                    "hyx_test_planXexclamation_markX",
                    "TestDriving::test-drive->stop",
                    "Cases::test-case?",
                ),
                *("test-each->x[2]", "test-a/b"),
            ],
            [
                "Cases::test-case?",
                "TestDriving::test-drive->stop",
                "test-a/b",
                "test-each->x[2]",
                "test-foo->bar",
                "test-indented",
                "test-plan!",
            ],
        ),
        (
            ["test-each->x", "TestDriving"],
            ["TestDriving::test-drive->stop", "TestDriving::test-turn", "test-each->x[1]", "test-each->x[2]"],
        ),
        (["-k", "driv and turn or test-by-a-macro"], ["TestDriving::test-turn", "test-by-a-macro"]),
        (
            ["-o", "python_functions=test_by* *-with-*", "-o", "python_classes=Nothing"],
            ["Cases::test-case?", "Cases::test-plain", "test-by-a-macro", "test-with-fixture?"],
        ),
    ],
    ids=["names", "groups", "-k", "patterns"],
)
def test_tests_are_chosen_by_name_or_pattern(write, run_pytest, words, names):
    write("test_odd.hy", ODD)
    _, shown = run_pytest("-v", *(words if words[0].startswith("-") else [f"test_odd.hy::{word}" for word in words]))
    assert collected(shown) == names, shown


@pytest.mark.soak
def test_a_file_that_is_named_like_one_of_tests_and_has_none_is_an_error(write, run_pytest):
    texts = ["", "(defn helper [] 1)\n", "(defclass TestNone [])\n", "(setv test-data 3)\n", ";; (defn test-x [] 1)\n"]
    names = ["test_empty.hy", "empty_test.hy", "test-empty.hy", "test_data.hy", "test_comment.hy"]
    for name, text in zip(names, texts, strict=True):
        write(name, text)
    write("test_plan.hy", "(defn test-good [] (assert True))\n")
    write("helper.hy", "(defn nothing [] 1)\n")
    code, shown = run_pytest()
    assert code == 2 and "passed" not in shown and "5 errors" in shown, shown
    for name in names:
        assert (
            f"{name} is named like a file of tests, but there are none in it. A test is a function with a name that begins with test, "
            "a method with such a name in a class Test, or one of a unittest.TestCase. If this is a helper, give it another name, or write "
            "(setv __test__ False) in it."
        ) in shown, shown


@pytest.mark.soak
def test_a_helper_may_say_that_it_has_no_tests(write, run_pytest):
    write("test_helper.hy", "(setv __test__ False)\n")
    write("test_plan.hy", "(import test-helper)\n(defn test-good [] (assert True))\n")
    code, shown = run_pytest()
    assert code == 0 and "1 passed" in shown, shown


# ------------------------------------------------------------------------------------------------------------------ assertions

FAILING = {
    "(assert (= (+ 1 1) 3))": "assert (1 + 1) == 3",
    "(setv x 2) (assert (= x 3))": "assert 2 == 3",
    "(assert (in 4 [1 2 3]))": "assert 4 in [1, 2, 3]",
    "(assert (not-in 1 [1 2]))": "assert 1 not in [1, 2]",
    "(setv x 2 y 3) (assert (< 1 x y 3))": "assert 3 < 3",
    "(setv x None) (assert (is-not x None))": "assert None is not None",
    '(assert (= "abc" "abd"))': "assert 'abc' == 'abd'",
    "(assert (= [1 2] [1 3]))": "At index 1 diff: 2 != 3",
    '(assert (= {"a" 1} {"a" 2}))': "{'a': 1} != {'a': 2}",
    "(assert (double 2))": "where 0 = double(2)",
    "(assert (not (double 1)))": "assert not 3",
    '(assert (= 1 2) f"speed {(+ 1 1)}")': "AssertionError: speed 2",
    "(assert (= (top-level (sleep 2) 3) 4))": "assert 3 == 4",
    '(assert (= (do (setv z 1) z) 2) "with text")': "AssertionError: with text",
    "(assert (and True (= 1 2)))": "(True and 1 == 2)",
    "(assert (= (let [y 4] (do (setv z y) z)) 5))": "assert 4 == 5",
    "(assert (= (lfor i (range 2) i) [0 2]))": "At index 1 diff: 1 != 2",
    "(when (not (double 2)) (assert False))": "assert False",
}


@pytest.mark.soak
def test_a_failed_assertion_shows_its_values(write, run_pytest):
    tests = "".join(f"(defn test-{number} []\n  {form})\n" for number, form in enumerate(FAILING))
    write("test_values.hy", f"(require cramhy *)\n(defn double [x] (if (= x 2) 0 3))\n{tests}")
    code, printed = run_pytest("-vv")
    parts = re.split(r"^_+ test-\d+ _+$", printed, flags=re.M)[1:]
    assert code == 1 and len(parts) == len(FAILING), printed
    for number, (part, (form, shown)) in enumerate(zip(parts, FAILING.items(), strict=True)):
        assert shown in part and f"test_values.hy:{4 + 2 * number}: AssertionError" in part, (form, part)


@pytest.mark.soak
def test_helpers_that_are_registered_show_values_and_plain_code_is_kept_apart(write, run_pytest, python):
    write("helper.hy", "(defn check [x]\n  (assert (= x 3)))\n")
    write("conftest.py", "import pytest\npytest.register_assert_rewrite('helper')\n")
    write("test_helped.hy", "(import helper)\n(defn test-helped [] (helper.check 4))\n")
    plain = "import hy\nimport helper\ntry:\n    helper.check(4)\nexcept AssertionError as problem:\n    print(repr(problem))\n"
    write("plain.py", plain)
    assert python("plain.py").stdout == "AssertionError()\n"
    code, shown = run_pytest()
    assert code == 1 and "assert 4 == 3" in shown, shown
    assert python("plain.py").stdout == "AssertionError()\n"
    code, shown = run_pytest("--assert=plain")
    assert code == 1 and "assert 4 == 3" not in shown, shown
