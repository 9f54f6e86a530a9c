"""One baton: who runs when (law 4)."""

import os

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.kernel.budget import SLICE


def test_a_task_runs_when_the_spawner_gives_the_baton_away_and_not_before(k):
    log = []
    task = kernel.spawn(log.append, "ran")
    assert log == []
    task.join()
    assert log == ["ran"]


def test_tasks_run_first_come_first_served(k):
    log = []

    def walk(name):
        for step in range(3):
            log.append(f"{name}{step}")
            kernel.yield_()

    for task in [kernel.spawn(walk, name) for name in "abc"]:
        task.join()
    assert log == ["a0", "b0", "c0", "a1", "b1", "c1", "a2", "b2", "c2"]


def test_a_woken_task_goes_to_the_end_of_the_queue(k):
    log = []

    def waiter():
        kernel.park("the waker")
        log.append("woken")

    waiting = kernel.spawn(waiter)
    kernel.yield_()
    other = kernel.spawn(log.append, "first")
    kernel.unpark(waiting)
    other.join()
    waiting.join()
    assert log == ["first", "woken"]


def test_park_says_whether_it_was_woken_or_ran_out_of_time(k):
    answers = []

    def waiter():
        answers.append(kernel.park("the waker", until=5.0))
        answers.append(kernel.park("the waker", until=5.0))

    task = kernel.spawn(waiter)
    kernel.sleep(1)
    assert kernel.unpark(task)
    task.join()
    assert answers == [True, False]
    assert kernel.now() == 5.0


def test_a_deadline_in_the_past_still_gives_the_others_a_turn(k):
    kernel.sleep(3)
    log = []
    other = kernel.spawn(log.append, "other")
    assert kernel.park("nothing", until=1.0) is False
    assert log == ["other"]
    assert other.dead
    assert kernel.now() == 3.0


def test_unpark_of_a_task_that_is_not_parked_does_nothing(k):
    task = kernel.spawn(lambda: None)
    assert not kernel.unpark(task)
    assert not kernel.unpark(kernel.current())
    task.join()
    assert not kernel.unpark(task)


def test_a_wake_up_is_not_kept_for_a_later_park(k):
    task = kernel.spawn(lambda: kernel.park("a second one", until=2.0))
    kernel.unpark(task)
    assert task.join() is False


def test_two_wake_ups_before_the_task_runs_are_one(k):
    answers = []

    def waiter():
        answers.append(kernel.park("one"))
        answers.append(kernel.park("two", until=1.0))

    task = kernel.spawn(waiter)
    kernel.yield_()
    assert kernel.unpark(task)
    assert not kernel.unpark(task)
    task.join()
    assert answers == [True, False]


def test_at_most_one_task_runs(k):
    running = [0]
    most = [0]

    def work():
        for turn in range(20):
            running[0] += 1
            most[0] = max(most[0], running[0])
            sum(range(2000))
            running[0] -= 1
            if turn % 3:
                kernel.yield_()
            else:
                kernel.sleep(0.001)

    for task in [kernel.spawn(work) for _ in range(20)]:
        task.join()
    assert most == [1]


def test_a_busy_task_is_preempted_after_one_slice(k):
    turns = [0]

    def busy():
        while not done:
            turns[0] += 1
            kernel.checkpoint()

    done = []
    task = kernel.spawn(busy)
    kernel.yield_()
    assert turns[0] == SLICE + 1
    done.append(True)
    task.join()


