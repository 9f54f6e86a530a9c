"""Pictures of worlds and movies of runs, without a screen."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.repl.session import Session

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime.robot_world import shown  # noqa: E402
from cramhy_runtime.robot_world.descriptions import Frame, Shape  # noqa: E402
from cramhy_runtime.robot_world.meshes import cone_shape, points_shape  # noqa: E402
from cramhy_runtime.robot_world.pictures import drawing, movies, stills, triangles, views  # noqa: E402
from cramhy_runtime.robot_world.pictures.views import View  # noqa: E402
from cramhy_runtime.robot_world.placements import placement  # noqa: E402
from cramhy_runtime.robot_world.vision import seen  # noqa: E402
from cramhy_runtime.robot_world.world import World  # noqa: E402

RED, GREEN, BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)
AHEAD = views.looking_at((-3.0, 0.0, 1.0), (0.0, 0.0, 1.0))


@pytest.fixture
def empty():
    kernel.start(clock="virtual")
    yield World()
    kernel.stop()


@pytest.mark.parametrize(
    ("shape", "area"),
    [
        (Shape("box", (0.4, 0.4, 0.4)), (0.4 / 2.8) ** 2),
        (Shape("sphere", (0.2,)), np.pi * (0.2 / 2.993) ** 2),
        (Shape("cylinder", (0.2, 0.4)), 0.4 / 2.993 * 0.4 / 2.83),
        (
            Shape("cylinder", (0.2, 0.4), Frame((0, 0, 0), (0.5**0.5, 0.0, 0.5**0.5, 0.0))),
            np.pi * (0.2 / 2.8) ** 2,
        ),  # its end is seen, a disc
        (cone_shape(0.2, 0.4), 0.0095),
        (points_shape([(x, y, z) for x in (-0.2, 0.2) for y in (-0.2, 0.2) for z in (-0.2, 0.2)]), (0.4 / 2.8) ** 2),
    ],
)
def test_each_kind_of_shape_is_as_large_and_as_far_as_it_is(empty, shape, area):
    empty.add_item("it", (shape,), placement((0, 0, 1)), colour=RED)
    drawn = drawing.draw(empty, AHEAD, 201, 201)
    here = drawn.shown == 0
    assert drawn.depths[here].min() == pytest.approx(2.8, abs=6e-3)
    focal = 201 / 2 / np.tan(views.OPENING / 2)  # pixels that 1 m fills 1 m ahead
    assert here.sum() == pytest.approx(area * focal**2, rel=0.05)
    rows, columns = np.nonzero(here)
    assert (rows.min() + rows.max(), columns.mean()) == pytest.approx((200, 100), abs=1.5)
    assert (drawn.colours[here][:, 0] > 0.2).all() and (drawn.colours[here][:, 1:] == 0).all()


def test_what_is_nearer_hides_what_is_behind_and_light_comes_from_above(empty):
    empty.add_item("back", (Shape("box", (0.1, 1.0, 1.0)),), placement((1, 0, 1)), colour=GREEN)
    empty.add_item("front", (Shape("box", (0.4, 0.4, 0.4)),), placement((0, 0, 1)), colour=RED)
    drawn = drawing.draw(empty, views.looking_at((-3, 0, 2), (0, 0, 1)), 120, 90)
    assert drawn.shown[45, 60] == 1 and {0, 1} <= set(drawn.shown.ravel())
    front = drawn.colours[drawn.shown == 1][:, 0]
    assert len(set(np.round(front, 2))) > 1  # the top is brighter than the side


def test_a_camera_inside_of_a_thing_or_beside_it_sees_a_picture(empty):
    empty.add_item("room", (Shape("box", (8.0, 8.0, 4.0)),), placement((0, 0, 1)), colour=BLUE)
    empty.add_item("column", (Shape("cylinder", (5.0, 4.0)),), placement((0, 0, 1)), colour=RED)
    empty.add_item("ball", (Shape("sphere", (5.0,)),), placement((0, 0, 1)), colour=RED)
    drawn = drawing.draw(empty, AHEAD, 40, 30)
    assert np.isfinite(drawn.colours).all() and (drawn.shown[0] >= 0).all()


def test_an_empty_world_has_a_floor_and_a_sky(empty):
    drawn = drawing.draw(empty, views.overview(empty), 40, 30)
    assert set(drawn.shown.ravel()) <= {drawing.FLOOR, drawing.SKY} and np.isfinite(drawn.colours).all()
    level = drawing.draw(empty, AHEAD, 40, 30)
    assert set(level.shown.ravel()) == {drawing.FLOOR, drawing.SKY}


@pytest.mark.soak
def test_the_overview_has_all_things_in_it_and_the_same_world_gives_the_same_pixels(world):
    world.add_item("bottle", (Shape("cylinder", (0.1, 0.4)),), placement((-2, -0.9, 1.0)), colour=RED)
    one, other = (stills.picture(world, None, 80, 60, 1) for _ in range(2))
    assert one.tobytes() == other.tobytes()
    drawn = drawing.draw(world, views.overview(world), 160, 120)
    seen_things = {drawn.solids[number].thing.name for number in set(drawn.shown.ravel()) if number >= 0}
    assert seen_things == {"kitchen", "pr2", "bottle"}
    edge = np.concatenate([drawn.shown[0], drawn.shown[-1], drawn.shown[:, 0], drawn.shown[:, -1]])
    assert (edge < 0).all()


def test_the_robots_camera_sees_in_a_picture_what_it_sees_by_rays(world):
    world.bend("pr2", {"torso_lift_joint": 0.3})
    camera = world.link("pr2", "high_def_optical_frame")
    world.add_item("bottle", (Shape("cylinder", (0.05, 0.2)),), camera @ placement((0, -0.1, 1.2)), colour=RED)
    drawn = drawing.draw(world, views.robots_view(world), 320, 200)
    assert seen(world.scene, camera, world.item("bottle"))[0] == 1.0
    here = [drawn.solids[number].thing.name for number in drawn.shown[drawn.shown >= 0]]
    assert here.count("bottle") > 100
    with pytest.raises(ValueError, match="there is no camera tail_frame; there are high_def_optical_frame"):
        views.robots_view(world, "tail_frame")


@pytest.mark.parametrize("eye, target", [((0, 0, 1), (0, 0, 1)), ((0, 0, float("nan")), (0, 0, 1)), ((0, 0, 1), (0, 0, float("inf")))])
def test_a_camera_that_looks_nowhere_is_refused(eye, target):
    with pytest.raises(ValueError, match="camera"):
        views.looking_at(eye, target)


def test_straight_down_is_a_view(empty):
    drawn = drawing.draw(empty, views.looking_at((0, 0, 3), (0, 0, 0)), 10, 10)
    assert (drawn.depths == pytest.approx(3)) and (drawn.shown == drawing.FLOOR).all()


# ---------------------------------------------------------------------------------------------------------------------- movies


def test_a_movie_shows_each_motion_though_no_time_passes_and_changes_nothing(world):
    shown.show(world)
    movie = movies.Movie(view=AHEAD, width=32, height=24)
    movie.begin()
    world.bend("pr2", {"torso_lift_joint": 0.3})  # two joints that move one after the other: one motion
    world.bend("pr2", {"head_tilt_joint": 0.5})
    world.put("pr2", placement((1, 0, 0)))
    world.copy().put("pr2", placement((9, 9, 0)))  # who looks ahead is in no movie
    world.put("pr2", placement((1, 0, 0)))  # nothing moves
    world.bend("pr2", {"head_tilt_joint": 0.0})
    movie.end()
    world.put("pr2", placement((5, 0, 0)))
    shown.show(None)
    machine = [note.machine("pr2") for note in movie.notes]
    assert [each.joint("head_tilt_joint") for each in machine] == [0.0, 0.5, 0.5, 0.0]
    assert [each.placement.position[0] for each in machine] == [0, 0, 1, 1]
    frames = list(movie.frames())
    drive = [frame.machine("pr2").placement.position[0] for frame in frames]
    assert drive == sorted(drive) and len(set(drive)) == 11  # a metre, a second, ten frames


def test_what_is_held_is_in_the_hand_in_every_frame(world):
    shown.show(world)
    world.add_item("cup", (Shape("box", (0.1, 0.1, 0.1)),), world.link("pr2", "r_gripper_tool_frame"))
    world.attach("pr2", "cup", "r_gripper_tool_frame")
    movie = movies.Movie()
    movie.begin()
    world.bend("pr2", {"r_shoulder_pan_joint": -1.0})
    movie.end()
    shown.show(None)
    for frame in movie.frames():
        assert frame.item("cup").placement.near(frame.link("pr2", "r_gripper_tool_frame"), 1e-9, 1e-6)


def test_notes_and_frames_have_an_end(empty, monkeypatch):
    monkeypatch.setattr(movies, "MOST_NOTES", 20)
    empty.add_item("it", (Shape("box", (0.1, 0.1, 0.1)),))
    shown.show(empty)
    movie = movies.Movie(most_frames=30)
    movie.begin()
    for step in range(200):
        empty.put("it", placement((step % 7, 0, 0)))
    movie.end()
    shown.show(None)
    assert len(movie.notes) <= 21 and len(list(movie.frames())) == 31
    assert movie.notes[-1].item("it").placement.position[0] == 199 % 7


# --------------------------------------------------------------------------------------------------------------------- in Lisp

WORLD = """
(defparameter *world* (robot-world:make-world))
(defun at (x y z &optional (turn (cl-transforms:make-identity-rotation)))
  (cl-transforms:make-pose (cl-transforms:make-3d-vector x y z) turn))
