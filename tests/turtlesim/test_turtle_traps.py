"""The traps for whoever writes turtlesim again (turtlesim.md 16), where no law of section 15 is about them already."""

import math
from random import Random

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import services
from cramhy_runtime.ros.messages import service_type_exact
from cramhy_runtime.ros.wire import lisp_float
from cramhy_runtime.turtlesim.canvas import Canvas
from cramhy_runtime.turtlesim.dimensions import METRE
from cramhy_runtime.turtlesim.teleop import Teleop

PEN, GROUND, INK = (179, 184, 255), (69, 86, 255), (1, 2, 3)
WALL = 11.088889122009277


def send(turtle, name, kind, /, **fields):
    """A request that nobody waits for."""
    service = turtle.simulator.graph.services[name]
    services.start_call(service, service_type_exact(kind).request(**fields), lambda call: None)


def painted(width, begin, end):
    """{(column, row), ...} of the pixels that a line between two points, in pixels, paints."""
    canvas = Canvas()
    canvas.line(end[0] / METRE, end[1] / METRE, begin[0] / METRE, begin[1] / METRE, INK, width)
    pixels = canvas.rgb()
    return {(index % 500, index // 500) for index in range(250_000) if pixels[3 * index : 3 * index + 3] == bytes(INK)}


class TestLines:
    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize("width, rows", [(0, {0}), (1, {0}), (2, {-1, 0}), (3, {-1, 0, 1}), (5, {-2, -1, 0, 1, 2})])
    def test_a_line_has_its_width_around_it_and_square_caps(self, width, rows):
        pixels = painted(width, (100, 200), (110, 200))
        assert {row - 200 for _, row in pixels} == rows
        columns = {column for column, _ in pixels}
        assert columns == {column + row for column in range(100, 111) for row in rows}
        assert len(pixels) == len(rows) * len(columns)

    def test_a_line_down_is_a_line_across_turned(self):
        assert painted(4, (200, 100), (200, 130)) == {(row, column) for column, row in painted(4, (100, 200), (130, 200))}

    def test_a_line_is_the_same_in_both_directions(self):
        assert painted(3, (100, 100), (173, 141)) == painted(3, (173, 141), (100, 100))

    @pytest.mark.soak
    def test_a_slanting_line_has_no_holes(self):
        for end in ((171, 113), (113, 171), (29, 171), (131, 29)):
            pixels = painted(1, (100, 100), end)
            longer = max(abs(end[0] - 100), abs(end[1] - 100))
            axis = 0 if abs(end[0] - 100) == longer else 1
            assert {pixel[axis] for pixel in pixels} >= set(range(min(100, end[axis]) + 1, max(100, end[axis])))

    def test_a_line_without_a_length_is_a_dot_as_wide_as_the_pen(self):
        assert painted(3, (100, 100), (100, 100)) == {(column, row) for column in (99, 100, 101) for row in (99, 100, 101)}

    def test_lines_are_clipped_at_the_border_of_the_paper(self):
        assert painted(3, (490, 250), (1e6, 250)) == {(column, row) for column in range(489, 500) for row in (249, 250, 251)}
        assert painted(3, (-1e9, -1e9), (1e9, 1e9)) >= {(number, number) for number in range(500)}
        assert painted(3, (-50, -50), (-10, 600)) == set()

    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize("place", [math.nan, math.inf, -math.inf, 1e308, -1e308])
    def test_a_line_to_nowhere_paints_nothing_and_breaks_nothing(self, place):
        painted(3, (place, 100), (100, 100))
        painted(3, (100, 100), (100, place))
        assert painted(3, (math.nan, 100), (100, 100)) == set()


@pytest.mark.parametrize("pixel, expected", [(249.5, 250), (250.5, 251), (250.49, 250), (-3, 0), (499.4, 499), (700, 499)])
def test_the_sensor_looks_at_the_nearest_pixel_halves_away_from_zero(pixel, expected):
    canvas = Canvas()
    start = (100 * 500 + expected) * 3
    canvas._pixels[start : start + 3] = bytes(INK)
    assert canvas.pixel(pixel / METRE, 100 / METRE) == INK


def test_teleports_of_one_tick_are_all_done_and_all_drawn(turtle):
    for x, y in ((2, 2), (9, 2), (9, 9)):
        send(turtle, "/turtle1/teleport_absolute", "turtlesim/TeleportAbsolute", x=x, y=y)
    kernel.sleep(0.04)
    assert turtle.pose[:2] == (9.0, 9.0)
    paper = turtle.simulator.canvas
    assert paper.pixel(5.5, WALL - 2) == PEN and paper.pixel(9.0, WALL - 5) == PEN


def test_standing_at_the_wall_is_not_hitting_it(turtle):
    turtle.teleport(WALL, WALL)
    turtle.teleport(0, 0)
    assert turtle.pose[:2] == (0.0, 0.0)
    assert not [line for line in turtle.log() if "wall" in line]


def test_a_command_slides_along_the_wall(turtle):
    turtle.teleport(11.0, 5.0, math.pi / 4)
    turtle.drive(2)
    kernel.sleep(1.5)
    assert turtle.pose[0] == WALL
    assert turtle.pose[1] == pytest.approx(5 + 63 * 0.032 * math.sin(math.pi / 4), abs=1e-5)
    assert turtle.pose[2] == pytest.approx(math.pi / 4, abs=1e-6)


def test_a_teleport_is_no_command_and_what_runs_goes_on_from_the_new_place(turtle):
    turtle.drive(1)
    kernel.sleep(0.5)
    turtle.teleport(2, 2)
    kernel.sleep(1)
    assert turtle.pose[:2] == (pytest.approx(2 + 0.016 * (63 - 31), abs=0.04), 2.0)


def test_reset_forgets_a_command_in_flight(turtle):
    turtle.drive(5)
    send(turtle, "/reset", "std_srvs/Empty")
    turtle.drive(5)
    kernel.sleep(0.04)
    assert turtle.pose[3] == 0.0 and turtle.pose[0] == 5.544444561004639


def test_a_reset_turtle_hears_commands_again(turtle):
    turtle.call("/reset", "std_srvs/Empty")
    turtle.drive(1)
    kernel.sleep(0.1)
    assert turtle.pose[3] == 1.0


def test_turtles_are_updated_in_the_order_of_their_names_as_text(turtle):
    read = {}
    for name, y in (("turtle2", 7), ("turtle10", 5)):
        turtle.call("/spawn", "turtlesim/Spawn", x=2, y=y, name=name)
    assert list(turtle.simulator.turtles) == ["turtle1", "turtle10", "turtle2"]
    for name in ("turtle1", "turtle2"):
        turtle.call(f"/{name}/set_pen", "turtlesim/SetPen", off=1)
        turtle.node.subscribe(
            f"/{name}/color_sensor", turtle.simulator.colour_type, lambda colour, name=name: read.update({name: tuple(colour.values())})
        )
    turtle.teleport(2, 6)
    send(turtle, "/turtle10/teleport_absolute", "turtlesim/TeleportAbsolute", x=2, y=8)
    kernel.sleep(0.016)
    assert read == {"turtle1": GROUND, "turtle2": PEN}  # the second one comes after turtle10, and sees what it drew in this tick
    kernel.sleep(0.016)
    assert read == {"turtle1": PEN, "turtle2": PEN}


def test_a_killed_and_spawned_turtle_is_another_one(turtle):
    turtle.set_pen(1, 2, 3, 9)
    before = turtle.simulator.turtles["turtle1"].number
    turtle.call("/kill", "turtlesim/Kill", name="turtle1")
    turtle.call("/spawn", "turtlesim/Spawn", x=2, y=2, name="turtle1")
    spawned = turtle.simulator.turtles["turtle1"]
    assert (spawned.pen_on, spawned.pen_colour, spawned.pen_width) == (True, PEN, 3)
    assert spawned.number != before


def test_who_commands_last_in_a_tick_wins(turtle):
    keys = Teleop()
    turtle.drive(1)
    keys.press("left")
    kernel.sleep(0.04)
    assert turtle.pose[3:] == (0.0, 2.0)
    keys.press("left")
    turtle.drive(1)
    kernel.sleep(0.04)
    assert turtle.pose[3:] == (1.0, 0.0)


def test_set_pen_in_lisp_takes_numbers_and_wraps_them(typed):
    from cramhy_runtime.lisp_core.condition_types import Error

    with pytest.raises(Error):
        typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :off t)')
    typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :r 300 :g -1 :width 256 :off 256)')
    typed("(drive 1 0) (sleep 1.5)")
    assert typed('(sleep 0.1) (pose-of "turtle1")')
    from cramhy_runtime.turtlesim.node import running_simulator

    turtle = running_simulator().turtles["turtle1"]
    assert (turtle.pen_on, turtle.pen_colour, turtle.pen_width) == (True, (44, 255, 0), 1)


