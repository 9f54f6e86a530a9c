"""A Chromium without a window, pages in it, and sessions that they show.

Without Chromium or Playwright the tests of the page are skipped, with the reason.
"""

from __future__ import annotations

import os
import queue
import shutil
import subprocess
import sys
import threading

import pytest

LIMIT = 60_000  # ms; for a machine that is busy with other things
PATIENCE = 120  # s; the first session of a checkout compiles the language
SLOW = int(os.environ.get("CRAMHY_SLOW_FRAMES", "0"))  # ms by which each frame comes late: finds tests that read what is drawn later
SLOWED = f"""{{
  const real = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => real(draw), {SLOW});
}}"""


def chromium_path():
    """Where Debian, Ubuntu, macOS or the user ($CRAMHY_CHROMIUM) have a Chromium or a Chrome; None when nowhere."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
    return os.environ.get("CRAMHY_CHROMIUM") or next(filter(None, map(shutil.which, names)), None)


@pytest.fixture(scope="session")
def browser():
    """One Chromium for all tests."""
    playwright = pytest.importorskip("playwright.sync_api", reason="the page is tested through playwright: pip install playwright")
    path = chromium_path()
    if path is None:
        pytest.skip("no Chromium is on the PATH to test the page in: apt-get install chromium, or set CRAMHY_CHROMIUM")
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=path, headless=True, args=["--no-sandbox", "--disable-dev-shm-usage"])
        yield chromium
        chromium.close()


@pytest.fixture
def fake():
    """A session without plans."""
    pytest.importorskip("websockets", reason="pip install websockets")
    from fake_session import FakeSession

    made = FakeSession()
    yield made
    made.close()


@pytest.fixture
def visit(browser):
    """A function that opens an address in a fresh profile; it fails the test when the page complains (errors, policy, console).

    A test in which Chromium itself has something to complain of says so: ``page.foresee("404")``."""
    contexts, complaints, foreseen = [], [], []

    def open_page(address, width=1280, height=800, connected=True, **options):
        context = browser.new_context(viewport={"width": width, "height": height}, **options)
        contexts.append(context)
        context.set_default_timeout(LIMIT)
        opened = context.new_page()
        opened.add_init_script(
            "window.violations = []; document.addEventListener('securitypolicyviolation', "
            "(event) => window.violations.push(`${event.violatedDirective} ${event.blockedURI}`));"
        )
        if SLOW:
            opened.add_init_script(SLOWED)
        opened.on("pageerror", lambda error: complaints.append(f"error: {error}"))
        opened.on("console", lambda line: complaints.append(f"console: {line.text}") if line.type == "error" else None)
        opened.foresee = foreseen.append
        opened.goto(address)
        if connected:
            opened.wait_for_selector("#connection[data-state=open]")
            opened.wait_for_selector("#doing:not(:empty)")  # it has the state, so all it subscribed to is heard from now on
        return opened

    yield open_page
    for context in contexts:
        for opened in context.pages:
            assert opened.evaluate("window.violations") == []
        context.close()
    assert [each for each in complaints if not any(words in each for words in foreseen)] == []


class Repl:
    """A REPL that lines are typed into. ``url``: of its page. options: of the command line; with a page from the start, unless ``view`` says
    no. hidden: names of modules that it does not find."""

    def __init__(self, folder, *options, view=True, hidden=()):
        program = f"import sys; sys.modules.update(dict.fromkeys({list(hidden)!r})); from cramhy_runtime.cli import main; sys.exit(main(sys.argv[1:]))"
        environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder), "DISPLAY": "", "WAYLAND_DISPLAY": ""}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        self.process = subprocess.Popen(
            [sys.executable, "-c", program, "repl", *(["--view"] if view else []), *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self.printed = queue.Queue()
        self.text = ""
        threading.Thread(target=self._read, daemon=True).start()
        self.url = next(line for line in self.process.stderr if "http://" in line).split()[-1] if view else None

    def _read(self):
        while text := os.read(self.process.stdout.fileno(), 1 << 16):
            self.printed.put(text.decode())
        self.printed.put(None)

    def type(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def wait_for(self, text):
        """Wait until the REPL has printed it."""
        while text not in self.text:
            self.text += self.printed.get(timeout=PATIENCE) or f"\nIt has ended, and never printed {text}"
            assert "It has ended" not in self.text, self.text

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:  # a plan that a failed test has left paused
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()


@pytest.fixture
def repl(tmp_path):
    pytest.importorskip("uvicorn", reason="pip install 'cramhy[web]'")
    made = []

    def start(*options, **more):
        made.append(Repl(tmp_path, *options, **more))
        return made[-1]

    yield start
    for one in made:
        one.close()
