"""Cancellation: a request to end reaches its task once, and cleanup runs undisturbed (laws 1 and 2)."""

import pytest

from cramhy_runtime import kernel


class Recorder:
    """A task body that notes how it ended."""

    def __init__(self, body):
        self.body = body
        self.log = []

    def __call__(self):
        try:
            self.body()
            self.log.append("returned")
        except kernel.Cancelled as cancelled:
            self.log.append(str(cancelled))
            raise


def test_a_parked_task_is_woken_by_the_request(k):
    body = Recorder(lambda: kernel.park("for ever"))
    task = kernel.spawn(body)
    kernel.yield_()
    task.cancel("enough")
    assert not task.dead
    task.join()
    assert body.log == ["cancelled: enough"]
    assert task.dead
    assert task.cancelled_delivered
    assert isinstance(task.exception, kernel.Cancelled)
    assert task.exception.reason == "enough"


def test_a_sleeping_task_is_woken_at_once(k):
    task = kernel.spawn(kernel.sleep, 1000)
    kernel.sleep(1)
    task.cancel()
    task.join()
    assert kernel.now() == 1.0


def test_a_busy_task_gets_it_at_a_checkpoint(k):
    def busy():
        while True:
            kernel.checkpoint()

    task = kernel.spawn(busy)
    kernel.yield_()
    task.cancel()
    task.join()
    assert task.cancelled_delivered


def test_a_task_that_never_ran_never_runs(k):
    log = []
    task = kernel.spawn(log.append, "ran")
    task.cancel("not needed")
    task.join()
    assert log == []
    assert task.cancelled_delivered
    assert str(task.exception) == "cancelled: not needed"


def test_it_is_delivered_once_and_cleanup_can_wait(k):
    log = []

    def body():
        try:
            kernel.park("for ever")
        finally:
            log.append("stop the turtle")
            kernel.sleep(2)
            for _ in range(5000):
                kernel.checkpoint()
            kernel.yield_()
            log.append("stopped")

    task = kernel.spawn(body)
    kernel.yield_()
    task.cancel("first")
    kernel.sleep(1)
    task.cancel("second")
    task.join()
    assert log == ["stop the turtle", "stopped"]
    assert task.exception.reason == "first"


def test_a_task_that_catches_the_request_goes_on(k):
    def stubborn():
        try:
            kernel.park("for ever")
        except kernel.Cancelled:
            kernel.sleep(1)
        return "done"

    task = kernel.spawn(stubborn)
    kernel.yield_()
    task.cancel()
    assert task.join() == "done"
    assert task.exception is None


def test_the_request_may_bring_its_own_exception(k):
    class Evaporated(BaseException):
        pass

    for reason in (Evaporated(), Evaporated, lambda: Evaporated("now")):
        task = kernel.spawn(kernel.park, "for ever")
        kernel.yield_()
        task.cancel(reason)
        task.join()
        assert isinstance(task.exception, Evaporated)


def test_an_exception_that_was_asked_for_is_not_reported(k, reported):
    class Evaporated(BaseException):
        pass

    for reason in (Evaporated, None):
        task = kernel.spawn(kernel.park, "for ever")
        kernel.yield_()
        task.cancel(reason)
    kernel.settle()
    assert reported == []


def test_a_task_can_ask_itself_to_end(k):
    log = []

    def body():
        kernel.current().cancel("myself")
        log.append("not yet")
        kernel.checkpoint()
        log.append("never")

    task = kernel.spawn(body)
    task.join()
    assert log == ["not yet"]
    assert task.exception.reason == "myself"


def test_a_request_to_a_dead_task_does_nothing(k):
    task = kernel.spawn(lambda: "result")
    task.join()
    task.cancel()
    assert task.result == "result"
    assert not task.cancelled


def test_a_shield_delays_delivery_to_its_end(k):
    log = []

    def body():
        with kernel.shield():
            kernel.sleep(2)
            with kernel.shield():
                kernel.yield_()
            log.append("inner shield left")
            for _ in range(3000):
                kernel.checkpoint()
            log.append("outer shield left")
        kernel.checkpoint()
        log.append("never")

    task = kernel.spawn(body)
    kernel.sleep(1)
    task.cancel()
    task.join()
    assert log == ["inner shield left", "outer shield left"]
    assert kernel.now() >= 2.0
    assert task.cancelled_delivered


def test_a_shield_may_be_taken_away_for_a_part_of_it(k):
    """The request arrives in that part, and what unwinds there is shielded again behind it. A cleanup keeps its own shield."""
    log = []

    def body():
        with kernel.shield():
            kernel.sleep(2)
            log.append("shielded")
            try:
                with kernel.cleanup(), kernel.unshielded():
                    kernel.sleep(1)
                    log.append("cleaned up")
                with kernel.unshielded():
                    kernel.sleep(1)
                    log.append("never")
            finally:
                kernel.sleep(1)
                log.append("shielded again")

    task = kernel.spawn(body)
    kernel.sleep(1)
    task.cancel()
    task.join()
    assert log == ["shielded", "cleaned up", "shielded again"]
    assert kernel.now() == 4


