"""Take the pictures of the page about notebooks anew: ``python tests/docs/notebook_pictures.py``.

They are taken of JupyterLab in Chromium, which the small environments do not have: ``pip install jupyterlab ipywidgets`` first.
"""

from __future__ import annotations

import io
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.jupyter import lab  # noqa: E402

PLACE = Path(__file__).parents[2] / "docs" / "how-to"
COLOURS = 48
CELLS = [
    '(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)\n(in-package :tut)\n(init)',
    "%pace",
    "(top-level\n  (pursue (sleep 6)\n    (loop (send-vel-cmd 2 1) (sleep 0.5))))",
    "%watch *turtle-pose*",
    "(perform-draw-house)",
    "(force-ll (prolog '(member ?colour (red green blue))))",
    "(let ((motion (a motion (type driving) (speed 1.5) (angle 5))))\n  (reference motion)\n  motion)",
    '(roslisp:make-message "geometry_msgs/Twist" (:x :linear) 1.5)',
    "(prolog:explain '(desig:motion-grounding 1 ?what))",
    '(top-level\n  (par (sleep 5)\n       (seq (sleep 1) (fail \'simple-plan-failure :format-control "lost"))))',
]


def save(name, data):
    """Save a PNG with few colours, so that it stays small."""
    from PIL import Image

    Image.open(io.BytesIO(data)).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(PLACE / name, optimize=True)


def cells(shown, first, last):
    """The picture of the cells from ``first`` to ``last``."""
    boxes = [shown.cell(number).bounding_box() for number in range(first, last + 1)]
    left, top = min(box["x"] for box in boxes), min(box["y"] for box in boxes)
    right, below = max(box["x"] + box["width"] for box in boxes), max(box["y"] + box["height"] for box in boxes)
    return shown.page.screenshot(clip={"x": left, "y": top, "width": right - left, "height": below - top})


def take():
    """Take all pictures."""
    with tempfile.TemporaryDirectory() as folder, lab.opened(folder, CELLS) as shown:
        shown.page.set_viewport_size({"width": 1000, "height": 5000})  # so that no cell is out of sight
        shown.run(0)
        shown.run(1)
        shown.has_button("Pause")
        shown.speed("2 x")
        shown.start(2)
        shown.see(2, "4.")
        shown.press("Pause")
        shown.has_button("Go on")
        shown.picture(2)
        save("notebook-live.png", cells(shown, 1, 2))
        shown.speed("as fast as possible")
        shown.press("Go on")
        shown.ended(2)
        for number in range(3, len(CELLS)):
            shown.run(number)
        save("notebook-fluents.png", cells(shown, 3, 4))
        save("notebook-values.png", cells(shown, 5, 8))
        save("notebook-failure.png", cells(shown, 9, 9))


if __name__ == "__main__":
    take()
