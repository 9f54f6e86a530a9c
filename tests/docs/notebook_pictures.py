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
    "(top-level\n  (pursue (sleep 3)\n    (loop (send-vel-cmd 1 1) (sleep 0.5))))",
    "%watch off",
    "(cut:force-ll (prolog:prolog '(member ?colour (red green blue))))",
    "(let ((motion (desig:a motion (type driving) (speed 1.5) (angle 5))))\n  (reference motion)\n  motion)",
    '(roslisp:make-message "geometry_msgs/Twist" (:x :linear) 1.5)',
    "(prolog:def-fact-group kitchen (graspable)\n  (prolog:<- (graspable ?x) (member ?x (cup bottle)) (empty ?x)))\n"
    "(prolog:explain '(graspable cup))",
    '(top-level\n  (par (sleep 5)\n       (seq (sleep 1) (fail \'simple-plan-failure :format-control "lost"))))',
]


def save(name, image):
    """Save an image as PNG with few colours, so that it stays small."""
    image.quantize(COLOURS, dither=0).save(PLACE / name, optimize=True)


def cells(shown, first, last):
    """The picture of the cells from ``first`` to ``last``, one below the other."""
    from PIL import Image

    taken = [Image.open(io.BytesIO(shown.cell(number).screenshot())) for number in range(first, last + 1)]
    whole = Image.new("RGB", (max(each.width for each in taken), sum(each.height for each in taken)), "white")
    top = 0
    for each in taken:
        whole.paste(each, (0, top))
        top += each.height
    return whole


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
        save("notebook-values.png", cells(shown, 6, 9))
        save("notebook-failure.png", cells(shown, 10, 10))


if __name__ == "__main__":
    take()
