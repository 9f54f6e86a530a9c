"""Who goes next may be chosen by a function, and a kernel may be put aside while others run."""

import pytest

from cramhy_runtime import kernel


def order_with(start, seed):
    start(seed=seed)
    order = []

    def follow(name):
        for _ in range(2):
            kernel.sleep(1)
            order.append(name)

    tasks = [kernel.spawn(follow, name, name=name) for name in "abc"]
    for task in tasks:
        task.join()
    return "".join(order)


def test_a_function_of_the_queue_chooses_who_goes_next(start):
    asked = []

    def last(queue):
        asked.append(len(queue))
        return len(queue) - 1

    assert order_with(start, None) == order_with(start, lambda queue: 0) == "abcabc"
    assert order_with(start, last) == "cbaabc"  # those who sleep again are queued, and woken, in the order c, b, a
    assert max(asked) == 3


def test_a_choice_cannot_have_branches_begin_in_another_order(start):
    start(seed=lambda queue: len(queue) - 1)
    begun = []
    tasks = [kernel.spawn(begun.append, number) for number in range(3)]
    for task in tasks:
        task.join()
    assert begun == [0, 1, 2]


def test_a_kernel_put_aside_goes_on_where_it_was(start, backend):
    outer = start()
    woken = []
    task = kernel.spawn(lambda: woken.append(kernel.park("the flag")))
    kernel.sleep(1)
    with kernel.aside():
        assert kernel.active() is None
        inner = kernel.start(backend=backend)
        kernel.sleep(7)
        assert kernel.now() == 7 and kernel.active() is inner
    assert inner.stopped and kernel.active() is outer and kernel.now() == 1
    kernel.unpark(task)
    task.join()
    assert woken == [True]


def test_a_kernel_comes_back_after_an_error_in_the_block(start, backend):
    outer = start()
    with pytest.raises(LookupError), kernel.aside():
        kernel.start(backend=backend)
        raise LookupError
    assert kernel.active() is outer


def test_a_subclass_may_look_on(start):
    seen = []

    class Observed(kernel.Kernel):
        def park(self, why="", until=None):
            seen.append((str(self.current.name), why))
            return super().park(why, until)

    start(kind=Observed)
    kernel.spawn(lambda: kernel.park("a bell", 1.0), name="one").join()
    assert ("one", "a bell") in seen
