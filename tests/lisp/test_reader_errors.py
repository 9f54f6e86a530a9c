"""What the reader says about a wrong text: SBCL's sentence, the place, the line, and what to try."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import find_package, make_package, sym
from cramhy_runtime.languages.commonlisp.reader.reader import Reader, read_from_string
from cramhy_runtime.languages.commonlisp.reader.reader_errors import UnmatchedClose


@pytest.fixture(autouse=True)
def in_user_package():
    kernel.start(clock="virtual")
    boot()
    with binding(sym("*PACKAGE*"), find_package("COMMON-LISP-USER")):
        yield


@pytest.fixture
def robots():
    package = find_package("READER-ROBOTS") or make_package("READER-ROBOTS")
    package.export(package.intern("DRIVE"))
    package.intern("TURN")
    return package


def complaint(text, filename="plan.lisp"):
    with pytest.raises(conditions.Condition) as caught:
        for _ in Reader(text, filename=filename).read_all():
            pass
    return caught.value


def test_an_unclosed_list_is_reported_where_it_was_opened():
    problem = complaint("(defun a ()\n  (b c)\n\n")
    assert isinstance(problem, conditions.EndOfFile)
    assert problem.position == ("plan.lisp", 1, 1)
    assert problem.hint == "The ( at line 1, column 1 is never closed."
    assert problem.excerpt == "(defun a ()\n^"


def test_a_form_at_the_margin_inside_an_unclosed_one_tells_where_the_parenthesis_is_missing():
    problem = complaint("(defun a ()\n  (b c)\n(defun d ())\n")
    assert problem.hint == ("The ( at line 1, column 1 is never closed. Perhaps its ) is missing before line 3, where a new form begins.")


def test_several_open_lists_are_counted():
    assert complaint("(a (b (c").hint == (
        "The ( at line 1, column 1 is never closed. 3 are open at the end; the innermost begins at line 1, column 7."
    )


def test_an_unclosed_string_is_reported_where_it_begins():
    problem = complaint('(print\n "hello)\n')
    assert problem.hint.startswith("The ( at line 1, column 1 is never closed.")
    assert complaint(' "hello').position == ("plan.lisp", 1, 2)
    assert complaint(' "hello').hint == 'The " at line 1, column 2 has no second ".'


def test_an_unclosed_comment_is_reported_where_it_begins():
    assert complaint("a\n#| b").hint == "The comment #| at line 2, column 1 has no |#."


def test_an_unknown_package_is_named_with_those_that_are_like_it(robots):
    problem = complaint("(print\n (reader-robot:drive))")
    assert isinstance(problem, conditions.ReaderPackageError)
    assert problem.report() == "Package READER-ROBOT does not exist."
    assert problem.position == ("plan.lisp", 2, 3)
    assert problem.excerpt == " (reader-robot:drive))\n  ^"
    assert problem.hint == "There is no package READER-ROBOT. Did you mean READER-ROBOTS?"


def test_a_symbol_that_a_package_does_not_have(robots):
    problem = complaint("(reader-robots:drve)")
    assert problem.report() == 'Symbol "DRVE" not found in the READER-ROBOTS package.'
    assert problem.hint == "READER-ROBOTS exports no symbol DRVE. Did you mean reader-robots:drive?"


def test_a_symbol_that_is_internal(robots):
    problem = complaint("reader-robots:turn")
    assert problem.report() == 'The symbol "TURN" is not external in the READER-ROBOTS package.'
    assert problem.hint == "It is internal to READER-ROBOTS: with two colons, reader-robots::turn, it can be used all the same."


def test_the_restart_continue_takes_the_symbol_all_the_same(robots):
    found = conditions.handler_bind(
        [(conditions.ReaderPackageError, lambda problem: conditions.continue_(problem))], lambda: Reader("reader-robots:turn").read()
    )
    assert found is robots.intern("TURN")


def test_a_splice_outside_a_list():
    assert "is not a well-formed backquote expression" in complaint("`,@b").report()
    assert "contains a splicing comma after a dot" in complaint("`(a . ,@b)").report()


@pytest.mark.parametrize(
    "text, report, hint",
    [
        ("a:b:c", 'too many colons in "a:b:c"', "A symbol is written name, package:name, package::name or :keyword."),
        (":::x", 'too many colons in ":::x"', "A symbol is written name, package:name, package::name or :keyword."),
        ("1/0", "failed to build ratio", "The denominator of a ratio must not be zero."),
        (
            "1e39",
            "failed to build float from 1e39",
            "The largest single-float is about 3.4e38; write the exponent with d for a double-float: 1d39.",
        ),
        ("(1, 2)", "Comma not inside a backquote.", "Lists are written without commas: (1 2 3)."),
        ("(max 3,7)", "Comma not inside a backquote.", "Numbers have a point: 3.7"),
        ("(max -1,57 2)", "Comma not inside a backquote.", "Numbers have a point: -1.57"),
        ("(max 3,x)", "Comma not inside a backquote.", "Lists are written without commas: (1 2 3)."),
        ("(a . b c)", "More than one object follows . in list.", "After the dot and one object the list must end."),
        ("#<thing>", "illegal sharp macro character: #\\<", "What prints as #<...> cannot be read back."),
        ("#\\Spce", 'unrecognized character name: "Spce"', "Did you mean #\\Space?"),
        ("(a ')", "unmatched close parenthesis", "Something must follow the ' before the )."),
    ],
)
def test_malformed_texts_are_explained(text, report, hint):
    problem = complaint(text)
    assert (problem.report(), problem.hint) == (report, hint)


def test_an_unmatched_parenthesis_at_top_level_is_warned_about_and_ignored():
    warnings = []

    def note(warning):
        warnings.append(warning)
        conditions.muffle_warning(warning)

    forms = conditions.handler_bind([(UnmatchedClose, note)], lambda: [form for form, _ in Reader("1)\n 2", "a.lisp").read_all()])
    assert forms == [1, 2]
    assert warnings[0].report() == "unmatched close parenthesis at a.lisp:1:2, ignored"
    assert warnings[0].position == ("a.lisp", 1, 2)


def test_a_program_that_reads_an_unmatched_parenthesis_gets_an_error():
    with pytest.raises(conditions.ReaderError) as caught:
        read_from_string(")")
    assert caught.value.report() == "unmatched close parenthesis"


def test_after_an_error_the_reader_can_be_used_again():
    reader = Reader("(nope:a) (b `(c ,d))")
    with pytest.raises(conditions.ReaderError):
        reader.read()
    rest = [form for form, _ in Reader(reader.text[9:]).read_all()]
    assert len(rest) == 1


def test_the_caret_of_a_long_line_stays_in_view():
    excerpt = complaint("(" + "a " * 200 + "#< ").excerpt
    line, caret = excerpt.split("\n")
    assert len(line) <= 100 and line[len(caret) - 1] == "#"
