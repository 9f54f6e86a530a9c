"""The pace of virtual time: slower, paused, step by step; with a wall clock that is played, so that nobody waits."""

import pytest
from outside_world import Event
from systems import BACKENDS

from cramhy_runtime import kernel
from cramhy_runtime.kernel.throttle import FORGOTTEN, Pace


class PlayedWall:
    """An operating system's clock that moves only when somebody waits; what happens meanwhile is in `events` (time, function)."""

    def __init__(self, made):
        self.time, self.kernel, self.events = 0.0, made, []

    def clock(self):
        return self.time

    def wait(self, seconds):
        end = self.time + min(seconds, 0.05)
        if self.events and self.events[0][0] <= end:
            when, function = self.events.pop(0)
            self.time = max(self.time, when)
            self.kernel.post(function)
        else:
            self.time = end

    def at(self, when, function):
        self.events.append((when, function))
        self.events.sort(key=lambda event: event[0])


@pytest.fixture
def wall(virtual):
    """A played wall clock, and a pace on it."""
    made = kernel.active()
    played = PlayedWall(made)
    made.clock.pace = Pace(made, played.clock, played.wait)
    return played


@pytest.fixture(params=BACKENDS)
def virtual(request):
    kernel.start(backend=request.param)
    yield
    kernel.stop()


def test_without_a_speed_time_jumps(wall):
    kernel.sleep(1000)
    assert wall.time == 0.0 and kernel.now() == 1000


def test_a_speed_is_plan_seconds_per_second(wall):
    kernel.pace().set_speed(4)
    kernel.sleep(10)
    assert kernel.now() == 10 and wall.time == pytest.approx(2.5)


def test_every_timer_comes_at_its_time_whatever_the_speed(wall):
    seen = []
    kernel.call_every(0.3, lambda: seen.append((kernel.now(), round(wall.time, 6))), first=0.3)
    kernel.pace().set_speed(0.5)
    kernel.sleep(1.0)
    assert [plan for plan, _ in seen] == [0.3, 0.6, 0.3 * 3]
    assert [moment for _, moment in seen] == [0.6, 1.2, 1.8]


def test_paused_time_stands_still_until_it_is_resumed(wall):
    wall.at(1.0, kernel.pace().pause)
    wall.at(61.0, kernel.pace().resume)
    kernel.pace().set_speed(1)
    kernel.sleep(5)
    assert kernel.now() == 5 and wall.time == pytest.approx(65, abs=0.1)


def test_a_step_lets_so_much_time_pass_and_pauses(wall):
    seen = []
    kernel.call_every(1.0, lambda: seen.append(kernel.now()), first=1.0)
    kernel.pace().pause()
    wall.at(1.0, lambda: kernel.pace().step(2.5))
    wall.at(2.0, lambda: seen.append(("still", kernel.now(), kernel.pace().paused)))
    wall.at(3.0, kernel.pace().resume)
    kernel.sleep(3)
    assert seen == [1.0, 2.0, ("still", 2.5, True), 3.0]


def test_steps_add_up(wall):
    kernel.pace().pause()
    wall.at(1.0, lambda: kernel.pace().step(1.0))
    wall.at(1.0, lambda: kernel.pace().step(1.0))
    wall.at(2.0, lambda: wall.at(2.0, lambda: result.append(kernel.now())) or kernel.pace().resume())
    result = []
    kernel.sleep(2.5)
    assert kernel.now() == 2.5


def test_a_message_from_outside_does_not_wait_for_the_next_timer(wall):
    heard = []
    kernel.pace().set_speed(1)
    wall.at(2.0, lambda: heard.append((wall.time, round(kernel.now(), 6))))
    kernel.sleep(10)
    assert heard == [(2.0, 2.0)]


def test_who_falls_behind_does_not_hurry_to_catch_up(wall):
    kernel.pace().set_speed(1)
    kernel.sleep(1)
    wall.time += 100 * FORGOTTEN  # the machine was busy with something else, or the prompt waited
    for _ in range(2):
        begin = wall.time
        kernel.sleep(1)
        assert wall.time - begin == pytest.approx(1.0, abs=0.06)


def test_a_busy_loop_does_not_outrun_the_pace(wall):
    kernel.pace().set_speed(1)
    task = kernel.spawn(busy)
    kernel.sleep(1.0)
    assert wall.time == pytest.approx(1.0, abs=0.1)
    task.cancel("over")


