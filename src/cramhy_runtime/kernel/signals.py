"""Signals: how the system asks a process to end, and how the kernel reacts.

SIGINT (Ctrl-C) interrupts the main task. SIGTERM, SIGHUP (the terminal was closed), SIGQUIT, and SIGBREAK on Windows end the process:
the main task unwinds, plans end through their cleanup forms, so a robot gets its stop command, and the services of plans are closed.
The exit status is 128 + the signal's number, as in a shell. A signal that the process ignores (``nohup``), or that other code handles,
is left alone.

A handler runs between any two instructions of the main thread. So it raises nothing: it puts a message into the inbox
(`Kernel.interrupt`, `Kernel.terminate`), and the main task gets it at its next park point or checkpoint. There are two exceptions. A
blocking call of the main task in `run_blocking` is broken off. And if the message is not read for a second, the main thread computes, or
waits, in code that does not know the kernel; then the next signal raises an exception there, as Python's own handler does.

A program must end even if a plan does not. So the first signal that ends it starts a thread that watches (`watch`). After a second the
thread sends the signal again to a main thread that has not reacted. After the limit of cleanup it abandons cleanup. If the kernel does
not stop soon after that, it names the task at fault, closes the services of plans, and ends the process.
"""

import _signal  # below `signal`, whose enumerations would take half of the time in which a kernel starts
import os
import signal
import sys
import threading
import time
from contextlib import contextmanager

from . import images, reports, uncaught
from .budget import budget
from .errors import Interrupted, Terminated

ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGBREAK") if hasattr(signal, name))
"""The signals that end a process."""
_HEARD = tuple(map(int, (signal.SIGINT, *ENDING)))

DEAF = 1.0  # s after which a main thread that has not read a message is taken to compute outside of the kernel
FORCE = 2.0  # s that a process gets to end after its cleanup was given up
LAST = 2.0  # s that what serves plans gets to be closed when the process is ended by force
LOOK = 0.05  # s between two looks

_kernels = []  # (image, kernel) of those that listen, the innermost last
_before = {}  # the handlers that stood there before ours
_held = 0  # how many programs keep our handlers between kernels
_program = None  # the process of these programs

received = []
"""The numbers of the signals that have asked this process to end, in order."""

leaving = threading.Event()
"""Set when the main program is over and Python starts no more threads."""

restore_terminal = []
"""Functions that restore the terminal. They are called when a process is ended by force."""


def listen(kernel):
    """Let KERNEL handle signals from now on. Only Python's main thread gets signals, so in other threads this does nothing."""
    if threading.current_thread() is threading.main_thread():
        _kernels.append((images.entered_by_main_thread(), kernel))
        _install()


def forget(kernel):
    """Let the kernel before KERNEL, which has stopped, handle signals again, or else the handlers from before."""
    listening = len(_kernels)
    _kernels[:] = [each for each in _kernels if each[1] is not kernel]
    if len(_kernels) < listening:
        _restore()


def listening_images():
    """The images with a kernel that handles signals, without those in which another thread acts."""
    return list(dict.fromkeys(image for image, _ in _kernels if image.may_be_entered()))


def _forget_parent():
    """Restore the handlers from before in a forked child, which has none of its parent's tasks to end."""
    _kernels.clear()
    _restore()


images.in_forked_child(_forget_parent)


@contextmanager
def held():
    """Handle signals during the block between kernels, too, so that a program ends in order before and after its session."""
    global _held, _program
    _held += 1
    _program = os.getpid()
    _install()
    try:
        yield
    finally:
        _held -= 1
        _restore()


def answered():
    """Note that the program has done what the signals asked for: its exit status is its own. For programs that run until they are
    ended."""
    received.clear()
    for _, kernel in _kernels:
        kernel.ended_by = None


def _install():
    uncaught.install()
    for number in _HEARD:
        if number not in _before:
            handler = _signal.getsignal(number)
            if handler is signal.default_int_handler or handler == signal.SIG_DFL:
                _signal.signal(number, _hear)
                _before[number] = handler


def _restore():
    if _kernels or (_held and os.getpid() == _program) or threading.current_thread() is not threading.main_thread():
        return
    for number, handler in _before.items():
        if _signal.getsignal(number) is _hear:
            _signal.signal(number, handler)
    _before.clear()


def end_as_interrupted():
    """If the main program did not catch Ctrl-C, end the process by the signal, as Python does. It is the last call of a process."""
    if uncaught.ended_by_interrupt():
        end_by(signal.SIGINT)


