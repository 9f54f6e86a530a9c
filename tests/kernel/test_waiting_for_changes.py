"""`Waiting`: tasks that wait for a change of something."""

from cramhy_runtime import kernel


def test_those_who_wait_look_again_when_something_changed(k):
    waiting, things = kernel.Waiting(), []
    tasks = [kernel.spawn(lambda wanted=wanted: (waiting.wait(lambda: len(things) >= wanted, "things"), kernel.now())) for wanted in (1, 2)]
    for _ in range(2):
        kernel.sleep(1)
        things.append("thing")
        waiting.changed()
    assert [task.join() for task in tasks] == [(True, 1.0), (True, 2.0)]


def test_a_condition_that_holds_is_not_waited_for(k):
    assert kernel.Waiting().wait(lambda: True, "nothing", kernel.now()) is True


def test_a_wait_ends_at_its_time(k):
    waiting = kernel.Waiting()
    assert waiting.wait(lambda: False, "nothing", 2.0) is False
    assert kernel.now() == 2.0
    waiting.changed()  # nobody waits any more


def test_a_change_that_nobody_told_of_is_seen_at_the_end(k):
    waiting = kernel.Waiting()
    assert waiting.wait(lambda: kernel.now() >= 2.0, "the time", 2.0) is True
