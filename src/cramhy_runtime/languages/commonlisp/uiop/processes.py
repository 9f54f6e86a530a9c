"""UIOP's functions that run programs of the operating system (UIOP's manual, "Launch program" and "Run program").

A task that waits for a program parks, as one that waits for a message: others go on meanwhile.
"""

from __future__ import annotations

import os
import subprocess

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import Error, SimpleFileError
from cramhy_runtime.lisp_core.conditions import error, restart_case
from cramhy_runtime.lisp_core.data import Cons, FreshString, MultipleValues, boolean, list_from, truth
from cramhy_runtime.lisp_core.packages import keyword, sym, symbol_name
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..files.files import path_of
from ..pathnames.pathname_objects import Pathname
from ..printer.printer import prin1_to_string
from ..python.python_calls import watch
from ..streams.basic_streams import FdStream, FileOutput, InputStream, StringInputStream, StringOutputStream
from .pathnames import parse_native_namestring
from .utilities import TEXT
from .streams import finish_outputs, slurp_input_stream, text_left, vomit_output_stream

if TYPE_CHECKING:
    from typing import IO

FUNCTIONS = """run-program launch-program wait-process terminate-process process-alive-p process-info-pid process-info-output
    process-info-input process-info-error-output subprocess-error-code subprocess-error-command subprocess-error-process
    escape-sh-token escape-sh-command escape-shell-token escape-shell-command easy-sh-character-p quit die"""
INTERACTIVE, OUTPUT, STREAM = keyword("INTERACTIVE"), keyword("OUTPUT"), keyword("STREAM")
EASY = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-_.,%@:/=")


class ProcessInfo:
    """A program that was started: its process, and the streams to and from it that were asked for."""

    lisp_name = "UIOP::PROCESS-INFO"

    def __init__(self, command: Any, process: subprocess.Popen[str]) -> None:
        self.command, self.process = command, process
        self.output = self.input = self.error_output = None


class ProgramText(InputStream, FdStream):
    """What a program writes, line by line."""

    def __init__(self, file: IO[str]) -> None:
        super().__init__()
        self._file = file

    def more(self) -> str:
        return kernel.run_blocking(self._file.readline)

    def close(self, abort: bool = False) -> None:
        super().close(abort)
        self._file.close()


class SubprocessError(Error):
    lisp_name = "UIOP::SUBPROCESS-ERROR"
    initargs = {"CODE": "code", "COMMAND": "command", "PROCESS": "process"}

    def __init__(self, code: Any = None, command: Any = None, process: Any = None, **slots: Any) -> None:
        super().__init__(**slots)
        self.code, self.command, self.process = code, command, process

    def report(self) -> str:
        told = "" if self.process is None else f" {prin1_to_string(self.process)}"
        return f"Subprocess{told} with command {prin1_to_string(self.command)} exited with error code {prin1_to_string(self.code)}"


def _words(command: Any) -> list[str]:
    """The program and its arguments: a text is one for the shell, as in UIOP."""
    if isinstance(command, TEXT):
        return ["/bin/sh", "-c", str(command)] if os.name == "posix" else ["cmd", "/c", str(command)]
    return [word if isinstance(word, TEXT) else os.fspath(word) for word in command]


def _started(command: Any, directory: Any, **streams: Any) -> subprocess.Popen[str]:
    if watch.function is not None:
        watch.function("subprocess")
    folder = path_of(directory) if directory is not None else path_of(Pathname()) or None
    words = _words(command)
    try:
        return subprocess.Popen([str(word) for word in words], cwd=folder, text=True, errors="replace", **streams)
    except OSError as problem:
        name = str(words[0])
        return error(SimpleFileError(parse_native_namestring(name), "Couldn't execute ~S: ~A", name, os.strerror(problem.errno or 0)))


def _redirected(designator: Any, writes: bool) -> Any:
    """What `subprocess` is told of a stream: nil is nothing, :interactive the console's own, a pathname a file, else a pipe."""
    if designator is None:
        return subprocess.DEVNULL
    if designator is INTERACTIVE:
        return None
    return open(path_of(designator), "a" if writes else "r") if isinstance(designator, Pathname) else subprocess.PIPE  # noqa: SIM115


def launch_program(
    command: Any, *, input: Any = None, output: Any = None, error_output: Any = None, directory: Any = None, **options: Any
) -> ProcessInfo:
    """``uiop:launch-program``: start a program and go on. Returns what the other functions take.

    input, output, error_output: nil, :interactive, a pathname, or :stream, which makes a stream for ``process-info-output`` and its like.
    """
    merged = subprocess.STDOUT if error_output is OUTPUT else _redirected(error_output, True)
    process = _started(command, directory, stdin=_redirected(input, False), stdout=_redirected(output, True), stderr=merged)
    made = ProcessInfo(command, process)
    made.output = process.stdout and ProgramText(process.stdout)
    made.error_output = process.stderr and ProgramText(process.stderr)
    made.input = process.stdin and FileOutput(process.stdin)
    return made


def wait_process(info: ProcessInfo) -> int:
    """``uiop:wait-process``: wait for the end of a program; its code, 128 and the signal's number if a signal ended it."""
    return _code(kernel.run_blocking(info.process.wait))


def _code(returned: int) -> int:
    return 128 - returned if returned < 0 else returned


def process_alive_p(info: ProcessInfo) -> bool | None:
    """``uiop:process-alive-p``"""
    return boolean(info.process.poll() is None)