def end_by(number):
    """End the process by the signal NUMBER itself. Call this as the last thing, in the main thread."""
    _flush()
    if threading.current_thread() is threading.main_thread():
        signal.signal(number, signal.SIG_DFL)
        signal.raise_signal(number)


def _listener():
    """The kernel that gets signals: the innermost one of the image in which the main thread acts. The kernel of an image that was left
    does not run, and would never read a message."""
    here = images.entered_by_main_thread()
    return next((kernel for image, kernel in reversed(_kernels) if image is here), None)


def _hear(number, frame):
    kernel = _listener()
    if number != signal.SIGINT:
        received.append(number)
    if kernel is None or kernel.stopped:
        raise KeyboardInterrupt if number == signal.SIGINT else Terminated(number)
    again = kernel in _reminded
    _reminded.discard(kernel)
    if kernel.deaf_for() >= DEAF and _runs_here(kernel):
        if kernel.current.carrier is not None:  # and not a callback: the main task hears of that one itself
            kernel.take_back()
        if number == signal.SIGINT:
            raise Interrupted
        kernel.will_end(number)
        raise Terminated(number)
    if number == signal.SIGINT:
        kernel.interrupt()
    elif not again:
        kernel.terminate(number)


def _runs_here(kernel):
    """Whether the task or callback with the baton surely runs in this thread, and may be broken off."""
    if kernel.stops:  # what serves plans is being closed, and has its time
        return False
    carrier = kernel.current.carrier
    return kernel.backend.calls_back if carrier is None else carrier.ident == threading.get_ident()


_reminded = set()  # kernels to whose main thread `watch` sends the signal once more: that does not count as a second one


def watch(kernel, number):
    """Make sure that the process ends, after KERNEL was told of the signal NUMBER."""
    try:
        threading.Thread(target=_watch, args=(kernel, number), name="cramhy ends", daemon=True).start()
    except RuntimeError:
        pass  # no more threads: the limit of cleanup by the kernel's clock is left


def _watch(kernel, number):
    limit = kernel.cleanup_limit
    began = time.monotonic()

    def over(seconds):
        """Wait until SECONDS after BEGAN. Returns whether the kernel has stopped by then."""
        while not kernel.stopped and time.monotonic() < began + seconds:
            time.sleep(LOOK)
        return kernel.stopped

    if over(DEAF + LOOK):
        return
    if kernel.deaf_for() >= DEAF:
        _reminded.add(kernel)
        _send_to_main_thread(number)
    if limit is None or over(limit):
        return
    kernel.post(kernel.give_up)
    budget.end()
    while not over(limit + FORCE):
        if kernel.cleanup_began() is None or kernel.cleanup_began() <= began:
            return _end_by_force(kernel, number)
        began = kernel.cleanup_began()  # what runs beside the plan cleans up after it, and has as long again


@contextmanager
def interrupted_after(seconds, kernel):
    """Interrupt the main task of KERNEL if the block takes longer than SECONDS of wall time. Yields an event that is set then.

    A thread watches the time, because only the main thread gets SIGALRM, and Windows has no such signal. If the system gives no more
    threads, the block is not limited.
    """
    late, over = threading.Event(), threading.Event()

    def look_on():
        if not over.wait(seconds):
            late.set()
            kernel.interrupt()

    watcher = threading.Thread(target=look_on, name="cramhy limit", daemon=True)
    try:
        watcher.start()
    except RuntimeError:
        pass
    try:
        yield late
    finally:
        over.set()


def _send_to_main_thread(number):
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident, number)
    else:
        import _thread

        _thread.interrupt_main(number)


def _end_by_force(kernel, number):
    """End the process, because the task with the baton does not give it away."""
    task = kernel.current
    name = "The program" if task.carrier is None else task.name

    def say():
        reports.tell(
            f"{name} did not come to a point where it can be ended within {kernel.cleanup_limit + FORCE:g} s after "
            f"{signal.Signals(number).name}, so the process ends without its cleanup. A long computation in Python should call "
            "kernel.checkpoint() now and then, and a call that blocks belongs into kernel.run_blocking."
        )

    for last in (kernel.close_what_serves, say, _flush, *restore_terminal):  # each may be stuck, as on a pipe that nobody reads
        helper = threading.Thread(target=last, daemon=True)
        helper.start()
        helper.join(LAST)
    os._exit(128 + number)


def _flush():
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (OSError, ValueError, AttributeError):
            pass  # nobody reads it, or there is none
