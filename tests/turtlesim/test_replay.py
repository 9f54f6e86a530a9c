"""The history of a simulator, and pictures that move: an SVG that any browser plays, and a GIF."""

import math
import sys
from fractions import Fraction
from xml.etree import ElementTree

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import FileError, SimpleError, TypeError_, shown
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.turtlesim import history, pictures, replay
from cramhy_runtime.languages.commonlisp.faces.turtlesim import package
from cramhy_runtime.turtlesim.history import History
from cramhy_runtime.turtlesim.node import start_turtlesim

SVG = "{http://www.w3.org/2000/svg}"
CENTRE, EXTENT = 5.544444561004639, 11.088889122009277


@pytest.fixture
def kept(turtle):
    """A history, and a life: a drive, a clear, a second turtle that is killed, a teleport."""
    found = turtle.simulator.keep_history()
    turtle.drive(1)
    kernel.sleep(1.6)
    turtle.call("/clear", "std_srvs/Empty")
    turtle.call("/spawn", "turtlesim/Spawn", x=2, y=2, name="second")
    turtle.set_pen(255, 0, 0, 5)
    turtle.drive(1, 1)
    kernel.sleep(1.6)
    turtle.call("/kill", "turtlesim/Kill", name="second")
    turtle.teleport(2, 8)
    kernel.sleep(0.8)
    return found


class TestHistory:
    def test_a_turtle_at_rest_is_one_sample(self, turtle):
        kept = turtle.simulator.keep_history()
        kernel.sleep(1.6)
        assert kept.ticks == 100
        (track,) = kept.tracks
        assert track.samples() == [(0, CENTRE, EXTENT - CENTRE, 0.0)]

    def test_a_drive_is_a_sample_per_tick_and_one_of_the_rest_before_it(self, turtle):
        kept = turtle.simulator.keep_history()
        kernel.sleep(0.16)
        turtle.drive(1)
        kernel.sleep(1.6)
        (track,) = kept.tracks
        samples = track.samples()
        assert [tick for tick, *_ in samples] == [0, 10, *range(11, 74)]
        assert samples[1][1:] == samples[0][1:]
        assert samples[-1][1] == pytest.approx(CENTRE + 1.008)
        assert [stroke[0] for stroke in kept.strokes] == list(range(11, 74))

    def test_it_knows_who_came_and_went_and_what_was_cleared(self, kept):
        assert [(track.name, track.begin, track.end) for track in kept.tracks] == [
            ("turtle1", 0, None),
            ("second", pytest.approx(102, abs=1), pytest.approx(204, abs=3)),
        ]
        (first, _, before), (second, _, after) = kept.eras()
        assert (first, second) == (0, pytest.approx(101, abs=1))
        assert {stroke[5] for stroke in before} == {(179, 184, 255)} and {stroke[5] for stroke in after} == {(255, 0, 0)}

    def test_it_begins_with_what_is_on_the_paper(self, turtle):
        turtle.teleport(2, 2)
        kept = turtle.simulator.keep_history()
        assert [stroke[:5] for stroke in kept.strokes] == [(0, *[pytest.approx(value, abs=1e-6) for value in (CENTRE, CENTRE, 2, 2)])]

    def test_there_is_one_per_simulator_and_it_can_stop(self, turtle):
        kept = turtle.simulator.keep_history()
        assert turtle.simulator.keep_history() is kept
        kept.stop()
        kernel.sleep(1)
        assert kept.ticks == 0 and turtle.simulator.observers == ()

    def test_a_turtle_that_is_nowhere_stays_where_it_was_seen_last(self, turtle):
        kept = turtle.simulator.keep_history()
        turtle.drive(math.nan)
        kernel.sleep(1)
        assert len(kept.tracks[0].samples()) == 1

    def test_clears_without_end_are_forgotten_too(self, turtle, monkeypatch):
        monkeypatch.setattr(history, "MOST_SAMPLES", 100)
        monkeypatch.setattr(history, "_LOOK", 64)
        kept = turtle.simulator.keep_history()
        for _ in range(300):
            turtle.simulator.clear()
            kernel.sleep(0.016)
        assert len(kept.clears) < 165

    def test_a_long_one_forgets_its_older_half_but_not_what_is_on_the_paper(self, turtle, monkeypatch):
        monkeypatch.setattr(history, "MOST_SAMPLES", 500)
        monkeypatch.setattr(history, "_LOOK", 64)
        turtle.teleport(1, 1)
        turtle.call("/clear", "std_srvs/Empty")
        kept = turtle.simulator.keep_history()
        turtle.call("/spawn", "turtlesim/Spawn", x=2, y=2, name="short")
        turtle.call("/kill", "turtlesim/Kill", name="short")
        for _ in range(9):
            turtle.drive(1)
            kernel.sleep(1)
        assert kept.ticks < 563 and len(kept.strokes) + len(kept.tracks[0].ticks) <= 600
        assert [track.name for track in kept.tracks] == ["turtle1"]
        assert kept.tracks[0].samples()[0][0] == 0
        ticks = [stroke[0] for stroke in kept.strokes]
        assert ticks == sorted(ticks)
        assert kept.strokes[0][1:3] == pytest.approx((1, 1), abs=1e-6)  # the line still begins where it did
        assert kept.strokes[-1][3] == pytest.approx(turtle.pose[0], abs=1e-6)
        joints = [(before[3], after[1]) for before, after in zip(kept.strokes, kept.strokes[1:])]
        assert all(end == pytest.approx(begin, abs=1e-5) for end, begin in joints)


