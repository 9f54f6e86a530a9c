"""The reader: what texts mean, where forms stand, when a text is complete, and that no text breaks it."""

import time

import pytest
from systems import SOAK
from hypothesis import given, settings
from hypothesis import strategies as st

from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import Condition, Warning_, handler_bind, muffle_warning
from cramhy_runtime.lisp_core.data import Character, Cons, Symbol, lisp_list, list_from, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import find_package, intern, keyword, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
from cramhy_runtime.languages.commonlisp.syntax import backquote
from cramhy_runtime.languages.commonlisp.reader.reader import Reader, incomplete, read, read_from_string
from cramhy_runtime.languages.commonlisp.files.file_streams import open_
from cramhy_runtime.languages.commonlisp.streams.streams import InputStream, StringInputStream

USER = "COMMON-LISP-USER"


@pytest.fixture(autouse=True)
def in_user_package():
    kernel.start(clock="virtual")
    boot()
    with binding(sym("*PACKAGE*"), find_package(USER)):
        yield


def user(name):
    return intern(name, USER)


def first(text, **options):
    return Reader(text, **options).read()


# ---------------------------------------------------------------------------------------------------------------- meaning


def test_symbols_are_upcased_and_interned_in_the_current_package():
    assert first("drive-to") is user("DRIVE-TO")


def test_nil_and_the_empty_list_are_none_and_t_is_true():
    assert (first("nil"), first("()"), first("T")) == (None, None, True)


def test_a_literal_is_a_single_float_and_d0_makes_a_python_float():
    assert first("1.5").__class__ is SingleFloat
    assert first("1.5d0").__class__ is float


def test_a_literal_single_is_rounded_once_from_its_digits():
    assert first("0.1") == SingleFloat(0.1) == 0.10000000149011612
    beside_the_middle = "1.000000059604644775390625000000000001"  # a double has the middle, which rounds to the even 1.0
    assert first(beside_the_middle) == 1 + 2.0**-23
    assert first(beside_the_middle[:-1]) == 1


def test_a_very_long_integer_is_read():
    digits = "7" * 20000
    assert first(digits) % 10**9 == 777777777
    assert first(digits).bit_length() > 66000


def test_non_breaking_space_from_a_web_page_is_white_space():
    assert first("(a\xa0b)").cdr.car is user("B")


def test_a_vector_is_a_python_list_and_a_string_a_python_string():
    assert first('#(1 "a\\"b")') == [1, 'a"b']


def test_a_character_can_be_given_by_its_code():
    assert first("#\\x41") is Character("A")


def test_a_template_keeps_its_commas_for_the_printer():
    template = first("`(a ,b ,@c)")
    assert template.car is backquote.QUASIQUOTE
    assert [part.kind for part in list(template.cdr.car)[1:]] == [",", ",@"]


def test_a_constant_template_is_a_quoted_constant():
    assert prin1_to_string(backquote.expand(first("(a (b c))"))) == "'(A (B C))"


def test_sbcl_is_not_claimed_as_a_feature():
    assert list(first("(#+sbcl 1 #-sbcl 2 #+cramhy 3 #+(and ansi-cl (not sbcl)) 4)")) == [2, 3, 4]


def test_what_a_false_feature_skips_may_name_unknown_packages():
    assert first("#+sbcl (sb-mop:foo #:a 1 . 2) :kept") is keyword("KEPT")


def test_skipped_symbols_are_not_interned():
    first("#+(or) never-to-be-seen 1")
    assert find_package(USER).lookup("NEVER-TO-BE-SEEN") == (None, None)


def test_circular_structure_is_tied_together():
    loop = first("#1=(a #(#1#) . #1#)")
    assert loop.cdr.cdr is loop
    assert loop.cdr.car[0] is loop


# ----------------------------------------------------------------------------------------------------------------- places


def test_every_list_form_has_its_place():
    reader = Reader("(a\n  (b c)\n  'd)", filename="plan.lisp")
    form = reader.read()
    assert reader.positions[id(form)] == (1, 1, 3, 5)
    assert reader.positions[id(form.cdr.car)] == (2, 3, 2, 7)
    assert reader.positions[id(form.cdr.cdr.car)] == (3, 3, 3, 4)


def test_places_count_from_where_the_text_starts_in_its_file():
    reader = Reader("(a)\n(b)", line=10, column=5)
    forms = [reader.read(), reader.read()]
    assert [reader.positions[id(form)][:2] for form in forms] == [(10, 5), (11, 1)]


def test_read_all_gives_each_form_with_its_place():
    assert [(str(form), place) for form, place in Reader("1 ; one\n  (2)\n#|3|# :four").read_all()] == [
        ("1", (1, 1)),
        ("(2)", (2, 3)),
        (":FOUR", (3, 1)),
    ]