@pytest.mark.parametrize(
    "command, pose",
    [
        ((math.nan,), "(:NOT-A-NUMBER :NOT-A-NUMBER 0.0d0 :NOT-A-NUMBER 0.0d0)"),
        ((math.inf,), "(11.088889122009277d0 :NOT-A-NUMBER 0.0d0 :POSITIVE-INFINITY 0.0d0)"),
        ((-math.inf,), "(0.0d0 :NOT-A-NUMBER 0.0d0 :POSITIVE-INFINITY 0.0d0)"),
        ((1e6,), "(11.088889122009277d0 5.544444561004639d0 0.0d0 1000000.0d0 0.0d0)"),
        ((0.0, math.inf), None),
    ],
)
def test_odd_commands_do_what_they_do_and_an_absolute_teleport_mends_it(typed, command, pose):
    names = {"nan": ":not-a-number", "inf": ":positive-infinity", "-inf": ":negative-infinity"}
    words = [names.get(str(value), str(value)) for value in (*command, 0.0)[:2]]
    typed(f"(drive {' '.join(words)}) (sleep 0.1)")
    if pose:
        assert typed('(pose-of "turtle1")') == pose
    typed("(drive 0 0) (sleep 0.1)")
    typed('(call-service "turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" :x 5 :y 5 :theta 1) (sleep 0.1)')
    assert typed.pose() == (5.0, 5.0, 1.0, 0.0, 0.0)


