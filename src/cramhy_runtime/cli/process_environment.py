"""What a process finds around it when it starts, and what it does when a part of that is missing or fails.

A program may be started without standard streams, with a disk that is full behind its output, with an encoding that has no sign for what
it prints, in a folder that has been removed, or with limits too small for it. `in_any_surroundings` wraps the command line, so that each
of these either works or is told in one line, and the plans of the session end through their cleanup.

A stream that is closed at the start becomes ``/dev/null``: input has ended, output is dropped. Its number must not stay free, because the
next file that is opened would get it, and a recording would receive what a library prints. Output that cannot be written any more is
dropped, and ends the program with the status 1, as a signal ends it: the main task hears of it at its next checkpoint. The task that
prints goes on, since a cleanup form may print before it stops the robot. Signs that the encoding of the output lacks are written as
``\\u2192``, and bytes of file names that are no text as they are.
"""

from __future__ import annotations

import codecs
import errno
import functools
import io
import os
import select
import signal
import sys

SHOWN = "cramhy-shown"
"""Name of the error handler for encodings."""
NO_MEMORY = "the system gives no more memory (ulimit -v). Raise the limit, or end other programs."
NO_THREADS = (
    "the system gives no more threads, or no memory for their stacks (ulimit -u, ulimit -v). Raise the limit, or end other programs."
)
NO_FILES = "too many files are open (ulimit -n). Raise the limit, or close other programs."
AT_ONCE = 4096
"""Bytes that a pipe takes whole if it takes any (PIPE_BUF of pipe(7))."""
LOOK, PATIENCE = 0.05, 1.0  # s between two looks whether there is room; s to wait for room when the process shall end
_STREAMS = (("stdin", "r"), ("stdout", "w"), ("stderr", "w"))


class OutputLost(SystemExit):
    """Standard output cannot be written any more, and no session runs that could be ended in order."""

    def __init__(self):
        super().__init__(1)


class MemoryLost(SystemExit):
    """The system gives no more memory, which the user has been told."""

    def __init__(self):
        super().__init__(1)


class Output(io.FileIO):
    """A standard output stream below its buffers. ``lost``: the `OSError` after which everything is dropped, or ``None``.

    ends_program: whether that ends the program; the command line takes it back when nothing can be ended any more.
    """

    def __init__(self, descriptor, ends_program):
        super().__init__(descriptor, "w", closefd=False)
        self.ends_program, self.lost = ends_program, None

    def write(self, data):
        """Write all of ``data``. It waits for a reader that is slow, but not for one that does not read while the process shall end."""
        data = memoryview(data).cast("B")
        rest = data
        while rest and self.lost is None:
            try:
                self._wait_for_room()
                written = super().write(rest[:AT_ONCE])
                rest = rest[written or 0 :]
            except OSError as problem:
                self.lost = problem
                if self.ends_program:
                    _end_program()
        return len(data)

    def _wait_for_room(self):
        """Return when `AT_ONCE` bytes can be written without a wait, as far as the system can tell."""
        waited = 0.0
        while not self._has_room():
            waited += LOOK
            if waited > PATIENCE and _is_ending():
                raise OSError(errno.EPIPE, "nobody reads it")

    def _has_room(self):
        try:
            return bool(select.select([], [self], [], LOOK)[1])
        except (OSError, ValueError):  # only sockets can be waited for, or the number is too high
            return True


def _is_ending():
    from cramhy_runtime import kernel

    session = kernel.active()
    return session is not None and session.ended_by is not None


def _end_program():
    from cramhy_runtime import kernel

    session = kernel.active()
    if session is None or session.stopped:
        raise OutputLost from None
    if session.ended_by is None:
        session.terminate(getattr(signal, "SIGPIPE", signal.SIGTERM))


def in_any_surroundings(command):
    """Decorate the function ``command`` of a program, which returns the exit status, so that it can be run anywhere; see the module."""

    @functools.wraps(command)
    def run(*arguments):
        _prepare()
        try:
            status = command(*arguments)
            sys.stdout.flush()
        except OutputLost:
            status = 1
        except MemoryLost:
            status = _end_at_once()
        except Exception as problem:
            at_once = _tell_if_missing(problem)
            if at_once is None:
                raise
            status = _end_at_once() if at_once else 1
        return _finish(status)

    return run


def ends_if_missing(start):
    """Decorate the function ``start``, which begins a session: that the system gives too little for it is told, and ends the program."""

    @functools.wraps(start)
    def run(*arguments, **options):
        try:
            return start(*arguments, **options)
        except Exception as problem:
            at_once = _tell_if_missing(problem)
            if at_once is None:
                raise
            raise (MemoryLost() if at_once else SystemExit(1)) from None

    return run


def _tell_if_missing(problem):
    """Tell the user that the system gives too little, if ``problem`` says so: whether the process must end at once, else ``None``."""
    line = missing(problem)
    if line is None:
        return None
    _say(line)
    return line in (NO_MEMORY, NO_THREADS)