names = st.sampled_from(["a", "b-c", ":k", "12", "1.5", '"s"', "#\\x", "nil"])
texts_of_forms = st.recursive(
    names,
    lambda inner: (
        st.lists(inner, max_size=4).map(lambda parts: "(" + "  ".join(parts) + ")")
        | inner.map(lambda part: "'" + part)
        | st.lists(inner, max_size=3).map(lambda p: "#(" + "\n".join(p) + ")")
    ),
)


@given(st.lists(texts_of_forms, max_size=5))
def test_the_text_at_the_place_of_a_form_reads_as_that_form(texts):
    text = "\n; comment\n".join(texts)
    reader, lines = Reader(text), text.split("\n")
    forms = [form for form, _ in reader.read_all()]
    assert len(forms) == len(texts)
    for form, whole in zip(forms, texts):
        if id(form) in reader.positions:
            line, column, end_line, end_column = reader.positions[id(form)]
            part = lines[line - 1 : end_line]
            part[-1] = part[-1][:end_column]
            part[0] = part[0][column - 1 :]
            assert "\n".join(part) == whole


# ------------------------------------------------------------------------------------------------------------ completeness


@pytest.mark.parametrize(
    "text", ["(", "(a", '"abc', "(a 'b", "'", "#'", "#(1", "#|", "#| |", "|a", "`(a ,", '(a "b)', "#+sbcl", "(a . ", "#\\", "\\", "(a ; b)"]
)
def test_a_text_that_ends_inside_something_is_incomplete(text):
    assert incomplete(text) is True


@pytest.mark.parametrize(
    "text", ["", "a", "(a)", ")", "(a))", "nope:foo", "#<x>", "(a . )", '"a"', "#|x|#", "; (", "(a) (b)", ",a", "#.(foo)"]
)
def test_a_text_that_ends_between_forms_is_complete_however_wrong(text):
    assert incomplete(text) is False


def test_asking_whether_a_text_is_complete_interns_nothing():
    incomplete("(surely-not-seen-before")
    assert find_package(USER).lookup("SURELY-NOT-SEEN-BEFORE") == (None, None)


# ---------------------------------------------------------------------------------------------------------------- streams


class Lines(InputStream):
    """Gives one line at a time, as a terminal does, and remembers how many were asked for."""

    def __init__(self, *lines):
        super().__init__()
        self.lines, self.asked = list(lines), 0

    def more(self):
        self.asked += 1
        return self.lines.pop(0) if self.lines else ""


def test_reading_from_a_terminal_takes_no_line_more_than_the_form_needs():
    terminal = Lines("(a\n", "b) c\n", "d\n")
    assert prin1_to_string(read(terminal)) == "(A B)"
    assert terminal.asked == 2
    assert terminal.read_line() == ("c", False)


@given(st.lists(texts_of_forms, min_size=1, max_size=3))
def test_it_does_not_matter_in_which_pieces_a_text_arrives(texts):
    text = " ".join(texts) + " "
    source = Lines(*text)
    assert [prin1_to_string(read(source)) for _ in texts] == [prin1_to_string(form) for form, _ in Reader(text).read_all()]


def test_a_file_stream_is_read_on_where_it_is(tmp_path):
    path = tmp_path / "data.lisp"
    path.write_text("skip\n(a) b")
    stream = open_(path)
    stream.read_line()
    assert prin1_to_string(read(stream)) == "(A)"
    assert read(stream) is user("B")
    assert read(stream, None, keyword("END")) is keyword("END")
    stream.close()


def test_a_string_stream_stands_behind_the_object_and_one_blank():
    stream = StringInputStream("a  b")
    read(stream)
    assert stream.position() == 2


# -------------------------------------------------------------------------------------------------------------- any text


symbol_names = st.text(st.characters(codec="ascii", min_codepoint=32) | st.sampled_from("äλ\n"), max_size=6)
atoms = st.one_of(
    st.integers(),
    st.fractions().map(lambda f: f.numerator if f.denominator == 1 else f),
    st.none(),
    st.just(True),
    st.floats(allow_nan=False, allow_infinity=False).map(float),
    st.integers(-1000, 1000).map(lambda n: n / 8),
    st.text(max_size=8),
    st.characters(codec="utf-8").map(Character),
    symbol_names.map(user),
    symbol_names.map(keyword),
)
data = st.recursive(
    atoms,
    lambda inner: st.lists(inner, max_size=4).map(list_from) | st.builds(Cons, inner, inner) | st.lists(inner, max_size=3),
    max_leaves=12,
)


def alike(one, other):
    if isinstance(one, Cons) and isinstance(other, Cons):
        return alike(one.car, other.car) and alike(one.cdr, other.cdr)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, Symbol | Character) or one is None or one is True:
        return one is other
    if isinstance(one, str):
        return one == other
    return one.__class__ is other.__class__ and one == other


