"""The printer prints what SBCL prints."""

import math
import sys
from fractions import Fraction

import printing_answers
import pytest

from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, Package, find_package, keyword, register, sym
from cramhy_runtime.languages.commonlisp.printer import printer
from cramhy_runtime.languages.commonlisp.printer.print_controls import (
    PACKAGE,
    PRINT_CASE,
    PRINT_CIRCLE,
    PRINT_PRETTY,
    PRINT_READABLY,
    bound,
)
from cramhy_runtime.languages.commonlisp.printer.printer import define_printer, prin1_to_string, princ_to_string, print_unreadable


@pytest.fixture(autouse=True)
def running(monkeypatch):
    kernel.start(clock="virtual")
    with bound(PACKAGE, COMMON_LISP_USER):
        printing_answers.define_names(monkeypatch)
        yield
    kernel.stop()


@pytest.mark.parametrize("name", ["floats", "names", "code", "random_data"])
def test_recorded_objects_print_as_in_sbcl(name):
    assert printing_answers.differences(name) == []


@pytest.mark.parametrize(
    "number, text",
    [
        (42, "42"),
        (Fraction(1, 2), "1/2"),
        (SingleFloat(11 / 3), "3.6666667"),
        (SingleFloat(1e7), "1.0e7"),
        (SingleFloat(1e-4), "1.0e-4"),
        (SingleFloat(0.001), "0.001"),
        (SingleFloat(-0.0), "-0.0"),
        (5.0, "5.0d0"),
        (1e7, "1.0d7"),
        (6.123233995736766e-17, "6.123233995736766d-17"),
        (5.544444561004639, "5.544444561004639d0"),
        (1e300, "1.0d300"),
        (10**30, "1" + "0" * 30),
    ],
)
def test_numbers_read_back_as_they_were(number, text):
    assert prin1_to_string(number) == text
    assert princ_to_string(number) == text


def test_an_integer_of_many_digits_is_printed_whole():
    limit = sys.get_int_max_str_digits()
    assert prin1_to_string(10**limit + 7) == "1" + "0" * (limit - 1) + "7"


def test_infinities_and_nan_print_as_in_sbcl():
    assert prin1_to_string(SingleFloat(math.inf)) == "#.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY"
    assert prin1_to_string(-math.inf) == "#.SB-EXT:DOUBLE-FLOAT-NEGATIVE-INFINITY"
    assert prin1_to_string(SingleFloat(math.nan)) == "#<SINGLE-FLOAT quiet NaN>"


def test_the_default_float_format_decides_which_floats_bear_a_mark():
    with bound(sym("*READ-DEFAULT-FLOAT-FORMAT*"), sym("DOUBLE-FLOAT")):
        assert prin1_to_string(SingleFloat(1.5)) == "1.5f0"
        assert prin1_to_string(1.5) == "1.5"


def test_a_symbol_bears_the_package_that_the_current_one_does_not_see():
    home = find_package("PRINTER-HOME") or register(Package("PRINTER-HOME", ["PH"]))
    inner, outer = home.intern("INNER"), home.intern("OUTER")
    home.export(outer)
    assert prin1_to_string(inner) == "PRINTER-HOME::INNER"
    assert prin1_to_string(outer) == "PRINTER-HOME:OUTER"
    assert princ_to_string(inner) == "INNER"
    with bound(PACKAGE, home):
        assert prin1_to_string(inner) == "INNER"
        assert prin1_to_string(None) == "COMMON-LISP:NIL"


def test_keywords_uninterned_symbols_and_cases():
    assert prin1_to_string(keyword("LEFT")) == ":LEFT"
    assert princ_to_string(keyword("LEFT")) == "LEFT"
    assert prin1_to_string(Symbol("G12")) == "#:G12"
    with bound(PRINT_CASE, keyword("DOWNCASE")):
        assert prin1_to_string(keyword("LEFT")) == ":left"


def test_truth_and_emptiness_are_the_symbols_t_and_nil():
    assert [prin1_to_string(value) for value in (None, False, True)] == ["NIL", "NIL", "T"]


def test_strings_are_quoted_only_when_they_must_be_read_back():
    assert prin1_to_string('say "hi"') == '"say \\"hi\\""'
    assert princ_to_string('say "hi"') == 'say "hi"'
    assert prin1_to_string(LispString("abc", fill_pointer=2)) == '"ab"'