class TestSvg:
    @pytest.fixture
    def root(self, kept, tmp_path):
        pictures.save(tmp_path / "x.replay.svg")
        text = (tmp_path / "x.replay.svg").read_text()
        assert "<script" not in text and "http" not in text.replace("http://www.w3.org/2000/svg", "")
        return ElementTree.fromstring(text)

    def test_all_animations_are_as_long_as_the_replay_and_well_formed(self, root, kept):
        animations = [element for element in root.iter() if element.tag.startswith(f"{SVG}animate")]
        assert len(animations) > 8
        for animation in animations:
            times = [float(time) for time in animation.get("keyTimes").split(";")]
            assert len(times) == len(animation.get("values").split(";"))
            assert times[0] == 0 and times[-1] == 1 and times == sorted(times)
            assert animation.get("dur") == f"{kept.ticks * 0.016 + 2:.2f}s"
            assert animation.get("repeatCount") == "indefinite"

    def test_without_animation_it_shows_the_end(self, root):
        before, after, *turtles = root.findall(f"{SVG}g")
        assert before.get("display") == "none" and after.get("display") is None
        assert {path.get("stroke") for path in after.findall(f"{SVG}path")} == {"#ff0000"}
        assert {turtle.find(f"{SVG}title").text: turtle.get("display") for turtle in turtles} == {"second": "none", "turtle1": None}
        shown = next(turtle for turtle in turtles if turtle.get("display") is None)
        assert shown.get("transform") == "translate(90.0 139.0)"

    def test_a_line_is_drawn_while_the_turtle_drives_along_it(self, root):
        line = root.findall(f"{SVG}g")[0].find(f"{SVG}path")
        length = float(line.get("pathLength"))
        assert length == pytest.approx(1.008 * 45, abs=0.1)
        drawing = next(child for child in line if child.get("attributeName") == "stroke-dashoffset")
        offsets = [float(value) for value in drawing.get("values").split(";")]
        assert offsets[0] == length and offsets[-1] == 0 and offsets == sorted(offsets, reverse=True)
        assert len(offsets) < 8  # a straight even drive needs no more

    def test_a_turn_over_half_a_circle_does_not_spin_back(self, turtle, tmp_path):
        turtle.simulator.keep_history()
        for _ in range(5):
            turtle.drive(0, 2)
            kernel.sleep(1)
        pictures.save(tmp_path / "x.replay.svg")
        root = ElementTree.fromstring((tmp_path / "x.replay.svg").read_text())
        turns = next(element for element in root.iter(f"{SVG}animateTransform") if element.get("type") == "rotate")
        values = [float(value) for value in turns.get("values").split(";")]
        assert values == sorted(values, reverse=True)
        assert values[-1] == pytest.approx(-math.degrees(10.0), abs=3)


class TestGif:
    @pytest.mark.soak
    def test_it_shows_the_way_and_rests_at_the_end(self, kept, tmp_path):
        from PIL import Image

        pictures.save(tmp_path / "x.gif")
        image = Image.open(tmp_path / "x.gif")
        assert image.size == (500, 500) and image.info["loop"] == 0
        durations = []
        for frame in range(image.n_frames):
            image.seek(frame)
            durations.append(image.info["duration"])
        assert sum(durations) / 1000 == pytest.approx(kept.ticks * 0.016 + 2, abs=0.11)
        assert durations[-1] >= 2000
        assert image.convert("RGB").getpixel((85, 139)) not in ((69, 86, 255), (255, 0, 0))  # the turtle at (2, 8)
        red = [image.convert("RGB").getpixel((170, row)) for row in range(500)]
        assert any(r > 200 and g < 60 for r, g, _ in red)  # the teleport's line

    def test_frames_in_which_nothing_happens_are_one(self, turtle, tmp_path):
        from PIL import Image

        turtle.simulator.keep_history()
        kernel.sleep(10)
        pictures.save(tmp_path / "x.gif")
        assert getattr(Image.open(tmp_path / "x.gif"), "n_frames", 1) == 1


def test_a_long_history_is_shown_faster(turtle):
    kept = turtle.simulator.keep_history()
    kernel.sleep(16)
    assert replay.speed_for(kept) == 1.0
    kernel.sleep(48)
    assert replay.speed_for(kept) == 3.0
    assert replay.speed_for(kept, 0.5) == 0.5


def test_keep_history_counts_for_simulators_that_start_later():
    kernel.start()
    pictures.keep_history()
    simulator = start_turtlesim()
    assert isinstance(simulator.history, History)