@pytest.mark.soak
@settings(max_examples=300, deadline=None)
@given(data)
def test_what_is_printed_reads_as_it_was(thing):
    assert alike(read_from_string(prin1_to_string(thing))[0], thing)


scraps = st.lists(
    st.sampled_from(
        [
            *"()'`,@.;\"|\\#:+-* \n\tabAB12/eEdx=<>_\xa0λ\x00",
            "#(",
            "#'",
            "#\\",
            "#|",
            "|#",
            "#+",
            "#-",
            "#1=",
            "#1#",
            "#b",
            "#x",
            "#c",
            "#*",
            "#2A",
            "#:",
            "cl:",
            "cl::",
            "nope:",
            "..",
            ",@",
            ",.",
            "`(",
            "#s(",
            "#p",
            "1e400",
            "1/0",
        ]
    ),
    max_size=25,
).map("".join)


@pytest.mark.soak
@settings(max_examples=1500 if SOAK else 400, deadline=None)
@given(scraps | st.text(max_size=20))
def test_no_text_whatsoever_raises_anything_but_a_condition(text):
    reader = Reader(text, filename="x.lisp")

    def read_everything():
        for _ in reader.read_all():
            pass

    with binding(sym("*READ-EVAL*"), None):
        try:
            handler_bind([(Warning_, lambda warning: muffle_warning(warning))], read_everything)
        except Condition as condition:
            assert condition.report()
            assert condition.position[0] == "x.lisp"
            assert 1 <= condition.position[1] <= text.count("\n") + 1
            assert condition.position[2] >= 1
        assert incomplete(text) in (True, False)


@pytest.mark.soak
def test_a_thousand_nested_lists_are_read():
    depth, form = 0, first("(" * 100_000 + ")" * 100_000)
    while form is not None:
        depth, form = depth + 1, form.car
    assert depth == 99_999


def test_endless_reader_macros_are_a_reader_error():
    with pytest.raises(Condition) as caught:
        first("#(" * 100_000)
    assert caught.value.report() == "The text is nested too deeply to be read."


def test_a_file_of_a_thousand_lines_is_read_in_well_under_150_milliseconds():
    text = "(defun drive (pose &key (speed 1.0))\n  ;; go\n  (format t \"~a~%\" `(a ,pose #'car #\\x))\n  (values 1 'b :c 1/2))\n" * 250
    best = min(_seconds(text) for _ in range(5))
    assert best < 0.15


def _seconds(text):
    start = time.thread_time()  # of the processor: the machine may be busy with other things
    assert sum(1 for _ in Reader(text).read_all()) == 250
    return time.thread_time() - start


def test_a_list_made_by_hand_prints_and_reads_back():
    assert alike(read_from_string("(1 . (2 3))")[0], lisp_list(1, 2, 3))


def test_a_conditional_within_a_skipped_form_skips_as_well():
    assert prin1_to_string(read_from_string("(1 #+lispworks #+lispworks :element-type 'lw:char 2)")[0]) == "(1 2)"


def in_own_table(change, text):
    return f'(let ((*readtable* (copy-readtable))) {change} (read-from-string "{text}"))'


NUMERALS = [
    ("'(#xFF #xfF #b101 #o17 #x-1A #X+1f #B-0 #O+7)", "(255 255 5 15 -26 31 0 7)"),
    ("'(#(#x1 #b0) #x1/2 #x10. #xAB(1))", "(#(1 0) 1/2 10 171 (1))"),
    ('(let ((*read-base* 16)) (read-from-string "(#b11 #o11 #x11 11 #x FF)"))', "(3 9 17 17 255)"),
    (in_own_table(r"(set-dispatch-macro-character #\# #\x (lambda (s c n) c n (list 1 (read s))))", "(#x12 #b11 #X5)"), "((1 12) 3 (1 5))"),
    (in_own_table(r"(set-syntax-from-char #\F #\Space)", "(#xAF1)"), "(10 1)"),
    (in_own_table(r"(set-macro-character #\1 (lambda (s c) s c 7))", "(#b01)"), "(0 7)"),
    ("(list #+nil #xZZ #-nil #xA)", "(10)"),
    *(
        (f'(handler-case (read-from-string "({text})") (reader-error () :no))', ":NO")
        for text in ("#b102", "#xF|a|", "#x0x10", "#x1_0", "#xG")
    ),
]


@pytest.mark.parametrize("form, answer", NUMERALS)
def test_a_number_in_a_radix_is_read_as_the_function_of_the_readtable_would_read_it(form, answer):
    assert prin1_to_string(one(evaluate(first(form)))) == answer


def test_a_table_of_numbers_is_read_without_a_call_for_each():
    text = "(" + "#x1F " * 1000 + "0)"
    form, calls = Reader(text), []
    form.read_char = lambda: calls.append(1)  # the function of #x reads its characters
    assert prin1_to_string(form.read().car) == "31" and not calls