(robot-world:add-description *world* 'pr2 (robot-world:read-description (robot-world:description-text :pr2)) (at 0 0 0))
(robot-world:add-object-of-type *world* 'bottle :bottle (at 1 0 0.1) :color '(1 0 0))
"""


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.evaluate_text(WORLD)
    yield made
    kernel.stop()


def test_save_picture_writes_a_png_from_each_camera(session, tmp_path):
    for number, camera in enumerate(
        (
            "nil",
            ":robot",
            '"wide_stereo_optical_frame"',
            "'((1 1 1) (0 0 1))",
            "(at -2 0 1 (cl-transforms:make-quaternion 0.5 0.5 0.5 0.5))",
        )
    ):
        path = tmp_path / f"{number}.png"
        session.evaluate_text(f'(robot-world:save-picture *world* "{path}" :camera {camera} :width 40 :height 30)')
        with Image.open(path) as picture:
            assert (picture.format, picture.size) == ("PNG", (40, 30))


@pytest.mark.parametrize(
    ("form", "text"),
    [
        (
            '(robot-world:save-picture *world* "kitchen.gif")',
            "What kind of picture is kitchen.gif to be? The name of a picture of a world ends in .png. An animation of a run, .gif, is made by "
            "btr:with-movie.",
        ),
        (
            '(robot-world:save-picture *world* "kitchen")',
            "What kind of picture is kitchen to be? The name of a picture of a world ends in .png.",
        ),
        (
            '(robot-world:save-picture *world* "k.png" :camera "eye")',
            "There is no picture from there: there is no camera eye; there are high_def_optical_frame,",
        ),
        ('(robot-world:save-picture *world* "k.png" :camera 7)', "7 is no camera. A camera is :ROBOT, the name of a camera link, a pose"),
        (
            '(robot-world:save-picture *world* "k.png" :camera \'((1 2) (0 0 0)))',
            "There is no picture from there: a place is a list of three numbers",
        ),
        (
            '(robot-world:save-picture *world* "k.png" :camera \'((1 2 3) (1 2 3)))',
            "There is no picture from there: a camera at (1.0, 2.0, 3.0) cannot look",
        ),
        (
            '(robot-world:save-picture *world* "k.png" :width 0)',
            "The picture k.png cannot be drawn: a picture has from 1 to 16777216 pixels; 0 x 960 is none.",
        ),
        ('(robot-world:save-picture *world* "k.png" :width 1.5)', "A picture is so many pixels wide and high, an integer, but not 1.5."),
        ('(robot-world:save-picture *world* "/nowhere/k.png" :width 4 :height 3)', "The picture /nowhere/k.png cannot be written: "),
        (
            '(btr:with-movie ("run.png") (error "never run"))',
            "What kind of movie is run.png to be? The name of a movie of a world ends in .gif.",
        ),
        (
            '(robot-world:save-picture (robot-world:make-world) "k.png" :camera :robot)',
            "There is no picture from there: no robot of the world has a camera",
        ),
    ],
)
def test_pictures_that_cannot_be_are_errors_that_say_why(session, form, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Condition) as caught:
        session.evaluate_text(form)
    assert caught.value.report().startswith(text)
    assert list(tmp_path.iterdir()) == []


def nearest_of_all(corners, rays, pixels):
    """As `triangles.meet`, but each ray is compared with each triangle, whose plane and sides are computed anew."""
    ways = rays.through(pixels, np.eye(3)).T
    found = np.full((len(corners), len(pixels)), np.inf)
    for number, (corner, second, third) in enumerate(corners):
        one, other = second - corner, third - corner
        across, beyond = np.cross(ways, other), np.cross(-corner, one)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / (across @ one)
            u, v, along = (across @ -corner) * inverse, (ways @ beyond) * inverse, (beyond @ other) * inverse
            hit = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (along > triangles.NEAR)
        found[number] = np.where(hit, along, np.inf)
    return found.min(axis=0), found.argmin(axis=0)


@pytest.mark.parametrize("seed", range(6))
def test_rays_meet_the_triangles_at_their_pixels_as_they_would_meet_all(seed):
    """Small and large triangles, ahead of the camera, behind it and across it; some of them lines."""
    random = np.random.default_rng(seed)
    middles = random.uniform((-2, -2, -0.5), (2, 2, 3), (60, 1, 3))
    corners = middles + random.uniform(-1, 1, (60, 3, 3)) * random.choice([0.01, 0.2, 1.0], (60, 1, 1), p=[0.5, 0.4, 0.1])
    corners[::10, 2] = corners[::10, 1]
    part, rays = (slice(3, 41), slice(7, 50)), views.Rays(View(np.zeros(3), np.eye(3)), 64, 48)
    pixels = np.arange(64 * 48).reshape(48, 64)[part].ravel()
    if seed % 2:  # not all of them are asked for
        pixels = pixels[random.random(len(pixels)) < 0.5]
    depths, numbers = triangles.meet(corners, rays, part, pixels)
    wanted, those = nearest_of_all(corners, rays, pixels)
    assert depths == pytest.approx(wanted) and (numbers[np.isfinite(depths)] == those[np.isfinite(wanted)]).all()
    assert np.isfinite(depths).sum() > 20


def test_a_fine_mesh_costs_what_its_pixels_cost(monkeypatch):
    compared = []
    each = triangles._meet_each  # noqa: SLF001
    monkeypatch.setattr(triangles, "_meet_each", lambda planes, across, down: compared.append(len(down)) or each(planes, across, down))
    line = np.linspace(-0.5, 0.5, 101)
    x, y = (part.ravel() for part in np.meshgrid(line[:-1], line[:-1]))
    square = np.array([[0, 0], [0.01, 0], [0, 0.01]])
    corners = np.concatenate([np.stack([x, y], axis=1)[:, None] + square, np.full((10_000, 3, 1), 2.0)], axis=2)
    depths, _ = triangles.meet(corners, views.Rays(AHEAD, 200, 200), (slice(0, 200), slice(0, 200)), np.arange(200 * 200))
    assert 5_000 < np.isfinite(depths).sum() <= sum(compared) < 40_000  # of 400 million pairs


def test_where_nothing_ends_a_smooth_picture_is_the_plain_one_and_edges_are_means(empty):
    empty.add_item("front", (Shape("box", (0.4, 0.4, 0.4)),), placement((0, 0, 1)), colour=RED)
    view = views.looking_at((-3, 0.4, 2), (0, 0, 1))
    plain, smooth, fine = drawing.draw(empty, view, 60, 45), drawing.draw(empty, view, 60, 45, 2), drawing.draw(empty, view, 120, 90)
    assert (plain.shown == smooth.shown).all() and (plain.depths == smooth.depths).all()
    means = fine.colours.reshape(45, 2, 60, 2, 3).mean(axis=(1, 3))
    assert np.abs(smooth.colours - means).max() < 0.05  # as if all had been painted in pieces
    assert len(np.unique(smooth.colours.reshape(-1, 3), axis=0)) > len(np.unique(plain.colours.reshape(-1, 3), axis=0))


def test_a_smooth_picture_paints_in_pieces_only_what_is_at_edges(empty, monkeypatch):
    painted = []
    paint = drawing._Canvas.paint  # noqa: SLF001
    monkeypatch.setattr(drawing._Canvas, "paint", lambda *given: painted.append(len(given[2])) or paint(*given))  # noqa: SLF001
    empty.add_item("ball", (Shape("sphere", (1.0,)),), placement((0, 0, 1)), colour=RED)
    drawing.draw(empty, views.looking_at((-3, 0, 1), (0, 0, 1)), 320, 240, 2)
    whole, pieces = painted
    assert whole == 320 * 240 and 0 < pieces < 0.2 * 4 * whole


def test_a_box_that_ends_behind_the_camera_is_looked_for_where_it_may_be_seen(empty):
    """A wall at the right of the camera fills the right of the picture."""
    empty.add_item("wall", (Shape("box", (8.0, 0.2, 4.0)),), placement((-3, -1.5, 1)), colour=RED)
    drawn = drawing.draw(empty, AHEAD, 200, 100)
    columns = np.nonzero(drawn.shown == 0)[1]
    assert columns.max() == 199 and 120 < columns.min() < 180
    nearest, (rows, asked) = drawing._near(drawn.solids[0], AHEAD, 200, 100)  # noqa: SLF001
    assert nearest < 0.03 and 120 < asked.start <= columns.min() and asked.stop == 200
