"""JupyterLab in Chromium, as a user drives it: cells, keys, the turtle while it drives, errors, the stop button, input, a new kernel."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

for module in ("jupyterlab", "nbformat", "ipywidgets"):
    pytest.importorskip(module, reason=f"JupyterLab is driven with it: pip install {module}")

from . import lab  # noqa: E402

CELLS = [
    "(defvar *seven* 7)\n(list 1 *seven*)",
    '%%hy\n(require cramhy *)\n[1 2 {"a" 3}]',
    '(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)\n(in-package :tut)\n(init)',
    "(perform-draw-house)",
    "%pace",
    '(top-level (unwind-protect (progn (format t "begun~%") (loop (send-vel-cmd 1 1) (sleep 0.1))) (send-vel-cmd 0 0) (format t "over~%")))',
    "(mapc",
    '(top-level (par (sleep 5) (seq (sleep 1) (fail \'simple-plan-failure :format-control "lost"))))',
    "(read-line)",
    "cl-user::*seven*",
]


@pytest.mark.soak
def test_a_user_drives_a_notebook_in_jupyterlab(tmp_path):
    with lab.opened(tmp_path, CELLS) as shown:
        assert shown.run(0).endswith("(1 7)")
        assert shown.run(1).endswith('[1 2 {"a" 3}]')
        shown.run(2)
        shown.run(3)
        assert shown.picture(3).startswith("data:image/svg")

        # the turtle drives at the speed of the wall's clock, and its paper and its tasks are shown meanwhile
        shown.run(4)
        shown.has_button("Pause")
        shown.speed("1 x")
        shown.start(5)
        shown.see(5, "waits for the time")
        first = shown.picture(5)
        shown.page.wait_for_function(
            "([number, first]) => document.querySelectorAll('.jp-CodeCell')[number].querySelector('.jp-OutputArea img').src != first",
            arg=[5, first],
        )
        shown.press("Pause")
        shown.has_button("Go on")
        stands = shown.picture(5)
        shown.press("Step")
        shown.page.wait_for_function(
            "([number, first]) => document.querySelectorAll('.jp-CodeCell')[number].querySelector('.jp-OutputArea img').src != first",
            arg=[5, stands],
        )
        shown.press("Go on")
        shown.has_button("Pause")
        shown.command("interrupt-kernel")
        shown.ended(5)
        told = shown.output(5)
        assert "over" in told and "which was interrupted" in told and "evaporated" in told
        shown.speed("as fast as possible")

        assert "mapcar" in shown.keys(6, "Tab", ".jp-Completer")
        shown.page.keyboard.press("Escape")
        assert "FUNCTION" in shown.keys(6, "Shift+Tab", ".jp-Tooltip")
        shown.page.keyboard.press("Escape")

        told = shown.run(7)
        assert "which failed" in told and "SIMPLE-PLAN-FAILURE" in told and "[ABORT]" in told and "evaporated after 1 s" in told

        shown.start(8)
        shown.page.locator(".jp-Stdin-input").fill("hello")
        shown.page.keyboard.press("Enter")
        shown.ended(8)
        assert '"hello"' in shown.output(8)

        shown.command("restart-kernel")
        shown.page.locator(".jp-Dialog .jp-mod-accept").click()
        shown.page.locator(".jp-Dialog").wait_for(state="detached")
        shown.idle()
        assert "unbound" in shown.run(9) or "UNBOUND" in shown.output(9)