def test_every_turn_begins_with_a_full_slice(k):
    turns = {"a": 0, "b": 0}

    def busy(name):
        while not done:
            turns[name] += 1
            kernel.checkpoint()

    done = []
    tasks = [kernel.spawn(busy, name) for name in turns]
    for _ in range(SLICE // 2):
        kernel.checkpoint()
    kernel.yield_()
    kernel.yield_()
    assert turns == {"a": 2 * (SLICE + 1), "b": 2 * (SLICE + 1)}
    done.append(True)
    for task in tasks:
        task.join()


def test_a_checkpoint_without_a_kernel_does_nothing():
    kernel.stop()
    for _ in range(3 * SLICE):
        kernel.checkpoint()


def test_without_a_kernel_the_functions_say_what_to_do():
    kernel.stop()
    assert kernel.active() is None
    with pytest.raises(kernel.KernelError) as told:
        kernel.now()
    assert str(told.value) == (
        "No kernel is running. Make the call in a plan: cpl.run(drive), without the parentheses behind drive, or `with cpl.plan():` around "
        "the call. Or call kernel.start() first; the caller becomes the main task."
    )


def test_the_main_task_is_the_caller_and_the_parent_of_what_it_spawns(k):
    main = kernel.current()
    assert main is k.main
    assert main.name == "main"
    assert main.parent is None
    child = kernel.spawn(lambda: kernel.spawn(lambda: None, name="grandchild"), name="child")
    grandchild = child.join()
    assert child.parent is main
    assert grandchild.parent is child
    assert kernel.spawn(lambda: None, parent=child).parent is child


def test_a_task_is_named_for_its_function_unless_told_otherwise(k):
    def drive():
        pass

    assert kernel.spawn(drive).name == "drive"
    assert kernel.spawn(drive, name="drive-1").name == "drive-1"


def test_current_is_the_task_that_runs(k):
    task = kernel.spawn(kernel.current)
    assert task.join() is task
    assert kernel.current() is k.main


def test_what_is_kept_with_a_task_belongs_to_it(k):
    kernel.current().local.place = "main"
    task = kernel.spawn(lambda: hasattr(kernel.current().local, "place"))
    assert task.join() is False
    assert kernel.current().local.place == "main"


def test_a_name_given_as_a_function_is_made_when_somebody_asks(k):
    asked = []
    task = kernel.spawn(kernel.park, "a bell", name=lambda: asked.append(True) or "late")
    kernel.yield_()
    assert asked == []
    assert task.name == "late" and "late" in repr(task)
    task.cancel()


def test_join_gives_the_result(k):
    assert kernel.spawn(lambda a, b: a + b, 1, 2).join() == 3


def test_join_does_not_raise_what_ended_the_task(k, reported):
    task = kernel.spawn(lambda: 1 / 0)
    assert task.join() is None
    assert isinstance(task.exception, ZeroDivisionError)
    assert reported == []


def test_several_tasks_can_join_one_in_the_order_they_came(k):
    log = []
    slow = kernel.spawn(kernel.sleep, 1)
    joiners = [kernel.spawn(lambda n=n: (slow.join(), log.append(n))) for n in range(3)]
    for joiner in joiners:
        joiner.join()
    assert log == [0, 1, 2]


def test_a_task_cannot_join_itself(k):
    task = kernel.spawn(lambda: kernel.current().join(), name="narcissus")
    task.join()
    assert str(task.exception) == "Task narcissus would wait for its own end. Join it from another task."


def test_a_stray_wake_up_does_not_end_a_join(k):
    slow = kernel.spawn(kernel.sleep, 2)
    joiner = kernel.spawn(slow.join)
    kernel.sleep(1)
    kernel.unpark(joiner)
    joiner.join()
    assert kernel.now() == 2.0


def test_dynamic_state_is_put_away_whenever_the_baton_leaves_and_back_when_it_returns(k):
    log = []

    class Bindings:
        def leave(self):
            log.append("leave")

        def enter(self):
            log.append("enter")

    def bound():
        kernel.current().dynamic = Bindings()
        log.append("bound")
        kernel.yield_()
        log.append("still bound")
        kernel.sleep(1)
        kernel.run_blocking(lambda: log.append("outside"))
        kernel.current().dynamic = None

    kernel.spawn(bound).join()
    assert log == ["bound", "leave", "enter", "still bound", "leave", "enter", "leave", "outside", "enter"]


def test_settle_runs_the_others_until_none_is_runnable_and_the_clock_stands(k):
    log = []

    def worker():
        log.append("began")
        kernel.yield_()
        kernel.spawn(log.append, "child")
        kernel.yield_()
        log.append("sleeps")
        kernel.sleep(1)
        log.append("woke")

    kernel.spawn(worker)
    kernel.settle()
    assert log == ["began", "child", "sleeps"]
    assert kernel.now() == 0.0


def test_settle_comes_back_although_a_task_is_busy_for_ever(k):
    def busy():
        while True:
            kernel.checkpoint()

    task = kernel.spawn(busy)
    kernel.settle()
    assert kernel.now() == 0.0
    assert not task.dead


def test_two_tasks_that_wake_each_other_for_ever_do_not_stop_the_clock(start, monkeypatch):
    from cramhy_runtime.kernel import scheduler

    monkeypatch.setattr(scheduler, "STEPS_PER_INSTANT", 100)
    start()

    def ping(other):
        while True:
            kernel.unpark(other[0])
            kernel.park("the other")

    a, b = [], []
    a.append(kernel.spawn(ping, b))
    b.append(kernel.spawn(ping, a))
    kernel.sleep(0.1)
    assert kernel.now() == 0.1


@pytest.mark.parametrize("number", [int(os.environ.get("CRAMHY_MANY_TASKS", "300"))])  # 10000 is meant; it takes 3 s
def test_many_tasks_can_be_parked_at_once(k, number):
    tasks = [kernel.spawn(kernel.park, "the morning") for _ in range(number)]
    kernel.settle()
    assert [task.state for task in tasks] == ["parked"] * number
    for task in tasks:
        kernel.unpark(task)
    for task in tasks:
        assert task.join() is True


def test_a_seed_shuffles_the_order_and_the_same_seed_shuffles_it_the_same_way(start):
    def order(seed):
        start(seed=seed)
        log = []

        def walk(name):
            for _ in range(3):
                log.append(name)
                kernel.yield_()

        for task in [kernel.spawn(walk, name) for name in "abcd"]:
            task.join()
        return "".join(log)

    assert order(None) == "abcdabcdabcd"
    assert order(1) == order(1)
    assert len({order(seed) for seed in range(10)}) > 5
