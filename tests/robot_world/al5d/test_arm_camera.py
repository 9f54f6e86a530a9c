"""The camera above the table: what it sees, and what it costs."""

from cramhy_runtime import kernel
from cramhy_runtime.robot_world.al5d import pictures

IMAGE = "sensor_msgs/Image"
AWAY = (2.5, 1.57, -1.57, 0, 0, 0)  # the arm points backwards, out of the picture


def colour(message, x, y):
    """The colour of a pixel: which of red, green and blue is by far the strongest, else none."""
    start = (y * message.width + x) * 3
    values = message.data[start : start + 3]
    first, second = sorted(values, reverse=True)[:2]
    return ("red", "green", "blue")[values.index(first)] if first > second + 40 else None


def test_once_a_second_there_is_a_picture_in_which_x_goes_right_and_y_up(table):
    table.send(*AWAY)
    for x, y, name in ((0, 0.17, "red"), (0.08, 0.17, "blue"), (0, 0.23, "green")):
        table.spawn(x, y, colour=name)
    heard, other = table.listen("al5d_external_vision/image_raw", IMAGE), table.listen("external_vision/image_raw", IMAGE)
    kernel.sleep(2.001)
    assert len(heard) == len(other) == 2
    message = heard[-1]
    assert (message.width, message.height, message.encoding, message.step, message.header.frame_id) == (
        640,
        480,
        "rgb8",
        1920,
        "camera_link",
    )
    assert len(message.data) == 640 * 480 * 3
    assert [colour(message, *pixel) for pixel in ((320, 240), (470, 240), (320, 130), (170, 240), (320, 350))] == [
        "red",
        "blue",
        "green",
        None,
        None,
    ]
    assert list(other[-1].data) == list(message.data)


def test_a_picture_that_nobody_looks_at_is_not_drawn(table, monkeypatch):
    drawn = []
    monkeypatch.setattr(pictures, "draw", lambda *arguments: drawn.append(arguments))
    heard = table.listen("al5d_external_vision/image_raw", IMAGE)
    kernel.sleep(5.001)
    assert len(heard) == 5 and not drawn


def test_a_picture_shows_the_world_as_it_was_when_it_was_taken(table):
    table.send(*AWAY)
    table.spawn(0, 0.17)
    heard = table.listen("al5d_external_vision/image_raw", IMAGE)
    kernel.sleep(1.001)
    table.call("clear", "std_srvs/Empty")
    kernel.sleep(1.0)
    assert [colour(message, 320, 240) for message in heard] == ["red", None]
