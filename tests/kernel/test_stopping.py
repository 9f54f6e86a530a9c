"""Stopping a kernel, and starting the next: nothing is left behind."""

import subprocess
import sys

import pytest
from outside_world import Event
from systems import IN_WEBASSEMBLY, needs_processes

from cramhy_runtime import kernel
from cramhy_runtime.extras import install_command
from cramhy_runtime.kernel.backends import threads


def wait_for_the_end(log):
    """The body of a task that is ended; it notes its cleanup."""
    try:
        kernel.park("for ever")
    finally:
        log.append("cleaned up")


def test_stop_cancels_the_tasks_and_lets_them_clean_up(k):
    log = []

    def body():
        try:
            kernel.park("for ever")
        finally:
            kernel.sleep(0.5)
            log.append("cleaned up")

    task = kernel.spawn(body)
    kernel.yield_()
    kernel.stop()
    assert log == ["cleaned up"]
    assert task.dead
    assert kernel.active() is None


def test_what_serves_the_tasks_is_closed_when_they_have_cleaned_up_and_the_last_first(k):
    log = []

    def begin_something():
        kernel.spawn(lambda: kernel.park("until it is abandoned"))
        log.append("second")

    kernel.spawn(wait_for_the_end, log)
    kernel.yield_()
    k.at_stop(lambda: log.append("first"))
    k.at_stop(begin_something)
    kernel.stop()
    assert log == ["cleaned up", "second", "first"]
    assert k.tasks == [k.main]


def test_one_that_cannot_be_closed_is_told_and_the_others_are(k, capsys):
    log = []
    k.at_stop(lambda: log.append("closed"))
    k.at_stop(lambda: 1 / 0)
    kernel.stop()
    assert log == ["closed"] and kernel.active() is None
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_start_stops_the_kernel_before(start):
    start()
    task = kernel.spawn(kernel.park, "for ever")
    kernel.yield_()
    start()
    assert task.dead
    assert kernel.now() == 0.0


def test_cleanup_that_never_ends_is_abandoned(k):
    log = []

    def body():
        try:
            kernel.park("for ever")
        finally:
            try:
                kernel.park("for ever, too")
            finally:
                log.append("left")

    task = kernel.spawn(body)
    kernel.yield_()
    kernel.stop()
    assert log == ["left"]
    assert task.dead


def test_cleanup_that_is_busy_for_ever_is_abandoned(k):
    def body():
        try:
            kernel.park("for ever")
        finally:
            while True:
                kernel.checkpoint()

    task = kernel.spawn(body)
    kernel.yield_()
    kernel.stop()
    assert task.dead


def test_a_task_that_swallows_everything_does_not_hold_up_the_end(k):
    def undead():
        while True:
            try:
                kernel.park("nothing")
            except BaseException:
                pass

    kernel.spawn(undead)
    kernel.yield_()
    kernel.stop()
    assert kernel.active() is None


def test_cleanup_that_spawns_without_end_does_not_hold_up_the_end(k):
    def hydra():
        try:
            kernel.park("for ever")
        finally:
            kernel.spawn(hydra)

    kernel.spawn(hydra)
    kernel.yield_()
    kernel.stop()
    assert kernel.active() is None


def test_a_blocking_call_that_does_not_return_is_left_behind(start, monkeypatch):
    monkeypatch.setattr("cramhy_runtime.kernel.scheduler.PATIENCE", 1)
    start()
    released = Event()
    kernel.spawn(kernel.run_blocking, released.wait, 10)
    kernel.settle()
    kernel.stop()
    assert kernel.active() is None
    released.set()


def test_only_the_main_task_can_stop(k):
    task = kernel.spawn(kernel.stop)
    task.join()
    assert str(task.exception) == "Only the main task can stop the kernel, or start another one in its place."


def test_a_kernel_that_could_not_start_leaves_none_active(start):
    start()
    with pytest.raises(ValueError):
        kernel.start(clock="sundial")
    assert kernel.active() is None


def test_stop_twice_is_stop_once(k):
    k.stop()
    k.stop()
    kernel.stop()


def test_requests_to_the_main_task_do_not_disturb_the_end(k):
    log = []

    kernel.spawn(wait_for_the_end, log)
    kernel.yield_()
    kernel.current().cancel()
    kernel.stop()
    assert log == ["cleaned up"]


def test_hundreds_of_kernels_leave_no_threads_behind(start):
    def round_():
        start()
        tasks = [kernel.spawn(kernel.park, "for ever") for _ in range(5)]
        kernel.settle()
        return tasks

    for _ in range(10):
        round_()
    idle = len(threads._idle)
    for _ in range(200):
        round_()
    assert len(threads._idle) <= idle + 5


def test_a_finished_task_is_not_kept_alive_by_the_kernel(k):
    import gc
    import weakref

    ref = weakref.ref(kernel.spawn(lambda: None))
    kernel.settle()
    gc.collect()
    assert ref() is None


@needs_processes
@pytest.mark.parametrize("clock", ["virtual", "wall"])
def test_a_script_that_just_ends_runs_the_cleanup_of_its_tasks(backend, clock):
    script = f"""
from cramhy_runtime import kernel
kernel.start(backend={backend!r}, clock={clock!r})
def body():
    try:
        kernel.park("for ever")
    finally:
        print("cleaned up")
kernel.spawn(body)
kernel.yield_()
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr, done.returncode) == ("cleaned up\n", "", 0)


@needs_processes
def test_loading_the_kernel_does_not_load_greenlet():
    script = "import sys; from cramhy_runtime import kernel; kernel.start(backend='threads'); print('greenlet' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert done.stdout == "False\n"


@needs_processes
@pytest.mark.parametrize("installed", [True, False])
def test_greenlets_are_the_back_end_where_they_are_installed(installed):
    """Of a kernel, a session, a plan in Python and a test of a plan, if nothing else is said."""
    pytest.importorskip("greenlet")
    script = f"""
import sys
if not {installed}:
    sys.modules["greenlet"] = None
from cramhy_runtime import cpl, kernel, testing
from cramhy_runtime.repl.session import Session
def told():
    print(type(kernel.active().backend).__name__)
kernel.start()
told()
cpl.run(told, clock="virtual")
testing.run(told)
Session()
told()
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert (done.stdout.split(), done.stderr) == (["GreenletBackend" if installed else "ThreadBackend"] * 4, "")


@pytest.mark.skipif(IN_WEBASSEMBLY, reason="there it is the back end")
def test_outside_of_webassembly_its_back_end_says_what_it_needs():
    with pytest.raises(ImportError) as missing:
        kernel.start(backend="jspi")
    assert str(missing.value) == (
        'The back end "jspi" needs Pyodide, with the file stacks.mjs given to it as the module cramhy_host. Choose "auto", "threads" or "greenlet".'
    )


@needs_processes
def test_without_greenlet_the_back_end_says_what_to_install():
    script = """
import sys
sys.modules["greenlet"] = None
from cramhy_runtime import kernel
try:
    kernel.start(backend="greenlet")
except ImportError as missing:
    print(missing)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert done.stdout == (
        'The back end "greenlet" needs the package greenlet, which is not installed. '
        f'Use the back end "threads", or type: {install_command("fast")}\n'
    )
