"""Streams know their column, and the standard ones follow their variables."""

import io
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import Character, LispString
from cramhy_runtime.languages.commonlisp.files import files
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.plain_answers import PlainStream
from cramhy_runtime.languages.commonlisp.printer.print_controls import bound
from cramhy_runtime.languages.commonlisp.files import file_streams
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools import user_queries
from cramhy_runtime.languages.commonlisp.streams import stream_functions as functions
from cramhy_runtime.languages.commonlisp.streams.streams import StringInputStream, StringOutputStream


@pytest.fixture(autouse=True)
def running():
    kernel.start(clock="virtual")
    yield
    kernel.stop()


def test_the_console_is_whatever_sys_stdout_is(capsys):
    functions.write_string("first")
    assert capsys.readouterr().out == "first"
    functions.terpri()


def test_a_fresh_line_is_started_only_in_the_middle_of_one():
    stream = StringOutputStream()
    assert functions.fresh_line(stream) is None
    functions.write_string("ab\ncd", stream)
    assert stream.column == 2
    assert functions.fresh_line(stream) is True
    assert functions.fresh_line(stream) is None
    assert stream.take() == "ab\ncd\n"


def test_a_string_stream_gives_its_text_once():
    stream = functions.make_string_output_stream()
    functions.write_line("abcdef", stream, start=1, end=3)
    functions.write_char(Character("x"), stream)
    assert functions.get_output_stream_string(stream) == "bc\nx"
    assert functions.get_output_stream_string(stream) == ""


def test_output_can_go_to_a_string_with_a_fill_pointer():
    target = LispString("abc", fill_pointer=1, adjustable=True)
    StringOutputStream(target).write("xy")
    assert str(target) == "axy"


def test_lines_and_characters_are_read_in_turn():
    stream = StringInputStream("one\n two\nthree")
    assert functions.read_line(stream) == ("one", None)
    assert functions.peek_char(None, stream) is Character(" ")
    assert functions.peek_char(True, stream) is Character("t")
    assert functions.read_char(stream) is Character("t")
    functions.unread_char(Character("t"), stream)
    assert functions.read_line(stream) == ("two", None)
    assert functions.read_line(stream) == ("three", True)
    assert functions.read_line(stream, None, "the end") == ("the end", True)


def test_reading_beyond_the_end_is_an_error_unless_a_value_was_given():
    stream = StringInputStream("")
    assert functions.read_char(stream, None, "none") == "none"
    with pytest.raises(conditions.EndOfFile) as caught:
        functions.read_char(stream)
    assert caught.value.report().startswith("end of file on #<SB-IMPL::STRING-INPUT-STREAM {")


def test_a_broadcast_stream_writes_to_all():
    first, second = StringOutputStream(), StringOutputStream()
    functions.write_string("x", functions.make_broadcast_stream(first, second))
    assert first.text() == second.text() == "x"
    functions.write_string("nowhere", functions.make_broadcast_stream())


def test_a_synonym_stream_follows_its_variable():
    stream = StringOutputStream()
    synonym = functions.make_synonym_stream(streams.STANDARD_OUTPUT)
    with bound(streams.STANDARD_OUTPUT, stream):
        functions.write_string("x", synonym)
        assert synonym.column == 1
    assert stream.text() == "x"


def test_concatenated_and_two_way_streams():
    source = functions.make_concatenated_stream(StringInputStream("ab"), StringInputStream("c\n"))
    sink = StringOutputStream()
    both = functions.make_two_way_stream(source, sink)
    assert functions.read_line(both) == ("abc", None)
    functions.write_string("out", both)
    assert sink.text() == "out"
    echo = functions.make_echo_stream(StringInputStream("in"), sink)
    functions.read_char(echo)
    assert sink.text() == "outi"


def test_a_python_file_is_a_stream_too():
    file = io.StringIO()
    functions.write_string("x", file)
    assert functions.fresh_line(file) is True
    assert file.getvalue() == "x\n"


def test_what_is_no_stream_is_a_type_error():
    with pytest.raises(conditions.TypeError_):
        functions.write_string("x", 5)
    with pytest.raises(conditions.TypeError_):
        functions.write_string(5)


def warned(condition):
    stream = StringOutputStream()
    with bound(streams.ERROR_OUTPUT, stream):
        user_queries.warning_line(condition)
    return stream.text()


