"""The ROS graph and the turtle: messages, services, ticks. CRAM's figures are those of ``peers.md``, on another machine.

A tick is one update of the simulator, 16 ms of plan time; "times wall" says how much faster than real time it runs.
"""

from __future__ import annotations

from time import perf_counter

from cramhy_runtime import image, kernel


def microseconds(function, count=2000):
    """The mean duration of a call, of the best of five rounds."""
    best = float("inf")
    for _ in range(5):
        begin = perf_counter()
        for _ in range(count // 5):
            function()
        best = min(best, (perf_counter() - begin) / (count // 5))
    return best * 1e6


def ticks(seconds):
    """Microseconds of wall time per tick, over ``seconds`` of plan time."""
    begin = perf_counter()
    kernel.sleep(seconds)
    return (perf_counter() - begin) / (seconds / 0.016) * 1e6


def rows(backend):
    from cramhy_runtime.lisp.streams import streams
    from cramhy_runtime.ros import message_building, node, services, topics
    from cramhy_runtime.turtlesim.node import start_turtlesim

    image.fresh_start(backend=backend, turtlesim=False)
    streams.STANDARD_OUTPUT.value = streams.StringOutputStream()
    start_turtlesim()
    yield "tick, nobody listening, at rest", ticks(50), "-", "16 (1000 times wall)"
    begin = perf_counter()
    node.start_ros_node("bench")
    yield "starting a node", (perf_counter() - begin) * 1e6, "1.1 s", "10000"
    publication = topics.advertise("turtle1/cmd_vel", "geometry_msgs/Twist")
    for topic, message_type in (("turtle1/pose", "turtlesim/Pose"), ("turtle1/color_sensor", "turtlesim/Color")):
        topics.subscribe(topic, message_type, lambda message: None)
    yield "tick, pose and colour observed, at rest", ticks(20), "-", "80 (200 times wall)"

    def drive():
        for _ in range(25):
            command(2.0, 1.0)
            kernel.sleep(0.8)

    def command(linear, angular):
        vector = message_building.make_message("geometry_msgs/Vector3", [(("X",), linear)])
        turn = message_building.make_message("geometry_msgs/Vector3", [(("Z",), angular)])
        topics.publish(publication, message_building.make_message("geometry_msgs/Twist", [(("LINEAR",), vector), (("ANGULAR",), turn)]))

    begin = perf_counter()
    drive()
    yield "tick, observed, while driving", (perf_counter() - begin) / (20 / 0.016) * 1e6, "-", "80"
    yield "make-message Twist", microseconds(lambda: message_building.make_message("geometry_msgs/Twist")), "4.8", "5"
    twist = message_building.make_message("geometry_msgs/Twist")
    yield "publish to one subscriber", microseconds(lambda: topics.publish(publication, twist)), "17.9 (TCP)", "10"
    set_pen = microseconds(lambda: services.call_service("/turtle1/set_pen", "turtlesim/SetPen"), 500)
    yield "service call to turtlesim", set_pen, "15.8 ms", "50"
    kernel.stop()


def main():
    for backend in ("threads", "greenlet"):
        print(f"{'microseconds, ' + backend:44} {'cramhy':>9} {'CRAM':>12} {'goal':>22}")
        try:
            for name, figure, peer, goal in rows(backend):
                print(f"{name:44} {figure:9.1f} {peer:>12} {goal:>22}")
        except ImportError:
            print("greenlet is not installed")


if __name__ == "__main__":
    main()
