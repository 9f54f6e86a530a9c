"""What the kernel costs, beside raw Python on the same machine in the same run.

    python benchmarks/kernel_bench.py [--quick]

Every figure is the median of five runs. The figures to beat stand in docs and in the goals of the project; other
machines give other numbers, so compare the ratio to the reference line of each block.
"""

import _thread
import statistics
import sys
import time

from cramhy_runtime import kernel

RUNS = 5
SCALE = 0.1 if "--quick" in sys.argv else 1.0


def measure(name, unit, work, count):
    """Print the median time of one of COUNT repetitions that WORK(count) does."""
    count = max(1, int(count * SCALE))
    times = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        work(count)
        times.append((time.perf_counter() - begin) / count)
    median = statistics.median(times)
    if unit == "/s":
        print(f"  {name:<52}{1 / median:>12,.0f} /s")
    else:
        print(f"  {name:<52}{median * {'us': 1e6, 'ns': 1e9}[unit]:>12,.2f} {unit}")
    return median


def nothing():
    pass


def raw_thread_start(count):
    done = _thread.allocate_lock()
    done.acquire()
    for _ in range(count):
        _thread.start_new_thread(done.release, ())
        done.acquire()


def raw_lock_ping_pong(count):
    ping, pong = _thread.allocate_lock(), _thread.allocate_lock()
    ping.acquire()
    pong.acquire()

    def other():
        for _ in range(count):
            ping.acquire()
            pong.release()

    _thread.start_new_thread(other, ())
    for _ in range(count):
        ping.release()
        pong.acquire()


def raw_calls(count):
    for _ in range(count):
        nothing()


def raw_loop(count):
    for _ in range(count):
        pass


def spawn_join(count):
    for _ in range(count):
        kernel.spawn(nothing).join()


def wide(count):
    for task in [kernel.spawn(nothing) for _ in range(count)]:
        task.join()


def wide_parked(count):
    """All alive at once: each parks before it ends."""
    tasks = [kernel.spawn(kernel.park, "the others") for _ in range(count)]
    kernel.settle()
    for task in tasks:
        kernel.unpark(task)
    for task in tasks:
        task.join()


def ping_pong(count):
    main = kernel.current()

    def other():
        for _ in range(count):
            kernel.park("ping")
            kernel.unpark(main)

    task = kernel.spawn(other)
    kernel.yield_()
    for _ in range(count):
        kernel.unpark(task)
        kernel.park("pong")
    task.join()


def sleeps(count):
    for _ in range(count):
        kernel.sleep(0.01)


def sleeps_of_ten(count):
    def sleeper(number):
        for _ in range(count // 10):
            kernel.sleep(0.01 + number * 0.001)

    for task in [kernel.spawn(sleeper, number) for number in range(10)]:
        task.join()


def loser_asleep(count):
    for _ in range(count):
        loser = kernel.spawn(kernel.sleep, 10)
        kernel.yield_()
        loser.cancel()
        loser.join()


def loser_busy(count):
    def loop():
        while True:
            kernel.checkpoint()

    for _ in range(count):
        loser = kernel.spawn(loop)
        kernel.yield_()
        loser.cancel()
        loser.join()


def timers(count):
    left = count

    def tick():
        nonlocal left
        left -= 1
        if not left:
            timer.cancel()
            kernel.unpark(main)

    main = kernel.current()
    timer = kernel.call_every(0.016, tick)
    kernel.park("the ticks")


def checkpoints(count):
    checkpoint = kernel.checkpoint
    for _ in range(count):
        checkpoint()


def blocking(count):
    for _ in range(count):
        kernel.run_blocking(nothing)


def interrupts(count):
    """From Ctrl-C, while another task is busy, until the main task has it."""

    def busy():
        kernel.interrupt()
        while True:
            kernel.checkpoint()

    for _ in range(count):
        task = kernel.spawn(busy)
        try:
            task.join()
        except kernel.Interrupted:
            kernel.interrupt_over()
        task.cancel()
        task.join()


def main():
    print("raw Python")
    measure("start a thread and wait for its end", "us", raw_thread_start, 2000)
    measure("two threads and two locks, round trip", "us", raw_lock_ping_pong, 10000)
    loop = measure("a loop, each turn", "ns", raw_loop, 1000000)
    call = measure("the same with a call of an empty function", "ns", raw_calls, 1000000)
    for backend in ("threads", "greenlet"):
        try:
            kernel.start(backend=backend)
        except ImportError as missing:
            print(missing)
            continue
        print(f"back end {backend}")
        measure("spawn and join", "us", spawn_join, 5000)
        measure("100 spawned, then joined, each", "us", wide, 100 / SCALE)
        measure("1000 spawned, then joined, each", "us", wide, 1000 / SCALE)
        measure("1000 spawned, parked, woken, joined, each", "us", wide_parked, 1000 / SCALE)
        measure("ping-pong between two tasks, round trip", "us", ping_pong, 10000)
        measure("cancel and join a task that sleeps", "us", loser_asleep, 2000)
        measure("cancel and join a task that is busy", "us", loser_busy, 2000)
        measure("virtual sleeps of one task", "/s", sleeps, 20000)
        measure("virtual sleeps of ten tasks", "/s", sleeps_of_ten, 20000)
        measure("firings of a periodic timer", "/s", timers, 50000)
        measure("a blocking call that does nothing", "us", blocking, 1000)
        measure("interrupt in a busy task, cancel and join it", "us", interrupts, 1000)
        with_checkpoint = measure("a loop with a checkpoint, each turn", "ns", checkpoints, 1000000)
        print(f"  {'so a checkpoint costs':<52}{(with_checkpoint - loop) * 1e9:>12,.2f} ns"
              f"  (an empty call {(call - loop) * 1e9:,.2f})")  # fmt: skip
        kernel.stop()


if __name__ == "__main__":
    main()
