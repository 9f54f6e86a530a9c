"""``format`` formats as SBCL's does, errors included."""

import printing_answers
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import TypeError_
from cramhy_runtime.lisp_core.data import LispString, lisp_list, python_list
from cramhy_runtime.languages.commonlisp.format.format import format_, format_to_string, formatter
from cramhy_runtime.languages.commonlisp.format.format_parser import FormatError
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, keyword, sym
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE, PRINT_ESCAPE, bound
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream


@pytest.fixture(autouse=True)
def running(monkeypatch):
    kernel.start(clock="virtual")
    with bound(PACKAGE, COMMON_LISP_USER):
        printing_answers.define_names(monkeypatch)
        yield
    kernel.stop()


@pytest.mark.parametrize("name", ["format", "float_directives"])
def test_recorded_directives_print_as_in_sbcl(name):
    assert printing_answers.differences(name) == []


def test_a_line_of_the_ros_log():
    topic = lisp_list(COMMON_LISP_USER.intern("TURTLE"))
    stream = StringOutputStream()
    stream.write("half a line")
    format_(stream, "~&[~a ~a] ~,3F: ~a~&", topic, keyword("INFO"), 1795218762.624, "hello")
    assert stream.text() == "half a line\n[(TURTLE) INFO] 1795218762.624: hello\n"


def test_the_destination_decides_where_the_text_goes():
    stream = StringOutputStream()
    with bound(streams.STANDARD_OUTPUT, stream):
        assert format_(True, "~a", 1) is None
    assert format_(stream, "~a", 2) is None
    assert stream.text() == "12"
    assert format_(None, "~a", 3) == "3"
    growing = LispString("ab", fill_pointer=2, adjustable=True)
    format_(growing, "~a", "cd")
    assert str(growing) == "abcd"


def test_too_few_arguments_are_shown_with_their_place():
    with pytest.raises(FormatError) as caught:
        format_to_string("~a and ~a", 1)
    assert caught.value.report() == "error in FORMAT: No more arguments\n  ~a and ~a\n          ^"


def test_an_error_in_an_indirect_control_says_where_that_was_used():
    with pytest.raises(FormatError) as caught:
        format_to_string("<~?>", "~a", None)
    assert caught.value.report() == (
        "error in FORMAT: No more arguments\n  ~a\n   ^\nwhile processing indirect format string:\n  <~?>\n    ^"
    )


def test_arguments_of_an_iteration_must_be_lists():
    with pytest.raises(TypeError_):
        format_to_string("~{~a~}", 5)


def test_a_bad_control_leaves_the_next_use_as_it_was():
    for _ in range(2):
        with pytest.raises(FormatError):
            format_to_string("~{~a", None)
    assert format_to_string("~{~a~}", lisp_list(1, 2)) == "12"


def test_a_formatter_prints_and_returns_what_is_left():
    stream = StringOutputStream()
    left = formatter("~a-~a")(stream, 1, 2, 3)
    assert (stream.text(), python_list(left)) == ("1-2", [3])
    assert format_to_string(formatter("<~a>"), 1) == "<1>"


def test_a_user_function_formats_its_argument():
    symbol = COMMON_LISP_USER.intern("SHOUT")
    symbol.function = lambda stream, arg, colon, at, *rest: stream.write(f"{arg}!{colon}{at}{rest}")
    assert format_to_string("~3:/shout/", "hey") == "hey!TrueNone(3,)"


def test_escape_is_off_for_a_and_on_for_s_whatever_is_bound_outside():
    with bound(PRINT_ESCAPE, None):
        assert format_to_string("~s ~s", "a", lisp_list("b")) == '"a" ("b")'
    assert format_to_string("~a", lisp_list("b", keyword("C"))) == "(b C)"


def test_case_conversion_covers_what_directives_print():
    assert format_to_string("~:(~a~) ~(~a~)", sym("HELLO-WORLD"), sym("HELLO")) == "Hello-World hello"
