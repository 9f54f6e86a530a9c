"""UIOP's functions of streams: what is read and written, and streams for the time of a call (UIOP's manual, "Stream")."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, FreshString, MultipleValues, list_from, truth
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import find_package_or_error, is_symbol, keyword, sym, symbol_name
from cramhy_runtime.kernel.typing_names import Any

from ..evaluation.evaluator import PACKAGE, evaluate
from ..files.file_streams import with_open_file
from ..format.format import format_
from ..pathnames.pathname_objects import Pathname
from ..printer.printer import prin1, princ
from ..reader.dispatch_macros import READ_EVAL
from ..reader.reader_functions import read, read_from_string
from ..streams.basic_streams import StringInputStream, StringOutputStream
from ..streams.stream_functions import finish_output, read_line, terpri
from ..streams.streams import ERROR_OUTPUT, STANDARD_OUTPUT, input_stream, output_stream
from .utilities import TEXT, access_at, access_at_count, stripln

FUNCTIONS = """slurp-stream-string slurp-stream-lines slurp-stream-line slurp-stream-forms slurp-stream-form slurp-input-stream
    vomit-output-stream copy-stream-to-stream read-file-forms safe-read-file-line safe-read-file-form safe-read-from-string
    call-with-output call-with-input call-with-output-file call-with-input-file call-with-null-output call-with-null-input
    call-with-safe-io-syntax output-string input-string println writeln safe-format! format! finish-outputs eval-input load-from-string
    file-stream-p"""
NOTHING = object()


def lines_of(stream: Any) -> list[tuple[str, bool]]:
    """The lines that are left in a stream, each with whether an end of line stood behind it."""
    source, lines = input_stream(stream), []
    while True:
        line, ended = read_line(source, None, NOTHING)
        if line is NOTHING or line == "" and ended is not None:
            return lines
        lines.append((str(line), ended is None))
        if ended is not None:
            return lines


def text_left(stream: Any) -> str:
    """The text that is left in a stream."""
    return "".join(line + ("\n" if ended else "") for line, ended in lines_of(stream))


def slurp_stream_string(stream: Any, *, element_type: Any = None, stripped: Any = None) -> Any:
    """``uiop:slurp-stream-string``: the text that is left; ``stripped``: without its last end of line, which is the second value."""
    text = FreshString(text_left(stream))
    return stripln(text) if truth(stripped) else text


def slurp_stream_lines(stream: Any, *, count: Any = None) -> Any:
    """``uiop:slurp-stream-lines``: the list of the lines, ``count`` at most."""
    return list_from([FreshString(line.rstrip("\r")) for line, _ in lines_of(stream)][:count])


def slurp_stream_line(stream: Any, *, at: Any = 0) -> Any:
    """``uiop:slurp-stream-line``: what ``access-at`` finds in the list of the lines, by default the first."""
    return access_at(slurp_stream_lines(stream, count=access_at_count(at)), at)


def slurp_stream_forms(stream: Any, *, count: Any = None) -> Any:
    """``uiop:slurp-stream-forms``: the list of what `read` reads, ``count`` at most."""
    forms: list[Any] = []
    while count is None or len(forms) < count:
        form = read(stream, None, NOTHING)
        if form is NOTHING:
            break
        forms.append(form)
    return list_from(forms)


def slurp_stream_form(stream: Any, *, at: Any = 0) -> Any:
    """``uiop:slurp-stream-form``: what ``access-at`` finds in the list of the forms, by default the first."""
    return access_at(slurp_stream_forms(stream, count=access_at_count(at)), at)


_SLURPING = {
    "STRING": slurp_stream_string,
    "LINES": slurp_stream_lines,
    "LINE": slurp_stream_line,
    "FORMS": slurp_stream_forms,
    "FORM": slurp_stream_form,
}


def slurp_input_stream(processor: Any, stream: Any, *, element_type: Any = None, **keys: Any) -> Any:
    """``uiop:slurp-input-stream``: what is left of a stream: as :STRING, :LINES, :LINE, :FORMS or :FORM, or what a function of it gives.

    processor: one of these, or a list of it and its arguments; or a stream, a file or T (``*standard-output*``) to copy it to; or nil.
    """
    if isinstance(processor, Cons):
        options = list(processor.cdr or ())
        if not is_symbol(processor.car) or symbol_name(processor.car) not in _SLURPING:
            return function_of(processor.car)(stream, *options)
        keys = {symbol_name(name).lower().replace("-", "_"): value for name, value in zip(options[::2], options[1::2])}
        processor = processor.car
    if processor is None:
        return None
    if is_symbol(processor) and symbol_name(processor) in _SLURPING:
        return _SLURPING[symbol_name(processor)](stream, **keys)
    if callable(processor):
        return processor(stream)
    if isinstance(processor, (*TEXT, Pathname)):
        return call_with_output_file(processor, lambda target: copy_stream_to_stream(stream, target), if_exists=keyword("SUPERSEDE"))
    return copy_stream_to_stream(stream, STANDARD_OUTPUT.value if processor is True else processor)


def vomit_output_stream(processor: Any, stream: Any, *, element_type: Any = None, **keys: Any) -> None:
    """``uiop:vomit-output-stream``: write to a stream: a text, the rest of another stream, what a function writes, or nothing for nil."""
    if isinstance(processor, TEXT):
        output_stream(stream).write(str(processor))
    elif callable(processor):
        processor(stream)
    elif isinstance(processor, Pathname):
        call_with_input_file(processor, lambda source: copy_stream_to_stream(source, stream))
    elif processor is not None:
        copy_stream_to_stream(processor, stream)


def copy_stream_to_stream(
    input: Any, output: Any, *, element_type: Any = None, linewise: Any = None, prefix: Any = None, **more: Any
) -> None:
    """``uiop:copy-stream-to-stream``: write what is left of a stream to another; ``linewise``: line by line, ``prefix`` before each."""
    target = output_stream(output)
    for line, ended in lines_of(input):
        target.write((str(prefix) if prefix is not None and truth(linewise) else "") + line + ("\n" if ended else ""))
    if truth(linewise):
        finish_output(target)


def read_file_forms(path: Any, *, count: Any = None, **options: Any) -> Any:
    """``uiop:read-file-forms``: the list of the forms in a file."""
    return call_with_input_file(path, lambda stream: slurp_stream_forms(stream, count=count), **options)


def read_file_form(path: Any, *, at: Any = 0, **options: Any) -> Any:
    """``uiop:read-file-form``: a form of a file, by default the first."""
    return call_with_input_file(path, lambda stream: slurp_stream_form(stream, at=at), **options)


def read_file_lines(path: Any, *, count: Any = None, **options: Any) -> Any:
    """``uiop:read-file-lines``: the list of the lines of a file."""
    return call_with_input_file(path, lambda stream: slurp_stream_lines(stream, count=count), **options)


def read_file_line(path: Any, *, at: Any = 0, **options: Any) -> Any:
    """``uiop:read-file-line``: a line of a file, by default the first."""
    return call_with_input_file(path, lambda stream: slurp_stream_line(stream, at=at), **options)


def read_file_string(path: Any, *, external_format: Any = keyword("DEFAULT"), **options: Any) -> Any:
    """``uiop:read-file-string``: the text of a file."""
    return call_with_input_file(path, slurp_stream_string, external_format=external_format, **options)


def safe_read_file_line(path: Any, *, package: Any = keyword("CL"), at: Any = 0, **options: Any) -> Any:
    """``uiop:safe-read-file-line``: `read_file_line` with the reader of the standard."""
    return call_with_safe_io_syntax(lambda: read_file_line(path, at=at, **options), package=package)


def safe_read_file_form(path: Any, *, package: Any = keyword("CL"), at: Any = 0, **options: Any) -> Any:
    """``uiop:safe-read-file-form``: `read_file_form` with the reader of the standard, which evaluates nothing."""
    return call_with_safe_io_syntax(lambda: read_file_form(path, at=at, **options), package=package)


def safe_read_from_string(string: Any, *, package: Any = keyword("CL"), eof_error_p: Any = True, eof_value: Any = None, **more: Any) -> Any:
    """``uiop:safe-read-from-string``: ``read-from-string`` with the reader of the standard, which evaluates nothing."""
    return call_with_safe_io_syntax(lambda: read_from_string(string, eof_error_p, eof_value, **more), package=package)


def call_with_safe_io_syntax(thunk: Any, *, package: Any = keyword("CL")) -> Any:
    """``uiop:call-with-safe-io-syntax``: the values of ``thunk``, for which the reader and printer are those of the standard, and nothing
    is evaluated while reading."""
    from ..printer.printing_support import with_standard_io_syntax

    def inside() -> Any:
        with binding(PACKAGE, find_package_or_error(package), READ_EVAL, None, sym("*PRINT-READABLY*"), None):
            return function_of(thunk)()

    return with_standard_io_syntax(inside)


# ------------------------------------------------------------------------------------------------- streams for a call


def call_with_output(output: Any, function: Any, *, element_type: Any = None, **more: Any) -> Any:
    """``uiop:call-with-output``: the values of ``function`` of the stream that ``output`` means; for nil, what it wrote to a string.

    output: a stream, T for ``*standard-output*``, nil, a string with a fill pointer, a pathname.
    """
    if output is None:
        target = StringOutputStream()
        function_of(function)(target)
        return FreshString(target.text())
    if isinstance(output, Pathname):
        return call_with_output_file(output, function, **more)
    if not hasattr(output, "write") and output is not True:
        target = StringOutputStream(output)
        return function_of(function)(target)
    return function_of(function)(output_stream(STANDARD_OUTPUT.value if output is True else output))


def call_with_input(input: Any, function: Any, *, element_type: Any = None, **more: Any) -> Any:
    """``uiop:call-with-input``: the values of ``function`` of the stream that ``input`` means: a stream, T, nil, a text or a pathname."""
    if isinstance(input, TEXT):
        return function_of(function)(StringInputStream(str(input)))
    if isinstance(input, Pathname):
        return call_with_input_file(input, function, **more)
    return function_of(function)(input_stream(input))


def call_with_output_file(path: Any, thunk: Any, *, if_exists: Any = keyword("ERROR"), **options: Any) -> Any:
    """``uiop:call-with-output-file``: the values of ``thunk`` of a stream to the file; options: those of ``open``."""
    return with_open_file(
        function_of(thunk),
        path,
        **{"direction": keyword("OUTPUT"), "if_does_not_exist": keyword("CREATE"), "if_exists": if_exists, **options},
    )


def call_with_input_file(path: Any, thunk: Any, *, if_does_not_exist: Any = keyword("ERROR"), **options: Any) -> Any:
    """``uiop:call-with-input-file``: the values of ``thunk`` of a stream from the file; options: those of ``open``."""
    return with_open_file(function_of(thunk), path, **{"direction": keyword("INPUT"), "if_does_not_exist": if_does_not_exist, **options})


def call_with_null_output(function: Any, *, element_type: Any = None, **options: Any) -> Any:
    """``uiop:call-with-null-output``: the values of ``function`` of a stream that forgets what is written."""
    from ..streams.stream_functions import make_broadcast_stream

    return function_of(function)(make_broadcast_stream())


def call_with_null_input(function: Any, *, element_type: Any = None, **options: Any) -> Any:
    """``uiop:call-with-null-input``: the values of ``function`` of a stream at its end."""
    return function_of(function)(StringInputStream(""))


def output_string(string: Any, stream: Any = None) -> Any:
    """``uiop:output-string``: write the text to a stream; without one, the text."""
    return call_with_output(stream, lambda target: target.write(str(string)))


def input_string(input: Any = None) -> Any:
    """``uiop:input-string``: the text that is left in a stream, or of a file."""
    return call_with_input(input, slurp_stream_string)


def println(thing: Any, stream: Any = True) -> None:
    """``uiop:println``: `princ` and an end of line."""
    target = STANDARD_OUTPUT.value if stream is True else stream
    princ(thing, target)
    terpri(target)
    finish_output(target)


def writeln(thing: Any, *, stream: Any = True, **keys: Any) -> None:
    """``uiop:writeln``: `prin1` and an end of line."""
    target = STANDARD_OUTPUT.value if stream is True else stream
    prin1(thing, target)
    terpri(target)
    finish_output(target)


def format_at_once(stream: Any, control: Any, *arguments: Any) -> Any:
    """``uiop:format!``: ``format``, with what was written before and what it writes brought out at once."""
    finish_outputs(stream)
    try:
        return format_(stream, control, *arguments)
    finally:
        finish_outputs(stream)


def finish_outputs(*streams: Any) -> MultipleValues:
    """``uiop:finish-outputs``: ``finish-output`` of the standard streams and those that are given."""
    for each in (STANDARD_OUTPUT.value, ERROR_OUTPUT.value, *streams):
        if hasattr(each, "write"):
            finish_output(each)
    return MultipleValues(())


def eval_input(input: Any) -> Any:
    """``uiop:eval-input``: the values of the last form that is left in a stream, or of a text; all are evaluated."""
    result = None

    def all_forms(stream: Any) -> None:
        nonlocal result
        while (form := read(stream, None, NOTHING)) is not NOTHING:
            result = evaluate(form)

    call_with_input(input, all_forms)
    return result


def load_from_string(string: Any) -> bool:
    """``uiop:load-from-string``: evaluate the forms of a text. Returns T."""
    eval_input(str(string))
    return True


def file_stream_p(stream: Any) -> Any:
    """``uiop:file-stream-p``: whether it is a stream to or from a file of the system."""
    return True if getattr(stream, "pathname", None) is not None or getattr(stream, "lisp_name", "") == "SB-SYS::FD-STREAM" else None
