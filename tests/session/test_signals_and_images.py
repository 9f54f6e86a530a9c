"""Signals in a program with several images: each is heard by the one that the main thread is in, and all clean up at the end.

Each program is a process of its own, since signals are a matter of processes. What it logs is on standard output.
"""

import signal
import subprocess
import sys

import pytest

PATIENCE = 30  # s; only a test that fails waits so long
BEGIN = """
import os, signal, sys, threading, time
from cramhy_runtime import kernel
from cramhy_runtime.session import Image

def send(number, after=0.2):
    def later():
        time.sleep(after)
        os.kill(os.getpid(), number)
    threading.Thread(target=later, daemon=True).start()

def plan(name):
    try:
        kernel.park("for ever")
    finally:
        with kernel.cleanup():
            kernel.sleep(0.01)
            print(name, "cleaned up", flush=True)

def driving(name):
    image = Image()
    with image.entered():
        image.start(clock="wall", cleanup_limit=5)
        kernel.spawn(plan, name)
        kernel.yield_()
    return image
"""


def run(program, number):
    """(status, lines of output, complaints) of a program."""
    done = subprocess.run(
        [sys.executable, "-c", BEGIN + program.format(number=int(number))], capture_output=True, text=True, timeout=PATIENCE
    )
    return done.returncode, done.stdout.splitlines(), done.stderr


def status_of(number):
    return 128 + number if number == signal.SIGTERM else -number  # as a shell says it; Python ends by SIGINT itself


@pytest.mark.soak
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_between_images_ends_the_program_at_once_and_all_clean_up(number):
    status, lines, complaints = run(
        """
kept = [driving("one"), driving("two")]
send({number})
began = time.monotonic()
try:
    time.sleep(200)
finally:
    print("at once" if time.monotonic() - began < 100 else "late", flush=True)
""",
        number,
    )
    assert lines == ["at once", "one cleaned up", "two cleaned up"], complaints
    assert status == status_of(number), complaints


@pytest.mark.soak
def test_an_interrupt_is_heard_by_the_image_that_the_main_thread_is_in_and_the_others_go_on():
    status, lines, complaints = run(
        """
other, mine = driving("other"), driving("mine")
try:
    with mine.entered():
        send({number})
        kernel.sleep(20)
except KeyboardInterrupt:
    print("heard", flush=True)
mine.close()
with other.entered():
    kernel.sleep(0.01)
    print("the other goes on", flush=True)
other.close()
""",
        signal.SIGINT,
    )
    assert lines == ["heard", "mine cleaned up", "the other goes on", "other cleaned up"], complaints
    assert status == 0, complaints


@pytest.mark.soak
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_while_another_thread_has_the_turn(number):
    """The current image is the other thread's; the message is for the plan of the main thread, which waits for its turn."""
    status, lines, complaints = run(
        """
def busy():
    with Image() as image:
        image.start(clock="wall")
        while not ended.is_set():
            kernel.sleep(0.001)
ended = threading.Event()
helper = threading.Thread(target=busy)
mine = driving("mine")
with mine.entered():
    helper.start()
    send({number}, 0.5)
    try:
        kernel.sleep(20)
    finally:
        print("heard", flush=True)
        ended.set()
""",
        number,
    )
    assert lines == ["heard", "mine cleaned up"], (lines, complaints)
    assert status == status_of(number), complaints