def _end_at_once():
    """End the process with the status 1 as it is. Python, which would clear its modules, prints hundreds of lines without memory."""
    try:
        _finish(1)
        sys.stderr.flush()
    finally:
        os._exit(1)


def check_for_session(backend):
    """End the program, with a line for the user, when no session can begin here, or none with this back end."""
    if (problem := working_folder()) is not None:
        _end(problem, 2)
    if backend == "greenlet":
        from . import servers

        try:
            servers.require("greenlet", "--backend greenlet")
        except servers.NotPossible as problem:
            _end(problem, 2)


def _end(line, status):
    _say(line)
    sys.exit(status)


def _say(line):
    print(f"cramhy: {line}", file=sys.stderr)


def working_folder():
    """Why the working folder cannot be used, as a line for the user; ``None`` when it can."""
    try:
        os.getcwd()
    except OSError as problem:
        return (
            f"the folder that this program was started in cannot be found ({problem.strerror}): it has been removed or may not be "
            "entered. Change to another one, with cd, and start again."
        )


def missing(problem):
    """One line about an exception that says that the system gives too little; ``None`` for any other."""
    try:
        return _missing(problem)
    except MemoryError:
        return NO_MEMORY


def _missing(problem):
    from cramhy_runtime.kernel.errors import NoStack

    while problem is not None:
        text = str(problem)
        if isinstance(problem, NoStack) or isinstance(problem, RuntimeError) and "can't start new thread" in text:
            return NO_THREADS
        if isinstance(problem, MemoryError) or _has_number(problem, errno.ENOMEM):
            return NO_MEMORY
        if isinstance(problem, ImportError) and "failed to map segment" in text:
            return NO_MEMORY
        if isinstance(problem, SystemError) and "without" in text and "exception" in text:  # Python's import when memory ends within it
            return NO_MEMORY
        if _has_number(problem, errno.EMFILE, errno.ENFILE):
            return NO_FILES
        problem = problem.__cause__ or problem.__context__
    return None


def _has_number(problem, *numbers):
    return isinstance(problem, OSError) and problem.errno in numbers


def _prepare():
    """Make the standard streams such that they can be used; those that tests or others put there are left alone."""
    codecs.register_error(SHOWN, _shown)
    if os.name == "posix":
        _occupy()
    for number, (name, mode) in enumerate(_STREAMS):
        stream = getattr(sys, name)
        if stream is None:  # it was closed at the start
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))
        elif stream is getattr(sys, f"__{name}__") and isinstance(stream, io.TextIOWrapper):
            errors = "surrogateescape" if mode == "r" else SHOWN
            if mode == "w" and os.name == "posix":
                setattr(sys, name, _watched(stream, number))
            elif stream.errors == "strict":
                stream.reconfigure(errors=errors)


def _occupy():
    """Put ``/dev/null`` wherever one of the numbers 0, 1 and 2 is free."""
    for number in range(len(_STREAMS)):
        try:
            os.fstat(number)
        except OSError:
            opened = os.open(os.devnull, os.O_RDWR)
            if opened != number:
                os.dup2(opened, number)
                os.close(opened)
            os.set_inheritable(number, True)


def _watched(stream, number):
    """A text stream as ``stream``, above an `Output`."""
    raw = Output(number, ends_program=number == 1)
    unbuffered = stream.write_through
    return io.TextIOWrapper(
        raw if unbuffered else io.BufferedWriter(raw),
        encoding=stream.encoding,
        errors=SHOWN,
        newline="\n",
        line_buffering=stream.line_buffering or raw.isatty(),
        write_through=unbuffered,
    )


def _shown(problem):
    """The error handler: bytes of a file name that are no text become these bytes again, other signs an escape."""
    if not isinstance(problem, UnicodeEncodeError):
        raise problem
    sign = problem.object[problem.start]
    if "\udc80" <= sign <= "\udcff":
        return bytes([ord(sign) - 0xDC00]), problem.start + 1
    escaped, _ = codecs.backslashreplace_errors(UnicodeEncodeError(problem.encoding, sign, 0, 1, problem.reason))
    return escaped, problem.start + 1


def _finish(status):
    """Write what is left. The exit status: that of the program, or 1 if output was lost, which is told."""
    output = getattr(getattr(sys.stdout, "buffer", None), "raw", getattr(sys.stdout, "buffer", None))
    if not isinstance(output, Output):
        return status
    output.ends_program = False  # what is written from now on, when the interpreter ends, is dropped if need be
    sys.stdout.flush()
    if output.lost is None:
        return status
    if output.lost.errno != errno.EPIPE:  # whoever reads only the beginning wants to hear nothing of that
        _say(
            f"standard output cannot be written: {output.lost.strerror}. Later output is lost. Make room there, or send the "
            "output elsewhere."
        )
    from cramhy_runtime.kernel import signals

    return status if signals.received else 1