def test_a_circular_list_prints_with_labels():
    circle = lisp_list(1, 2)
    circle.cdr.cdr = circle
    with bound(PRINT_CIRCLE, True):
        assert prin1_to_string(circle) == "#1=(1 2 . #1#)"
        with bound(PRINT_PRETTY, None):
            assert prin1_to_string(circle) == "#1=(1 2 . #1#)"
        shared = lisp_list(1)
        assert prin1_to_string(lisp_list(shared, shared)) == "(#1=(1) #1#)"


def test_a_condition_prints_its_report_or_itself():
    condition = conditions.SimpleError("msg ~a", 1)
    assert princ_to_string(condition) == "msg 1"
    assert prin1_to_string(condition).startswith('#<SIMPLE-ERROR "msg ~a" {')
    wrong = conditions.TypeError_(keyword("A"), "NUMBER")
    assert prin1_to_string(wrong) == "#<TYPE-ERROR expected-type: NUMBER datum: :A>"
    assert princ_to_string(wrong) == "The value\n  :A\nis not of type\n  NUMBER"


def test_a_restart_prints_its_name_or_what_it_does():
    restart = conditions.Restart(keyword("GO-ON"), print, "Go on.")
    assert princ_to_string(restart) == "Go on."
    assert prin1_to_string(restart).startswith("#<RESTART :GO-ON {")


def test_a_function_is_known_by_its_name():
    symbol = COMMON_LISP_USER.intern("PRINTED-FUNCTION")
    symbol.function = named = lambda: None
    named.__lisp_name__ = symbol
    assert prin1_to_string(named) == "#<FUNCTION PRINTED-FUNCTION>"
    anonymous = lambda x: x  # noqa: E731
    anonymous.__lisp_name__ = lisp_list(sym("LAMBDA"), lisp_list(COMMON_LISP_USER.intern("X")))
    assert prin1_to_string(anonymous).startswith("#<FUNCTION (LAMBDA (X)) {")


def test_packages_and_foreign_objects():
    assert prin1_to_string(COMMON_LISP_USER) == '#<PACKAGE "COMMON-LISP-USER">'
    assert prin1_to_string({1: 2}) == "#<PYTHON {1: 2}>"


class Thing:
    lisp_name = "KEYWORD::THING"


def test_an_address_stays_the_same_as_long_as_the_object_lives():
    thing, other = Thing(), Thing()
    first = printer.address(thing)
    assert printer.address(other) != first == printer.address(thing)
    assert len(first) == 10 and first.startswith("1001")


def test_unreadable_objects_show_what_was_asked_for(monkeypatch):
    monkeypatch.setattr(printer, "address", lambda obj: "1001")
    monkeypatch.setattr(printer, "type_name", lambda obj: COMMON_LISP_USER.intern("BAR"))
    shown = []
    for text, type_, identity in [
        (None, True, False),
        ("X", True, False),
        ("X", True, True),
        ("X", False, True),
        (None, False, True),
        (None, True, True),
        (None, False, False),
    ]:
        define_printer(Thing, lambda obj, stream: print_unreadable(obj, stream, text, type_, identity))
        shown.append(prin1_to_string(Thing()))
    assert shown == ["#<BAR >", "#<BAR X>", "#<BAR X {1001}>", "#<X {1001}>", "#< {1001}>", "#<BAR {1001}>", "#<>"]


def test_what_cannot_be_read_back_is_an_error_when_it_must_be():
    define_printer(Thing, lambda obj, stream: print_unreadable(obj, stream, "thing"))
    with bound(PRINT_READABLY, True), pytest.raises(conditions.PrintNotReadable):
        prin1_to_string(Thing())


def test_the_users_print_object_method_comes_first(monkeypatch):
    define_printer(Thing, lambda obj, stream: stream.write("ours"))
    assert prin1_to_string(Thing()) == "ours"
    monkeypatch.setattr(printer.user_methods, "print_object", lambda obj, stream: stream.write("theirs") or True)
    assert prin1_to_string(Thing()) == "theirs"


def test_a_dotted_pair_and_a_long_list():
    assert prin1_to_string(Cons(1, 2)) == "(1 . 2)"
    text = prin1_to_string(list_from(range(100)))
    assert max(map(len, text.splitlines())) <= 80
    assert text.replace("\n", "") == "(" + " ".join(map(str, range(100))) + ")"