def terminate_process(info: ProcessInfo, *, urgent: Any = None) -> None:
    """``uiop:terminate-process``: ask a program to end, or end it if that is ``urgent``."""
    if info.process.poll() is None:
        (info.process.kill if truth(urgent) else info.process.terminate)()


def process_info_pid(info: ProcessInfo) -> int:
    """``uiop:process-info-pid``"""
    return info.process.pid


def process_info_output(info: ProcessInfo) -> Any:
    """``uiop:process-info-output``: the stream from which what it writes is read."""
    return info.output


def process_info_error_output(info: ProcessInfo) -> Any:
    """``uiop:process-info-error-output``"""
    return info.error_output


def process_info_input(info: ProcessInfo) -> Any:
    """``uiop:process-info-input``: the stream to which what it reads is written."""
    return info.input


def subprocess_error_code(condition: Any) -> Any:
    """``uiop:subprocess-error-code``"""
    return condition.code


def subprocess_error_command(condition: Any) -> Any:
    """``uiop:subprocess-error-command``"""
    return condition.command


def subprocess_error_process(condition: Any) -> Any:
    """``uiop:subprocess-error-process``"""
    return condition.process


def run_program(
    command: Any,
    *,
    ignore_error_status: Any = None,
    force_shell: Any = None,
    input: Any = None,
    if_input_does_not_exist: Any = None,
    output: Any = None,
    if_output_exists: Any = None,
    error_output: Any = None,
    if_error_output_exists: Any = None,
    element_type: Any = None,
    external_format: Any = None,
    directory: Any = None,
    **options: Any,
) -> MultipleValues:
    """``uiop:run-program``: run a program to its end. Three values: its output and its error output as the arguments ask, and its code.

    command: a list of the program and its arguments, or a text for the shell. input: nil, a text's stream, a pathname, or what
    ``vomit-output-stream`` takes. output, error_output: nil, :interactive, :string, :lines, :form ... as for ``slurp-input-stream``;
    error_output may be :output. Errors: a `SubprocessError` if the code is not 0, unless ``ignore_error_status``.
    """
    given = _text_for(input)
    process = _started(
        command,
        directory,
        stdin=None if input is INTERACTIVE else subprocess.DEVNULL if given is None else subprocess.PIPE,
        stdout=None if output is INTERACTIVE else subprocess.DEVNULL if output is None else subprocess.PIPE,
        stderr=subprocess.STDOUT
        if error_output is OUTPUT
        else None
        if error_output is INTERACTIVE
        else subprocess.DEVNULL
        if error_output is None
        else subprocess.PIPE,
    )
    try:
        written, complained = kernel.run_blocking(lambda: process.communicate(given))
    finally:
        if process.poll() is None:  # the task was ended while it waited
            process.kill()
    results = [
        _first(slurp_input_stream(designator, StringInputStream(text))) if text is not None else None
        for designator, text in ((output, written), (error_output, complained))
    ]
    code = _code(process.returncode)
    if code != 0 and not truth(ignore_error_status):
        problem = SubprocessError(code, command, ProcessInfo(command, process))
        restart_case([(sym("CONTINUE"), lambda: None, "IGNORE-ERROR-STATUS")], lambda: error(problem))
    return MultipleValues((*results, code))


def _first(value: Any) -> Any:
    return value[0] if isinstance(value, MultipleValues) else value


def _text_for(input: Any) -> str | None:
    if input is None or input is INTERACTIVE:
        return None
    if isinstance(input, (*TEXT, Pathname)):
        with open(path_of(input), encoding="utf-8", errors="replace") as file:
            return file.read()
    if isinstance(input, Cons) or callable(input):
        target = StringOutputStream()
        if isinstance(input, Cons):
            options = list(input.cdr or ())
            vomit_output_stream(input.car, target, **dict(zip(map(symbol_name, options[::2]), options[1::2])))
        else:
            vomit_output_stream(input, target)
        return target.text()
    return text_left(input)


# ------------------------------------------------------------------------------------------------------- the shell's words


def easy_sh_character_p(character: Any) -> bool | None:
    """``uiop:easy-sh-character-p``: whether the shell takes the character as it is."""
    return boolean(str(getattr(character, "char", character)) in EASY)


def escape_sh_token(token: Any, stream: Any = None) -> Any:
    """``uiop:escape-sh-token``: the text as one word of the shell."""
    text = str(token)
    if text and all(char in EASY for char in text):
        return _told(text, stream)
    return _told('"' + "".join("\\" + char if char in '"\\$`' else char for char in text) + '"', stream)


def escape_sh_command(command: Any, stream: Any = None) -> Any:
    """``uiop:escape-sh-command``: a list of words as a line of the shell."""
    return _told(str(command) if isinstance(command, TEXT) else " ".join(str(escape_sh_token(word)) for word in command), stream)


def _told(text: str, stream: Any) -> Any:
    from .streams import output_string

    return FreshString(text) if stream is None else output_string(text, stream)


escape_shell_token, escape_shell_command = escape_sh_token, escape_sh_command


def quit_(code: Any = 0, finish_output: Any = True) -> Any:
    """``uiop:quit``: end the session."""
    if truth(finish_output):
        finish_outputs()
    raise SystemExit(code)


def die(code: Any, control: Any, *arguments: Any) -> Any:
    """``uiop:die``: write a message to ``*error-output*`` and end the session."""
    from ..format.format import format_
    from ..streams.streams import ERROR_OUTPUT

    format_(ERROR_OUTPUT.value, "~&~?~&", control, list_from(arguments))
    return quit_(code)
