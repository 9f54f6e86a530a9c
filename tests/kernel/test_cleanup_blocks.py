"""`kernel.cleanup`, and waits in it that are ended from outside."""

import pytest

from cramhy_runtime import kernel


def test_a_wait_in_cleanup_that_is_ended_ends_the_block_and_what_led_there_goes_on(k):
    order = []

    def work():
        try:
            try:
                raise LookupError("why")
            finally:
                with kernel.cleanup():
                    order.append("begins")
                    kernel.park("nothing")
                    order.append("not reached")
        finally:
            with kernel.cleanup():
                order.append("outer")

    task = kernel.spawn(work)
    kernel.sleep(1)
    assert task.end_wait(kernel.WaitEnded("enough"))
    task.join()
    assert order == ["begins", "outer"] and isinstance(task.exception, LookupError)


def test_only_a_task_that_waits_is_reached(k):
    done = []

    def compute():
        with kernel.cleanup():
            for _ in range(5000):
                kernel.checkpoint()
        done.append(True)

    task = kernel.spawn(compute)
    kernel.yield_()
    assert not task.end_wait(kernel.WaitEnded())
    task.join()
    assert done == [True] and not task.end_wait(kernel.WaitEnded())


def test_a_request_to_end_waits_for_the_block(k):
    order = []

    def work():
        with kernel.cleanup():
            kernel.sleep(2)
            order.append("complete")
        kernel.sleep(1)
        order.append("not reached")

    task = kernel.spawn(work)
    kernel.sleep(1)
    task.cancel("enough")
    task.join()
    assert order == ["complete"] and kernel.now() == 2


def test_what_is_raised_may_be_made_on_the_stack_of_the_task_that_waits(k):
    made_in = []

    def work():
        try:
            kernel.park("nothing")
        except kernel.WaitEnded as ended:
            return str(ended)

    def reason():
        made_in.append(kernel.current())
        return kernel.WaitEnded("made there")

    task = kernel.spawn(work)
    kernel.yield_()
    task.end_wait(reason)
    assert task.join() == "cancelled: made there" and made_in == [task]


def test_blocks_may_nest_and_the_innermost_is_ended(k):
    order = []

    def work():
        with kernel.cleanup():
            with kernel.cleanup():
                kernel.park("nothing")
            order.append("outer goes on")
            assert kernel.current().cleanup is not None
        assert kernel.current().cleanup is None

    task = kernel.spawn(work)
    kernel.yield_()
    task.end_wait(kernel.WaitEnded())
    task.join()
    assert order == ["outer goes on"] and task.exception is None


def test_a_task_that_is_abandoned_unwinds_though_it_is_shielded(k):
    def work():
        with kernel.cleanup():
            kernel.park("nothing")

    task = kernel.spawn(work)
    kernel.yield_()
    task.abandon()
    task.join()
    assert isinstance(task.exception, kernel.Abandoned)


@pytest.mark.parametrize(
    "waits", [lambda: kernel.park("nothing"), lambda: kernel.sleep(1000), lambda: kernel.spawn(lambda: kernel.park()).join()]
)
def test_every_wait_can_be_ended(k, waits):
    task = kernel.spawn(waits)
    kernel.sleep(1)
    assert task.end_wait(kernel.WaitEnded())
    task.join()
    assert isinstance(task.exception, kernel.WaitEnded)
    kernel.stop()