def busy():
    while True:
        kernel.checkpoint()


def test_a_change_is_told(wall):
    told = []
    kernel.pace().on_change.append(lambda: told.append((kernel.pace().speed, kernel.pace().paused)))
    kernel.pace().set_speed(2)
    kernel.pace().pause()
    kernel.pace().resume()
    kernel.pace().set_speed(None)
    assert told == [(2.0, False), (2.0, True), (2.0, False), (None, False)]


@pytest.mark.parametrize("speed", [0, -1, float("nan")])
def test_a_speed_must_be_above_zero(virtual, speed):
    with pytest.raises(ValueError, match="A speed is a number above zero"):
        kernel.pace().set_speed(speed)


@pytest.mark.parametrize("seconds", [0, -1, float("nan"), float("inf")])
def test_a_step_must_take_time(virtual, seconds):
    with pytest.raises(ValueError, match="A step takes a time above zero"):
        kernel.pace().step(seconds)


def test_the_walls_time_cannot_be_paused():
    kernel.start(clock="wall")
    with pytest.raises(kernel.KernelError, match="with --time virtual"):
        kernel.pace().pause()
    assert kernel.pace().speed == 1.0 and not kernel.pace().virtual
    kernel.stop()


class TestAtThePrompt:
    """The main task is in a blocking call, which somebody ends from outside."""

    @staticmethod
    def prompt(*from_outside):
        """Wait at a prompt until what comes from outside is over; each is a function that is posted, after the one before was read."""
        over = Event()
        messages = list(from_outside)

        def next_message():
            if messages:
                messages.pop(0)()
                kernel.post(next_message)
            else:
                over.set()

        kernel.post(next_message)
        kernel.run_blocking(over.wait, 10)

    def test_time_stands_still(self, virtual):
        ticks = []
        kernel.call_every(0.016, lambda: ticks.append(kernel.now()))
        self.prompt(lambda: None, lambda: None)
        assert len(ticks) <= 1 and kernel.now() == 0

    def test_it_passes_while_somebody_outside_wants_it(self, virtual):
        ticks, wanted = [], kernel.time_wanted()

        def tick():
            ticks.append(kernel.now())
            if len(ticks) == 5:
                wanted.__exit__()
                over.set()

        over = Event()
        kernel.call_every(0.5, tick, first=0.5)
        kernel.post(wanted.__enter__)
        kernel.run_blocking(over.wait, 10)
        assert ticks == [0.5, 1.0, 1.5, 2.0, 2.5] and kernel.now() == 2.5

    def test_a_step_reaches_its_end(self, virtual):
        over = Event()
        ticks = []
        kernel.call_every(0.5, lambda: ticks.append(kernel.now()), first=0.5)
        kernel.pace().on_change.append(lambda: kernel.now() >= 1.25 and over.set())
        kernel.post(lambda: kernel.pace().step(1.25))
        kernel.run_blocking(over.wait, 10)
        assert ticks == [0.5, 1.0] and kernel.now() == 1.25

    def test_a_task_that_is_outside_for_itself_still_holds_the_clock(self, virtual):
        over, other = Event(), Event()
        ticks = []
        kernel.call_every(0.5, lambda: ticks.append(kernel.now()), first=0.5)
        kernel.spawn(lambda: kernel.run_blocking(other.wait, 10))
        kernel.yield_()

        def end():
            assert ticks == []
            wanted.__exit__()
            other.set()
            over.set()

        wanted = kernel.time_wanted()
        kernel.post(wanted.__enter__)
        kernel.post(lambda: kernel.post(lambda: kernel.post(end)))
        kernel.run_blocking(over.wait, 10)


def test_ctrl_c_ends_a_plan_that_computes_while_time_is_paused(virtual):
    """Without a handler of ours Python raises it in the wait for the wall, while the next task is being looked for."""
    made, pressed = kernel.active(), []

    def wait(seconds):
        if not pressed:
            pressed.append(seconds)
            raise KeyboardInterrupt

    made.clock.pace = Pace(made, wait=wait)
    kernel.pace().pause()
    with pytest.raises(kernel.Interrupted):
        while True:
            kernel.checkpoint()
    kernel.interrupt_over()
    assert pressed and kernel.now() == 0.0