@pytest.mark.parametrize("value", [":not-a-number", ":positive-infinity", ":negative-infinity", "1d30"])
def test_odd_teleports_leave_a_simulator_that_goes_on(typed, value):
    typed(f'(call-service "turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" :x {value} :y {value} :theta {value}) (sleep 0.1)')
    typed(f'(call-service "turtle1/teleport_relative" "turtlesim/TeleportRelative" :linear {value} :angular {value}) (sleep 0.1)')
    typed(f'(call-service "spawn" "turtlesim/Spawn" :x {value} :y {value} :theta {value} :name "odd") (sleep 0.1)')
    typed('(call-service "turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" :x 5 :y 5 :theta 1) (sleep 0.1)')
    assert typed.pose() == (5.0, 5.0, 1.0, 0.0, 0.0)


ODD = (0.0, -0.0, 1.0, -2.5, 3.14159265, 1e-40, 40.0, 1e6, -1e30, 3e38, 1e300, math.inf, -math.inf, math.nan)


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("seed", range(12))
def test_whatever_it_is_told_the_simulator_goes_on(turtle, seed, capsys):
    chance = Random(seed)
    turtle.simulator.keep_history()

    def numbers(*names):
        return {name: lisp_float(chance.choice(ODD)) for name in names}

    for step in range(60):
        names = [*turtle.simulator.turtles, f"t{step}"]
        name = chance.choice(names)
        kind = chance.choice(("drive", "absolute", "relative", "pen", "spawn", "kill", "clear", "reset"))
        if kind == "drive":
            turtle.drive(*[lisp_float(chance.choice(ODD)) for _ in range(3)])
        elif kind == "absolute" and name in turtle.simulator.turtles:
            send(turtle, f"/{name}/teleport_absolute", "turtlesim/TeleportAbsolute", **numbers("x", "y", "theta"))
        elif kind == "relative" and name in turtle.simulator.turtles:
            send(turtle, f"/{name}/teleport_relative", "turtlesim/TeleportRelative", **numbers("linear", "angular"))
        elif kind == "pen" and name in turtle.simulator.turtles:
            pen = {part: chance.randrange(256) for part in ("r", "g", "b", "width", "off")}
            send(turtle, f"/{name}/set_pen", "turtlesim/SetPen", **pen)
        elif kind == "spawn":
            send(turtle, "/spawn", "turtlesim/Spawn", name=name, **numbers("x", "y", "theta"))
        elif kind == "kill":
            send(turtle, "/kill", "turtlesim/Kill", name=name)
        elif kind in ("clear", "reset"):
            send(turtle, f"/{kind}", "std_srvs/Empty")
        kernel.sleep(0.016 * chance.randrange(1, 6))
        for each in turtle.simulator.turtles.values():
            x, y, heading, speed, _ = each.pose()
            assert all(value != value or 0.0 <= value <= WALL for value in (x, y))
            assert speed != speed or speed >= 0.0
            each.colour()
    assert capsys.readouterr().err == ""  # no tick was cut short by an error
    assert turtle.simulator.timer.active
    turtle.call("/reset", "std_srvs/Empty")
    kernel.sleep(0.05)
    assert list(turtle.simulator.turtles) == ["turtle1"]
    assert turtle.simulator.turtles["turtle1"].pose() == (5.544444561004639, 5.544444561004639, 0.0, 0.0, 0.0)
    assert all(math.isfinite(value) for stroke in turtle.simulator.history.strokes for value in stroke[:5])
