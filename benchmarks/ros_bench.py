"""The ROS graph and the turtle: messages, topics, services, ticks, the start of a node; beside CRAM's figures and the goals.

    python benchmarks/ros_bench.py

Microseconds, best and median round (``measuring.py``). What stands under CRAM is from ``peers.md``, another machine on another day.
``send-vel-cmd`` is the function of the course: two vectors, a twist, published to the simulator, which takes it in its tick. A tick is
one update of the simulator, 16 ms of plan time, so it should cost 16 us without observers, to be 1,000 times faster than the wall,
and 80 us with them. A service call waits for the tick that answers it. While the program observes pose and colour, that tick also runs
its two callbacks on a stack of their own, and with threads it is the switch to that stack and back which costs most of the call.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from time import process_time

from measuring import Table, repeat, rounds

from cramhy_runtime import kernel
from cramhy_runtime.session import fresh_start
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.reader.reader_functions import read_from_string
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.systems.systems import load_system
from cramhy_runtime.ros.roslisp import node
from cramhy_runtime.turtlesim.node import running_simulator, start_turtlesim

sys.path.insert(0, str(Path(__file__).parents[1] / "tutorials"))
from lectures import PAR_TWO_MODULES  # noqa: E402

TICK = 0.016


def calling(text):
    """The work that evaluates the form in ``text`` so many times, compiled, in the tutorial's package."""
    sym("*PACKAGE*").value = sym("CRAM-MY-BEGINNER-TUTORIAL::SEND-VEL-CMD").package
    return evaluate(one(read_from_string(f"(lambda (count) (dotimes (i count) {text}))")))


def ticks(count):
    """So many ticks pass."""
    kernel.sleep(count * TICK)


def driving(count):
    """So many ticks pass while the turtle drives a circle and draws it, and nobody's program takes part."""
    turtle = running_simulator().turtles["turtle1"]
    for _ in range(max(1, count // 32)):
        turtle.command(1.0, 0.0, 1.0, kernel.now())
        kernel.sleep(32 * TICK)


def busy_row(table, name, work, count, goal=None):
    """A row whose rounds are long, since a turtle's lines are drawn by the thousand: what the processor spent, not others' turns."""
    times = rounds(work, count, process_time)
    table.line(name, min(times), median(times), goal)


def alone(table):
    """The rows of the simulator while nobody listens to it, and while somebody looks on from inside."""
    table.row("tick, nobody listening, at rest", ticks, 1000, goal=16)
    busy_row(table, "tick, nobody listening, while driving", driving, 8192, goal=16)
    simulator = running_simulator()
    simulator.observe(nobody := lambda simulator, strokes: None)
    busy_row(table, "tick, strokes observed, while driving", driving, 8192)
    simulator.unobserve(nobody)
    simulator.keep_history()
    busy_row(table, "tick, history kept, while driving", driving, 8192)
    simulator.history.stop()
    simulator.history = None
    set_pen = calling('(call-service "/turtle1/set_pen" \'turtlesim-srv:SetPen :r 1 :g 2 :b 3 :width 4 :off 0)')
    table.row("service call to turtlesim", set_pen, 50, goal=50, cram="15.8 ms")


def observed(table):
    """The rows of the simulator while the course's program listens to pose and colour, at rest and driving."""
    table.row("tick, pose and colour observed, at rest", ticks, 200, goal=80)
    table.row("service call, pose and colour observed", calling("(call-set-pen 1 2 3 4 0)"), 20)
    drive = calling("(send-vel-cmd 2 1)")

    def drive_on(count):
        for _ in range(max(1, count // 50)):
            drive(1)
            kernel.sleep(50 * TICK)

    table.row("tick, observed, while driving", drive_on, 200, goal=80)


def plans(table):
    """What a tick costs in plans of the lectures, all in all: 80 us are 200 times faster than the wall. The processor's time."""
    for name, form in (
        ("lecture 34, (dotimes ... (send-vel-cmd 1 1))", "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))"),
        ("lecture 38, a goal and a pen in parallel", PAR_TWO_MODULES),
        ("the tutorial, (perform-draw-house)", "(let ((*standard-output* (make-broadcast-stream))) (perform-draw-house))"),
    ):
        plan, times = calling(form), []
        for _ in range(8):
            begin, start = kernel.now(), process_time()
            plan(1)
            times.append((process_time() - start) / (kernel.now() - begin) * TICK * 1e6)
        table.line(f"tick of {name}", min(times), median(times), goal=80 if "lecture" in name else None)


def messages(table):
    """The rows of messages and topics."""
    table.row("make-message Twist", calling('(make-message "geometry_msgs/Twist")'), 500, goal=5, cram="4.8")
    table.row(
        "make-message Twist, two fields", calling('(make-message "geometry_msgs/Twist" (:x :linear) 1.0 (:z :angular) 2.0)'), 200, cram=""
    )
    sent = calling("(send-vel-cmd 1.5 0.3)")

    def send_and_take(count):
        sent(count)
        running_simulator().node.spin_once()  # in its tick the simulator takes what has arrived

    table.row("send-vel-cmd to one subscriber", send_and_take, 100, goal=10, cram="17.9 (TCP)")


def starting(table):
    """Starting a node, and starting it again, which shuts the first one down."""
    table.row("starting a node", repeat(lambda: (node.start_ros_node("bench"), node.shutdown_ros_node())), 5, goal=10_000, cram="1.1 s")
    node.start_ros_node("bench")
    table.row("starting a node again", repeat(lambda: node.start_ros_node("bench")), 5, goal=10_000, cram="4.5 s")


def main():
    for backend in ("threads", "greenlet"):
        try:
            fresh_start(backend=backend, turtlesim=False)
        except ImportError:
            print("greenlet is not installed")
            continue
        streams.STANDARD_OUTPUT.value, streams.ERROR_OUTPUT.value = streams.BroadcastStream(), streams.BroadcastStream()
        load_system("cram-my-beginner-tutorial")
        start_turtlesim()
        table = Table("ROS", backend)
        starting(table)
        alone(table)
        calling('(init-ros-turtle "turtle1")')(1)
        messages(table)
        observed(table)
        plans(table)
        table.end()
        kernel.stop()


if __name__ == "__main__":
    main()
