"""A Chromium without a window, and pages in it. Without Chromium or Playwright the tests of the page are skipped, with the reason."""

from __future__ import annotations

import os
import shutil

import pytest

LIMIT = 60_000  # ms; for a machine that is busy with other things
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
        opened.add_init_script("window.violations = []; document.addEventListener('securitypolicyviolation', "
                               "(event) => window.violations.push(`${event.violatedDirective} ${event.blockedURI}`));")
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
