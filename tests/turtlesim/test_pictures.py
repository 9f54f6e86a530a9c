"""Our drawings of turtles, and pictures of the window in pixels and as vectors."""

import json
import math
import re
from xml.etree import ElementTree

import pytest

from cramhy_runtime.turtlesim import drawing, dimensions as measures, pictures, sprites

PEN, GROUND = (179, 184, 255), (69, 86, 255)


PICTURE = {name: skin for name, _, _, _, _, skin, _ in drawing.PICTURES}


def inside(point, polygon):
    """Whether a point lies in a polygon: a ray from it crosses the border an odd number of times."""
    x, y = point
    crossed = False
    for (x1, y1), (x2, y2) in zip(polygon, [*polygon[1:], polygon[0]]):
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            crossed = not crossed
    return crossed


class TestDrawings:
    def test_there_are_fourteen_that_differ_and_go_to_json(self):
        shapes = drawing.shapes()
        assert len(shapes) == measures.DRAWINGS == 14
        assert len({shape["name"] for shape in shapes}) == 14
        assert len({json.dumps(shape["paths"]) for shape in shapes}) == 14
        assert json.loads(json.dumps(shapes)) == shapes

    def test_paths_are_filled_outlines_with_absolute_commands_in_the_unit_box(self):
        for shape in drawing.shapes():
            for path in shape["paths"]:
                assert re.fullmatch(r"#[0-9a-f]{6}", path["fill"])
                assert re.fullmatch(r"M[-.0-9 ]+([LC][-.0-9 ]+)+Z", path["d"])
                for outline in sprites.outlines(path["d"]):
                    assert all(abs(x) <= 0.51 and abs(y) <= 0.51 for x, y in outline)

    def test_a_turtle_looks_ahead(self):
        """The eyes, the last white and the last pupil of the head, are in front of the middle, one on each side."""
        for shape in drawing.shapes():
            pupils = [outline for path in shape["paths"] if path["fill"] == drawing.PUPIL for outline in sprites.outlines(path["d"])]
            assert len(pupils) == 2
            assert all(min(x for x, _ in pupil) > 0.3 for pupil in pupils)

    def test_every_limb_has_a_dark_edge_on_all_sides(self):
        """Of what lies six millimetres beside a limb, on either side of each of its points, nothing is the ground."""
        for shape in drawing.shapes():
            skin = PICTURE[shape["name"]]
            limbs = [outline for path in shape["paths"] if path["fill"] == skin for outline in sprites.outlines(path["d"])]
            edges = [outline for path in shape["paths"] if path["fill"] == drawing.OUTLINE for outline in sprites.outlines(path["d"])]
            for limb in limbs:
                for (x1, y1), (x2, y2) in zip(limb, limb[1:]):
                    length = math.hypot(x2 - x1, y2 - y1)
                    for side in (0.006, -0.006) if length else ():
                        beside = (x1 + x2) / 2 + (y2 - y1) / length * side, (y1 + y2) / 2 - (x2 - x1) / length * side
                        assert any(inside(beside, edge) for edge in edges), (shape["name"], beside)

    @pytest.mark.parametrize("degrees, place", [(0, (1, 0)), (90, (0, -1)), (180, (-1, 0)), (270, (0, 1))])
    def test_a_sprite_turns_with_the_heading(self, degrees, place):
        image = sprites.sprite(0, degrees)
        middle = image.width // 2
        head = image.getpixel((middle + round(19 * place[0]), middle + round(19 * place[1])))
        behind = image.getpixel((middle - round(24 * place[0]), middle - round(24 * place[1])))
        assert head[3] == 255 and behind[3] == 0


def test_the_picture_shows_paper_and_turtle(turtle, tmp_path):
    from PIL import Image

    turtle.teleport(8, 8)
    pictures.save(tmp_path / "window.png", turtle.simulator)
    image = Image.open(tmp_path / "window.png")
    assert image.size == (500, 500)
    assert image.getpixel((300, 198)) == PEN or image.getpixel((300, 199)) == PEN
    assert image.getpixel((0, 0)) == GROUND
    assert image.getpixel((360, 139)) not in (GROUND, PEN)  # the turtle itself


def test_the_svg_shows_the_same_as_vectors(turtle, tmp_path):
    turtle.set_pen(255, 0, 0, 7)
    turtle.teleport(8, 8)
    turtle.call("/spawn", "turtlesim/Spawn", x=2, y=3, theta=0.5, name="other")
    turtle.set_pen(0, 255, 0, 4)
    turtle.call("/turtle1/teleport_relative", "turtlesim/TeleportRelative", linear=0, angular=0.5)
    turtle.teleport(8, 8, 1)
    pictures.save(tmp_path / "window.svg", turtle.simulator)
    text = (tmp_path / "window.svg").read_text()
    root = ElementTree.fromstring(text)
    name = "{http://www.w3.org/2000/svg}"
    assert root.find(f"{name}rect").get("fill") == "#4556ff"
    line, *dots = root.findall(f"{name}path")
    assert (line.get("stroke"), line.get("stroke-width"), line.get("stroke-linecap")) == ("#ff0000", "7", "square")
    assert line.get("d") == "M249.5 249.5L360.0 139.0"
    assert dots[0].get("d").endswith("h.01")
    assert [group.find(f"{name}title").text for group in root.findall(f"{name}g")] == ["other", "turtle1"]
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "")  # nothing from outside


def test_a_turtle_that_is_nowhere_is_left_out_of_the_picture(turtle, tmp_path):
    turtle.drive(float("nan"))
    turtle.teleport(8, 8)
    for ending in ("png", "svg"):
        pictures.save(tmp_path / f"window.{ending}", turtle.simulator)
    assert "<g" not in (tmp_path / "window.svg").read_text()