class TestMistakes:
    def test_an_ending_that_says_nothing(self, turtle):
        with pytest.raises(SimpleError) as error:
            package.save_picture("house.jpg")
        assert error.value.report() == (
            "What kind of picture is house.jpg to be? A name ends in .png or .svg (the window as it is), in .gif or .replay.svg (a replay)."
        )

    @pytest.mark.parametrize("name, vectors", [("house.png", "house.svg"), ("A.House.GIF", "A.House.replay.svg")])
    def test_pixels_without_pillow(self, turtle, tmp_path, monkeypatch, name, vectors):
        monkeypatch.setitem(sys.modules, "PIL", None)
        monkeypatch.chdir(tmp_path)
        package.record()
        turtle.teleport(8, 8)
        with pytest.raises(SimpleError) as error:
            package.save_picture(name)
        assert error.value.report() == (
            f"The picture {name} has pixels, which the Python package Pillow writes, and Pillow is not installed (for a browser's tab there "
            f"is none). Save it as {vectors}, which needs nothing else."
        )
        package.save_picture(vectors)
        assert (tmp_path / vectors).read_text().startswith("<svg")

    def test_a_replay_of_what_nobody_recorded(self, turtle, tmp_path):
        with pytest.raises(SimpleError) as error:
            package.save_picture("house.gif")
        assert error.value.report() == (
            "There is no history for the replay house.gif, since nobody asked to keep one. Type (turtlesim:record), let the turtle do it "
            "again, and save the replay then."
        )

    def test_a_folder_that_is_not_there(self, turtle):
        for ending in ("png", "svg"):
            with pytest.raises(FileError) as error:
                package.save_picture(f"/no/such/folder/x.{ending}")
            assert error.value.report() == (
                f"The picture /no/such/folder/x.{ending} cannot be written: No such file or directory. "
                "Make its folder first, or choose another one."
            )

    @pytest.mark.parametrize("speed", [0, -1, math.nan, "fast"])
    def test_a_speed_that_is_none(self, turtle, speed, tmp_path):
        package.record()
        with pytest.raises(SimpleError) as error:
            package.save_picture(str(tmp_path / "x.gif"), speed=speed)
        assert error.value.report().startswith("The speed of a replay is a number above zero, such as 2 for twice as fast, but not ")

    @pytest.mark.parametrize("speed", [1e-300, 0.001, Fraction(1, 10**400)])
    def test_a_speed_with_which_it_would_take_hours(self, turtle, speed, tmp_path):
        package.record()
        kernel.sleep(16)
        with pytest.raises(SimpleError) as error:
            pictures.save("x.gif", speed=speed)
        assert error.value.report() == (
            f"At the speed {shown(speed)} the replay x.gif would take longer than 10 minutes. Give a speed of 0.027 or more, or none."
        )
        assert not list(tmp_path.iterdir())

    def test_a_speed_that_no_float_can_hold_is_very_fast(self, turtle, tmp_path):
        package.record()
        kernel.sleep(16)
        package.save_picture(str(tmp_path / "x.replay.svg"), speed=10**400)
        assert 'dur="2.00s"' not in (tmp_path / "x.replay.svg").read_text()  # nothing moves, so nothing is animated

    def test_a_still_picture_has_no_speed(self, turtle, tmp_path):
        with pytest.raises(SimpleError) as error:
            pictures.save("x.png", speed=2)
        assert error.value.report() == (
            "The picture x.png shows the window as it is and has no speed. A name that ends in .gif or .replay.svg gets a replay."
        )

    @pytest.mark.parametrize("thing", [None, 5, sym(":X")])
    def test_what_is_no_name_of_a_file(self, turtle, thing):
        with pytest.raises(TypeError_) as error:
            package.save_picture(thing)
        assert error.value.datum is thing

    def test_no_simulator(self):
        kernel.start()
        with pytest.raises(SimpleError) as error:
            package.save_picture("x.png")
        assert error.value.report() == (
            'No turtlesim is running in this process. It starts with (start-ros-node "name"), or with (turtlesim:start).'
        )


def test_a_picture_is_written_where_open_would_write(typed, tmp_path):
    typed(f'''(let ((*default-pathname-defaults* #p"{tmp_path}/"))
                (turtlesim:save-picture "here.png") (turtlesim:save-picture #p"p.svg"))''')
    assert sorted(path.name for path in tmp_path.iterdir()) == ["here.png", "p.svg"]


def test_a_student_records_a_drive_and_saves_it(typed, tmp_path):
    typed(f"""(turtlesim:record) (drive 1 0) (sleep 1.5)
              (turtlesim:save-picture "{tmp_path}/x.gif") (turtlesim:save-picture "{tmp_path}/x.replay.svg" :speed 2)
              (turtlesim:save-picture "{tmp_path}/x.svg") (turtlesim:save-paper "{tmp_path}/x.png")""")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.gif", "x.png", "x.replay.svg", "x.svg"]
    assert "2 times as fast" in (tmp_path / "x.replay.svg").read_text()
