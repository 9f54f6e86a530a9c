"""Who watches a kernel looks whenever an instant is over: everything that can happen at it has happened, and time goes on then."""

from cramhy_runtime import kernel


def test_a_watcher_looks_after_everything_of_an_instant_and_before_time_goes_on(k):
    seen, steps = [], []

    def walk(pause):
        for _ in range(2):
            kernel.sleep(pause)
            steps.append(pause)
            kernel.yield_()
            steps.append(-pause)

    k.watch_instants(lambda: seen.append((k.now(), list(steps))))
    kernel.spawn(walk, 1)
    kernel.spawn(walk, 2)
    kernel.sleep(5)
    first, second = [1, -1], [1, -1, 2, 1, -2, -1]
    assert seen == [(0, []), (1, first), (2, second), (4, [*second, 2, -2])]


def test_what_a_watcher_makes_runnable_runs_at_the_same_instant(k):
    times = []
    k.watch_instants(lambda: times or k.spawn(lambda: times.append(k.now())))
    kernel.sleep(3)
    assert times == [0]


def test_who_watches_no_more_is_called_no_more(k):
    seen = []

    def look():
        seen.append(k.now())

    k.watch_instants(look)
    kernel.sleep(1)
    k.unwatch_instants(look)
    kernel.sleep(1)
    assert seen == [0]


def test_tasks_that_are_busy_for_ever_do_not_hide_from_a_watcher(k):
    seen = []
    k.watch_instants(lambda: seen.append(k.now()))

    def busy():
        while True:
            kernel.checkpoint()

    task = kernel.spawn(busy)
    kernel.sleep(0.02)
    task.cancel()
    assert len(seen) >= 3


def test_an_error_of_a_watcher_is_reported_and_the_run_goes_on(k, reported):
    def look():
        k.unwatch_instants(look)
        raise ValueError("no glasses")

    k.watch_instants(look)
    kernel.sleep(1)
    assert k.now() == 1 and "no glasses" in str(reported)
    reported.clear()


def test_watching_hides_no_deadlock(k):
    k.watch_instants(lambda: None)
    try:
        kernel.park("nothing")
    except kernel.Deadlock:
        return
    raise AssertionError("it waited for nothing")