def test_warnings_stand_on_lines_of_their_own():
    assert warned(conditions.SimpleWarning("w ~a", 1)) == "WARNING: w 1\n"
    assert warned(conditions.SimpleWarning("a~%b")) == "WARNING: a\nb\n"
    assert warned(conditions.SimpleStyleWarning("s")) == "STYLE-WARNING: s\n"
    long = "a long warning that has to be broken somewhere or other so that it is longer than 80 columns"
    assert warned(conditions.SimpleWarning(long)) == f"WARNING:\n   {long}\n"


def test_an_error_inside_a_warning_is_indented_to_its_place():
    inner = conditions.TypeError_(Character("a"), "NUMBER")
    text = warned(conditions.SimpleWarning("An error occurred while executing the lisp function `~a': `~a'", "+", inner))
    pad = " " * 61
    head = "WARNING:\n   An error occurred while executing the lisp function `+': `The value\n"
    assert text == f"{head}{pad}  #\\a\n{pad}is not of type\n{pad}  NUMBER'\n"


def test_questions_are_asked_until_they_are_answered(monkeypatch):
    sink = StringOutputStream()
    query = streams.TwoWayStream(StringInputStream("maybe\ny\n"), sink)
    with bound(streams.QUERY_IO, query):
        assert functions.y_or_n_p("Go ~a?", "on") is True
    assert sink.text() == 'Go on? (y or n) Please type "y" for yes or "n" for no.\nGo on? (y or n) '


def test_the_console_reads_whatever_sys_stdin_is(monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.StringIO("typed\nmore\n"))
    assert functions.read_line(streams.ConsoleInput()) == ("typed", None)


def test_files_are_written_and_read(tmp_path):
    path = tmp_path / "a~b.txt"
    output = sym(":OUTPUT")
    file_streams.with_open_file(lambda stream: functions.write_line("one", stream), str(path), direction=output)
    file_streams.with_open_file(lambda stream: functions.write_line("two", stream), path, direction=output, if_exists=sym(":APPEND"))
    lines = file_streams.with_open_file(lambda stream: [functions.read_line(stream)[0] for _ in range(2)], path)
    assert lines == ["one", "two"]
    assert str(files.probe_file(str(path))) == str(path.resolve())
    assert files.delete_file(path) is True
    assert files.probe_file(path) is None
    assert file_streams.open_(path, if_does_not_exist=None) is None


def test_a_file_that_is_not_there_is_named(tmp_path):
    path = tmp_path / "none"
    for attempt, text in [
        (file_streams.open_, f'The file #P"{path}" does not exist: No such file or directory'),
        (files.delete_file, f'Could not delete the file "{path}": No such file or directory'),
    ]:
        with pytest.raises(conditions.FileError) as caught:
            attempt(path)
        assert caught.value.report() == text


def test_an_existing_file_is_not_overwritten_unasked(tmp_path):
    path = tmp_path / "there"
    path.write_text("kept")
    with pytest.raises(conditions.FileError) as caught:
        file_streams.open_(path, direction=sym(":OUTPUT"))
    assert caught.value.report() == f'The file #P"{path}" already exists: File exists'
    assert path.read_text() == "kept"


def test_a_closed_file_says_so(tmp_path):
    path = tmp_path / "there"
    path.write_text("text")
    stream = file_streams.open_(path)
    functions.close(stream)
    with pytest.raises(conditions.StreamError) as caught:
        functions.read_char(stream)
    assert caught.value.report().endswith("}> is closed")


@pytest.mark.parametrize(("encoding", "shown"), [("cp1252", b"gr\xfcn \\u2192 \\u03bb"), ("ascii", b"gr\\xfcn \\u2192 \\u03bb")])
@pytest.mark.parametrize("form", ['(write-string "grün → λ")', '(let ((*standard-output* *terminal-io*)) (princ "grün → λ"))'])
def test_the_console_shows_signs_that_its_encoding_lacks_as_escapes(session, monkeypatch, encoding, shown, form):
    """A pipe of Windows has the encoding cp1252, and nobody but ``cramhy`` itself has told Python what to do with the rest."""
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding=encoding))
    session.evaluate_text(form)
    sys.stdout.flush()
    assert written.getvalue() == shown


def test_the_output_of_plans_in_python_does_so_too(monkeypatch):
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding="cp1252"))
    stream = PlainStream("stdout")
    stream.write("Nach → gehen.")
    stream.fresh_line()
    stream.flush()
    assert written.getvalue().replace(b"\r\n", b"\n") == b"Nach \\u2192 gehen.\n"
