"""JupyterLab in a Chromium without a window: a server of its own, one notebook, and what a user does with cells and keys.

JupyterLab is large, so no extra of cramhy's brings it: what uses this file is skipped where it is missing (``pip install jupyterlab``).
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from browsers import chromium  # noqa: E402

PATIENCE = 180_000  # ms for what comes; each step goes on as soon as it is there
SIZE = {"width": 1000, "height": 900}


def notebook_file(path, cells):
    """Write a notebook with cells of code."""
    import nbformat.v4 as made
    import nbformat

    spec = {"name": "cramhy", "display_name": "CRAM (Common Lisp, Hy)", "language": "common-lisp"}
    written = made.new_notebook(cells=[made.new_code_cell(text) for text in cells], metadata={"kernelspec": spec})
    nbformat.write(written, path)


@contextmanager
def server(folder):
    """The address of a JupyterLab that serves ``folder``, with its settings below it, until the block ends."""
    from cramhy_runtime.jupyter import kernelspec

    home = Path(folder) / ".jupyter-home"
    settings = home / "settings" / "@jupyterlab"
    for name, value in (
        ("notebook-extension/tracker", {"windowingMode": "none"}),
        ("apputils-extension/notification", {"fetchNews": "false"}),
    ):
        path = settings / f"{name}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(value))
    kernelspec.install(prefix=home / "env")
    places = {"JUPYTER_CONFIG_DIR": home / "config", "JUPYTER_RUNTIME_DIR": home / "runtime", "JUPYTER_DATA_DIR": home / "data"}
    places |= {"JUPYTER_PATH": home / "env" / "share" / "jupyter", "JUPYTERLAB_SETTINGS_DIR": home / "settings"}
    words = [sys.executable, "-m", "jupyterlab", "--no-browser", "--IdentityProvider.token=", f"--ServerApp.root_dir={folder}"]
    words += ["--allow-root", "--ServerApp.port=0", "--LabApp.news_url=", "--ServerApp.log_level=INFO"]
    environment = {**os.environ, **{name: str(place) for name, place in places.items()}, "PYTHONDONTWRITEBYTECODE": ""}
    started = subprocess.Popen(words, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True)
    try:
        for line in started.stderr:
            if found := re.search(r"(http://(?:127\.0\.0\.1|localhost):[1-9]\d*)/lab", line):
                break
        else:
            raise AssertionError("JupyterLab has not begun")
        with open(home / "log", "wb") as log:
            subprocess.Popen(["cat"], stdin=started.stderr, stdout=log)  # it ends with the server
        yield found[1]
    finally:
        started.terminate()
        started.wait(60)


class Lab:
    """A page of JupyterLab with one notebook open."""

    def __init__(self, page, address, name):
        self.page = page
        page.set_default_timeout(PATIENCE)
        page.goto(f"{address}/lab/tree/{name}?reset")
        page.wait_for_selector(".jp-Notebook .jp-CodeCell")
        self.idle()

    def idle(self):
        """Wait until the kernel does nothing."""
        self.page.locator("#jp-main-statusbar", has_text="| Idle").wait_for()

    def cell(self, number):
        return self.page.locator(".jp-Notebook .jp-CodeCell").nth(number)

    def focus(self, number):
        """The cursor stands at the end of a cell."""
        self.cell(number).locator(".cm-content").click()
        self.page.keyboard.press("Control+End")

    def start(self, number):
        """Run a cell, and do not wait."""
        self.focus(number)
        self.page.keyboard.press("Control+Enter")

    def run(self, number):
        """Run a cell until it has ended; its output as text."""
        self.start(number)
        self.ended(number)
        return self.output(number)

    def ended(self, number):
        self.page.wait_for_function(
            """number => /\\[\\d+\\]/.test(document.querySelectorAll('.jp-Notebook .jp-CodeCell')[number].querySelector('.jp-InputPrompt').textContent)""",
            arg=number,
        )

    def output(self, number):
        return self.cell(number).locator(".jp-OutputArea").inner_text()

    def see(self, number, text):
        """Wait until the output of a cell contains ``text``."""
        self.cell(number).locator(".jp-OutputArea", has_text=text).wait_for()

    def picture(self, number):
        """Wait until the output of a cell has a picture, and return where it comes from."""
        return self.cell(number).locator(".jp-OutputArea img").first.get_attribute("src")

    def command(self, name):
        """Press a button of the notebook's toolbar, such as ``interrupt-kernel``."""
        self.page.locator(f'[data-command="notebook:{name}"]').first.click()

    def press(self, label):
        """Press a button of a widget."""
        self.page.locator(".jupyter-widgets button", has_text=label).click()

    def has_button(self, label):
        """Wait until there is a button of a widget with this label."""
        self.page.locator(".jupyter-widgets button", has_text=label).wait_for()

    def speed(self, label):
        """Choose a speed in the controls of time."""
        self.page.locator(".jupyter-widgets select").select_option(label)

    def keys(self, number, keys, seen):
        """Press ``keys`` at the end of a cell, and return the text of what then appears, a CSS selector."""
        self.focus(number)
        self.page.keyboard.press(keys)
        shown = self.page.locator(seen)
        shown.wait_for()
        return shown.inner_text()


@contextmanager
def opened(folder, cells, name="cells.ipynb"):
    """A `Lab` with a notebook of these cells in ``folder``."""
    notebook_file(Path(folder) / name, cells)
    with server(folder) as address, chromium() as browser:
        page = browser.new_page(viewport=SIZE)
        yield Lab(page, address, name)
