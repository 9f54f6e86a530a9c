"""LOOP: what ``sbcl/loop.txt`` does not show: complaints, evaluation of forms, efficiency, the shape of the expansion."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import python_list
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.loop import loop
from cramhy_runtime.lisp_core.packages import find_package, sym
from cramhy_runtime.languages.commonlisp.reader.reader import Reader


@pytest.fixture(autouse=True)
def in_user_package():
    kernel.start(clock="virtual")
    boot()
    with binding(sym("*PACKAGE*"), find_package("COMMON-LISP-USER")):
        yield


def value(text):
    return evaluator.evaluate(Reader(text).read())


def complaint(text):
    with pytest.raises(conditions.ProgramError) as caught:
        loop.expand(Reader(text).read().cdr)
    return caught.value


@pytest.mark.parametrize(
    "text, report, hint",
    [
        (
            "(loop for x in l colect x)",
            "unknown LOOP keyword: COLECT\ncurrent LOOP context: COLECT X.",
            "Did you mean COLLECT or COLLECTING?",
        ),
        ("(loop for x from 1 to 3 by)", "LOOP code ran out where a form was expected.\ncurrent LOOP context: FOR X FROM 1 TO 3 BY.", None),
        ("(loop for x)", "LOOP source code ran out when another token was expected.\ncurrent LOOP context: FOR X.", None),
        (
            "(loop for x over l do (print x))",
            "OVER is an unknown keyword in FOR or AS clause in LOOP.\ncurrent LOOP context: FOR X OVER.",
            "After the variable comes IN, ON, ACROSS, =, FROM or BEING.",
        ),
        (
            "(loop for x in a and for y in b)",
            "Y is an unknown keyword in FOR or AS clause in LOOP.\ncurrent LOOP context: FOR X IN A AND FOR Y.",
            "After AND the next variable follows directly, without FOR.",
        ),
        ("(loop for x in a for x in b)", "Duplicated variable X\ncurrent LOOP context: FOR X IN B.", None),
        (
            "(loop for x in a finally return x)",
            "A compound form was expected, but RETURN found.\ncurrent LOOP context: FINALLY RETURN.",
            "A value is returned with FINALLY (RETURN value).",
        ),
        (
            "(loop for x in a do print x)",
            "A compound form was expected, but PRINT found.\ncurrent LOOP context: DO PRINT.",
            "Forms are lists here: (print x).",
        ),
        (
            "(loop for x in a collect x sum x)",
            "incompatible kinds of LOOP value accumulation specified for collecting\n"
            "as the value of the LOOP: LIST and SUM\ncurrent LOOP context: SUM X.",
            "Give each its own variable with INTO.",
        ),
        ("(loop when t for x in a)", "FOR does not introduce a LOOP clause that can follow WHEN.\ncurrent LOOP context: WHEN T FOR.", None),
        ("(loop else)", "secondary clause misplaced at top level in LOOP macro: ELSE\ncurrent LOOP context: ELSE.", None),
        (
            "(loop for x being the parts of y)",
            "PART is not the name of a LOOP iteration path.\ncurrent LOOP context: FOR X BEING THE PARTS.",
            "There are HASH-KEYS, HASH-VALUES, SYMBOLS, PRESENT-SYMBOLS and EXTERNAL-SYMBOLS.",
        ),
        ("(loop for 5 in a)", "5 cannot be used as a variable.\ncurrent LOOP context: FOR 5.", None),
        ("(loop 3 4)", "3 found where a LOOP keyword expected\ncurrent LOOP context: 3.", None),
        ("(loop for x downto 3)", "don't know where to start stepping\ncurrent LOOP context: FOR X DOWNTO 3.", "Counting down needs FROM."),
    ],
)
def test_a_malformed_loop_is_explained(text, report, hint):
    problem = complaint(text)
    assert (problem.report(), problem.hint) == (report, hint)


@pytest.mark.parametrize(
    "clauses",
    [
        "for",
        "for x in",
        "for x = ",
        "with",
        "repeat",
        "collect",
        "when",
        "if t",
        "named",
        "initially",
        "finally",
        "do",
        "return",
        "while",
        "always",
        "thereis",
        "for x in a by",
        "for x being",
        "for x being the",
        "sum 1 into",
        "for (a . 3) in b",
        "for x in a using",
        "with x =",
        "for x being the hash-keys",
        "and",
        "end",
        "it",
        '"a" b',
    ],
)
def test_no_malformed_loop_raises_anything_but_a_condition(clauses):
    complaint(f"(loop {clauses})")


def test_keywords_are_recognized_in_any_package():
    assert python_list(value("(loop :for x :in '(1 2) cl-user::collect x)")) == [1, 2]


def test_forms_of_a_clause_are_evaluated_once_and_in_order():
    trace = value("""(let ((trace '()))
                       (flet ((note (x) (push x trace) x))
                         (loop for i from (note 1) to (note 4) by (note 2) do (note :turn)))
                       (reverse trace))""")
    assert [str(item) for item in trace] == ["1", "4", "2", ":TURN", ":TURN"]


def test_while_before_for_guards_it():
    assert python_list(value("(let ((l (list 1 2 3))) (loop for x = (pop l) while x for y = (* x 10) collect y))")) == [10, 20, 30]


def test_collecting_is_linear_and_needs_no_stack():
    assert value("(length (loop for i below 50000 collect i))") == 50000


def test_a_loop_over_a_list_tests_once_per_turn_at_its_top():
    expansion = repr(loop.expand(Reader("(loop for x in l do (f x))").read().cdr))
    assert expansion.count("ENDP") == 1


def test_a_counting_loop_tests_in_one_place():
    assert repr(loop.expand(Reader("(loop for i from 0 below n do (f i))").read().cdr)).count(">=") == 1


def test_loop_finish_runs_the_epilogue():
    assert value("(loop for i from 1 when (= i 3) do (loop-finish) sum i finally (return :done))") is sym(":DONE")


def test_symbols_of_a_package_are_visited():
    found = value("(loop for s being the external-symbols of :common-lisp when (eq s 'car) collect s)")
    assert python_list(found) == [sym("CAR")]


def test_the_list_named_by_into_can_be_used_while_it_grows():
    assert [python_list(part) for part in value("(loop for x in '(1 2) collect x into l collect (copy-list l))")] == [[1], [1, 2]]


def test_a_loop_over_something_else_than_a_vector_is_a_type_error():
    with pytest.raises(conditions.TypeError_):
        value("(loop for x across '(1 2) do (print x))")


def test_return_in_a_loop_leaves_only_the_innermost_unnamed_loop():
    assert value("(loop named outer for i in '(1 2) do (loop (return)) finally (return-from outer :all))") is sym(":ALL")
