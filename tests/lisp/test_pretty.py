"""The pretty printer breaks lines where SBCL breaks them."""

import printing_answers
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, sym
from cramhy_runtime.languages.commonlisp.printer import pprint_dispatch, printing_support
from cramhy_runtime.languages.commonlisp.printer.pretty import logical_block, pprint_indent, pprint_newline
from cramhy_runtime.languages.commonlisp.printer.print_controls import (
    PACKAGE,
    PRINT_LENGTH,
    PRINT_LEVEL,
    PRINT_LINES,
    PRINT_PRETTY,
    PRINT_RIGHT_MARGIN,
    bound,
)
from cramhy_runtime.languages.commonlisp.printer.printer import (
    define_printer,
    output_object,
    prin1,
    prin1_to_string,
    print_unreadable,
    write,
)
from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string
from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream


@pytest.fixture(autouse=True)
def running(monkeypatch):
    kernel.start(clock="virtual")
    with bound(PACKAGE, COMMON_LISP_USER):
        printing_answers.define_names(monkeypatch)
        yield
    kernel.stop()


def read(text):
    return read_from_string(text)[0]


class Message:
    """Stands for a ROS message."""

    def __init__(self, **fields):
        self.fields = fields


def print_message(message, stream):
    with logical_block(stream, "[", "]") as out:
        out.write("POSE")
        for name, value in message.fields.items():
            pprint_indent("block", 2, out)
            pprint_newline("mandatory", out)
            out.write(name.upper() + ":")
            pprint_indent("block", 4, out)
            pprint_newline("mandatory", out)
            output_object(value, out)


class Fluent:
    """Stands for a fluent."""

    def __init__(self, value):
        self.value = value


def print_fluent(fluent, stream):
    with logical_block(stream, "#<", ">") as out:
        out.write("FLUENT TURTLE-POSE ")
        pprint_newline("linear", out)
        out.write("[")
        write(fluent.value, out)
        out.write("]")


define_printer(Message, print_message)
define_printer(Fluent, print_fluent)


def test_a_message_has_one_line_per_name_and_per_value():
    assert prin1_to_string(Message(x=5.5, y=1)) == "[POSE\n   X:\n     5.5d0\n   Y:\n     1]"


def test_a_message_in_a_list_is_indented_as_a_whole():
    assert prin1_to_string(lisp_list(1, Message(x=1), 2)) == "(1\n [POSE\n    X:\n      1]\n 2)"


def test_a_fluent_breaks_before_its_value_when_that_takes_several_lines():
    assert prin1_to_string(Fluent(None)) == "#<FLUENT TURTLE-POSE [NIL]>"
    assert prin1_to_string(Fluent(Message(x=1))) == "#<FLUENT TURTLE-POSE\n  [[POSE\n      X:\n        1]]>"


def test_the_tail_of_a_lazy_list_stands_after_its_dot():
    class Tail:
        pass

    def print_tail(tail, stream):
        with logical_block(stream, "#S(", ")") as out:
            out.write("LAZY ")
            pprint_newline("linear", out)
            out.write(":GENERATOR " + "x" * 65)

    define_printer(Tail, print_tail)
    text = prin1_to_string(Cons(read("((?x . 1))"), Tail()))
    assert text == "(((?X . 1))\n . #S(LAZY\n      :GENERATOR " + "x" * 65 + "))"


def test_what_is_unreadable_is_one_block():
    class Pose:
        pass

    def body(stream):
        stream.write("POSE ")
        stream.write("\n   #<3D-VECTOR (0.0d0)>")

    define_printer(Pose, lambda pose, stream: print_unreadable(pose, stream, body=lambda: body(stream)))
    assert prin1_to_string(Pose()) == "#<POSE \n   #<3D-VECTOR (0.0d0)>>"


def test_without_print_pretty_nothing_is_broken():
    with bound(PRINT_PRETTY, None):
        assert "\n" not in prin1_to_string(read(f"({'long-name ' * 20})"))
        assert prin1_to_string(read("'x")) == "(QUOTE X)"


def test_a_block_too_deep_is_a_sharp_sign():
    with bound(PRINT_LEVEL, 1):
        assert prin1_to_string(lisp_list(1, Message(x=1))) == "(1 #)"


def test_lines_beyond_print_lines_are_cut():
    with bound(PRINT_LINES, 2, PRINT_RIGHT_MARGIN, 20):
        assert prin1_to_string(read("(foo bar baz quux frob a b c d e f g h i j k)")) == "(FOO BAR BAZ QUUX\n FROB A B C D E F G ..)"


def test_elements_beyond_print_length_are_dots():
    with bound(PRINT_LENGTH, 2):
        assert prin1_to_string(read("(a b c d)")) == "(A B ...)"


def test_an_error_inside_a_block_passes_through():
    stream = StringOutputStream()
    with pytest.raises(ValueError), logical_block(stream, "(", ")") as out:
        out.write("abc")
        raise ValueError


def test_a_user_may_say_how_a_type_of_list_prints():
    table = pprint_dispatch.copy_pprint_dispatch(None)
    with bound(pprint_dispatch.PRINT_PPRINT_DISPATCH, table):
        head = COMMON_LISP_USER.intern("MY-FORM")
        kind = lisp_list(sym("CONS"), lisp_list(sym("EQL"), head))
        pprint_dispatch.set_pprint_dispatch(kind, lambda stream, form: stream.write("<mine>"))
        assert prin1_to_string(read("(1 (my-form 2))")) == "(1 <mine>)"
        pprint_dispatch.set_pprint_dispatch(kind, None)
        assert prin1_to_string(read("(1 (my-form 2))")) == "(1 (MY-FORM 2))"


def test_a_user_may_say_how_atoms_print():
    table = pprint_dispatch.copy_pprint_dispatch(None)
    with bound(pprint_dispatch.PRINT_PPRINT_DISPATCH, table):
        pprint_dispatch.set_pprint_dispatch(sym("INTEGER"), lambda stream, number: stream.write(f"<{number}>"))
        assert prin1_to_string(read("(1 a)")) == "(<1> A)"
        with bound(PRINT_PRETTY, None):
            assert prin1_to_string(read("(1 a)")) == "(1 A)"


def test_the_macro_of_logical_blocks_hands_out_the_elements():
    stream = StringOutputStream()

    def body(out):
        while not printing_support.pprint_list_exhausted(out):
            out.write(f"{printing_support.pprint_pop(out)},")

    printing_support.pprint_logical_block(body, stream, lisp_list(1, 2), prefix="<", suffix=">")
    printing_support.pprint_logical_block(body, stream, Cons(1, 2), prefix="<", suffix=">")
    printing_support.pprint_logical_block(body, stream, 5, prefix="<", suffix=">")
    assert stream.text() == "<1,2,><1,. 2>5"


def test_a_block_on_standard_output_binds_it_to_the_pretty_stream():
    stream = StringOutputStream()
    with bound(sym("*STANDARD-OUTPUT*"), stream):
        printing_support.pprint_logical_block(lambda out: prin1(1), None, None, per_line_prefix="; ")
    assert stream.text() == "; 1"


def test_standard_syntax_turns_the_pretty_printer_off():
    assert printing_support.with_standard_io_syntax(lambda: prin1_to_string(read("'x"))) == "(QUOTE X)"