def test_without_a_shield_there_is_none_to_be_taken_away(k):
    with pytest.raises(kernel.KernelError, match="Task main has no shield that could be taken away."), kernel.unshielded():
        pass


def test_a_shield_that_nobody_knocked_at_changes_nothing(k):
    def body():
        with kernel.shield():
            kernel.sleep(1)
        kernel.checkpoint()
        return "through"

    assert kernel.spawn(body).join() == "through"


@pytest.mark.parametrize("point", ["park", "sleep", "yield_", "settle", "run_blocking"])
def test_every_park_point_delivers_before_it_parks(k, point):
    points = {
        "park": lambda: kernel.park("for ever"),
        "sleep": lambda: kernel.sleep(100),
        "yield_": kernel.yield_,
        "settle": kernel.settle,
        "run_blocking": lambda: kernel.run_blocking(log.append, "was called"),
    }
    log = []

    def body():
        kernel.current().cancel()
        points[point]()
        log.append("was not delivered")

    task = kernel.spawn(body)
    task.join()
    assert task.cancelled_delivered
    assert log == []
    assert kernel.now() == 0.0


def test_a_task_that_is_woken_and_cancelled_before_it_runs_is_cancelled(k):
    body = Recorder(lambda: kernel.park("a message"))
    task = kernel.spawn(body)
    kernel.yield_()
    kernel.unpark(task)
    task.cancel("too late")
    task.join()
    assert body.log == ["cancelled: too late"]


def test_a_joiner_that_is_cancelled_leaves_the_other_alone(k):
    slow = kernel.spawn(kernel.sleep, 5)
    joiner = kernel.spawn(slow.join)
    kernel.sleep(1)
    joiner.cancel()
    joiner.join()
    assert not slow.dead
    assert kernel.now() == 1.0
    slow.join()
    assert kernel.now() == 5.0


def test_cleanup_may_spawn_and_join(k):
    log = []

    def body():
        try:
            kernel.park("for ever")
        finally:
            kernel.spawn(log.append, "cleaned by a child").join()

    task = kernel.spawn(body)
    kernel.yield_()
    task.cancel()
    task.join()
    assert log == ["cleaned by a child"]


def test_the_text_of_a_request_without_a_reason():
    assert str(kernel.Cancelled()) == "cancelled"


def test_a_wake_up_during_what_is_called_before_a_park_is_not_lost(k):
    """What was interjected into a shield is called at the next park point, before the task parks, and takes its time."""
    ready = []

    def wait():
        with kernel.shield():
            kernel.sleep(1)
        while not ready:
            kernel.park("it")
        return kernel.now()

    task = kernel.spawn(wait)
    kernel.sleep(0.5)
    task.interject(lambda: kernel.sleep(1))  # from 1 to 2
    kernel.sleep(1)
    ready.append(True)
    kernel.unpark(task)
    assert task.join() == 2


def test_who_swallows_it_gets_it_again_at_the_next_point(k):
    log = []

    def stubborn():
        for _ in range(3):
            try:
                kernel.park("for ever")
            except:  # noqa: E722  what is tested
                log.append("swallowed")
        log.append("through the loop, which has no point after the last")

    task = kernel.spawn(stubborn)
    kernel.yield_()
    task.cancel()
    task.join()
    assert log == ["swallowed"] * 3 + ["through the loop, which has no point after the last"]
    assert task.dead and kernel.now() == 0


def test_a_busy_loop_that_swallows_it_gets_it_again(k):
    log = []

    def stubborn():
        while len(log) < 3:
            try:
                while True:
                    kernel.checkpoint()
            except kernel.Cancelled:
                log.append("swallowed")

    task = kernel.spawn(stubborn)
    kernel.yield_()
    task.cancel()
    task.join()
    assert log == ["swallowed"] * 3


def test_a_cleanup_that_leaves_by_an_exit_of_its_own_does_not_bring_the_task_back(k):
    log = []

    class Exit(BaseException):
        pass

    def body():
        try:
            try:
                kernel.park("for ever")
            finally:
                log.append("cleanup")
                raise Exit
        except Exit:
            log.append("exit")
        log.append("on")
        kernel.sleep(100)
        log.append("never")

    task = kernel.spawn(body)
    kernel.yield_()
    task.cancel()
    task.join()
    assert log == ["cleanup", "exit", "on"] and kernel.now() == 0


def test_cleanup_may_wait_fail_and_handle_its_failure_without_getting_it_again(k):
    log = []

    def body():
        try:
            kernel.park("for ever")
        finally:
            kernel.sleep(1)
            try:
                kernel.sleep(1)
                raise ValueError
            except ValueError:
                kernel.sleep(1)
                log.append("handled")
            kernel.sleep(1)
            log.append("done")

    task = kernel.spawn(body)
    kernel.yield_()
    task.cancel()
    task.join()
    assert log == ["handled", "done"] and kernel.now() == 4
    assert isinstance(task.exception, kernel.Cancelled)
