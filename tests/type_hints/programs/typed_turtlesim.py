"""What a type checker knows of the kernel, the simulator, geometry and images."""

from collections.abc import Callable
from math import pi
from typing import Any, assert_type

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons, Keyword, lisp_list
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image, fresh_start
from cramhy_runtime.tf.buffer import FrameBuffer
from cramhy_runtime.tf.stamped import TransformStamped
from cramhy_runtime.transforms.poses import Pose, pose_to_transform, transform_inv, transform_point
from cramhy_runtime.transforms.quaternions import Quaternion, yaw
from cramhy_runtime.transforms.vectors import Vector3
from cramhy_runtime.turtlesim import drawing, executables, pictures
from cramhy_runtime.turtlesim.draw_square import DrawSquare
from cramhy_runtime.turtlesim.node import Turtlesim, running_simulator, start_turtlesim
from cramhy_runtime.ros.roscpp import Program

Stroke = tuple[float, float, float, float, tuple[int, int, int], int]


def total(values: list[float], factor: float = 1.0) -> float:
    return sum(values) * factor


def the_kernel() -> None:
    here = kernel.start(clock="virtual", backend="greenlet", seed=3, time_limit=100)
    assert_type(here, kernel.Kernel)
    task = kernel.spawn(total, [1.0, 2.0], name="adder")
    assert_type(task, kernel.Task[float])
    assert_type(task.join(), float | None)
    assert_type(kernel.spawn(lambda: "there", parent=here.main).result, str | None)
    assert_type(kernel.run_blocking(total, [1.0]), float)
    timer = kernel.call_every(0.1, lambda: print("tick"), first=1.0)
    timer.cancel()
    kernel.call_at(kernel.now() + 1, kernel.settle)
    assert_type(kernel.park("a message", until=5), bool)
    with kernel.shield(), kernel.time_held(), kernel.outside_source() as source:
        print(source)
    assert_type(kernel.active(), kernel.Kernel | None)
    kernel.pace().set_speed(2)
    waiting = kernel.Waiting()
    assert_type(waiting.wait(lambda: True, lambda: "it"), bool)
    kernel.stop()


def watch(simulator: Turtlesim, strokes: list[Stroke]) -> None:
    for x1, y1, x2, y2, (red, green, blue), width in strokes:
        print(x1 + y1 + x2 + y2, red, green, blue, width)


def the_simulator() -> None:
    simulator = executables.start("turtlesim_node", ["_background_r:=20"], echo=print)
    assert_type(simulator, Turtlesim)
    simulator.observe(watch)
    simulator.observe(lambda simulator, strokes: None)
    square = executables.start("draw_square")
    assert_type(square, DrawSquare)
    assert_type(square.state, str)
    assert_type(executables.start("mimic "[:-1]), Program)
    turtle = simulator.turtles["turtle1"]
    assert_type(turtle.pose(), tuple[float, float, float, float, float])
    x, y, *_ = turtle.pose()
    assert_type(x, float)
    turtle.set_pen(255, 0, 0, width=3, off=False)
    pictures.save("half.svg", simulator, speed=2)
    assert_type(running_simulator(), Turtlesim | None)
    start_turtlesim(namespace="/other", echo=True).log(2, "here")
    assert_type(drawing.shapes()[0]["paths"][0]["fill"], str)


def geometry() -> None:
    turtle = Pose(Vector3(1, 1, 0), yaw(float(pi / 2)))
    x, y, z = transform_point(transform_inv(pose_to_transform(turtle)), Vector3(2, 1, 0))
    assert_type(x, float)
    assert_type(turtle.orientation, Quaternion)
    assert_type(turtle.origin.x, float)
    frames = FrameBuffer()
    assert_type(frames.store(TransformStamped("map", "base", 1.0, Vector3(1, 0, 0))), bool)
    assert_type(frames.lookup("map", "base", 1.5).translation, Vector3)


def images() -> None:
    with Image() as image:
        session = Session(time="virtual", turtlesim=False)
        assert_type(session.evaluate_text("(+ 1 2)"), list[Any])
        print(image)
    with Image(as_now=True).entered() as notebook:
        notebook.start(clock="virtual")
    fresh_start(clock="wall")
    assert_type(keyword("DRIVING"), Keyword)
    assert_type(lisp_list(1, 2), Cons)


def on_each(tasks: list[kernel.Task], do: Callable[[kernel.Task[object]], None]) -> None:
    for task in tasks:
        do(task)
