"""axe-core finds nothing to complain of, in any theme, on a desktop and a phone; motion and live regions are quiet."""

from __future__ import annotations

import shutil
import subprocess

import pytest
from test_page import wait_for_text
from test_page_access import filled
from test_page_room import kitchen

VERSION = "4.14.1"
LIVE = """() => [...document.querySelectorAll("[aria-live], [role=status], [role=alert], [role=log], [role=timer], output")]
    .filter((node) => !["log", "timer"].includes(node.getAttribute("role")) && node.getAttribute("aria-live") !== "off").map(({ id }) => id)"""


@pytest.fixture(scope="session")
def axe(request):
    """The text of axe-core; it is fetched by npm once, and kept beside pytest's own cache."""
    folder = request.config.cache.mkdir(f"axe-core-{VERSION}")
    path = folder / "node_modules" / "axe-core" / "axe.min.js"
    if not path.exists():
        npm = shutil.which("npm")
        if npm is None:
            pytest.skip("axe-core is not there, and no npm is on the PATH to fetch it")
        words = [npm, "install", "--silent", "--no-audit", "--no-fund", "--prefix", str(folder), f"axe-core@{VERSION}"]
        try:
            subprocess.run(words, capture_output=True, timeout=120)
        except subprocess.TimeoutExpired:
            pass
        if not path.exists():
            pytest.skip(f"axe-core {VERSION} is not there, and npm could not fetch it")
    return path.read_text()


@pytest.mark.soak
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(fake, visit, axe, scheme):
    page = visit(fake.address, color_scheme=scheme)
    page.evaluate(axe)
    look = lambda: page.evaluate("async () => (await axe.run()).violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)])")  # noqa: E731
    assert look() == []  # before anything has happened
    filled(fake)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    wait_for_text(page, "#log", "Clamping")
    for _ in range(2):  # and then for a projector
        for width, height in ((1280, 800), (390, 844)):
            page.set_viewport_size({"width": width, "height": height})
            assert look() == []
        page.locator("#projector").click()
    kitchen(fake)  # and the robot's room
    page.wait_for_selector("#room")
    for width, height in ((1280, 800), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        if width > 1000:
            page.get_by_role("button", name="bottle").click()
        else:
            page.locator("#turtle-tab").click()
        assert look() == []


@pytest.mark.soak
def test_axe_would_find_something(fake, visit, axe):
    page = visit(fake.address)
    page.evaluate(axe)
    page.evaluate("() => document.getElementById('step-size').parentElement.replaceWith(document.getElementById('step-size'))")
    assert "select-name" in page.evaluate("async () => (await axe.run()).violations.map(({ id }) => id)")


@pytest.mark.soak
def test_what_is_read_out_changes_seldom(fake, visit):
    page = visit(fake.address)
    assert page.evaluate(LIVE) == ["connection", "banner", "notice"]
    page.evaluate("""() => {
      window.said = [];
      for (const id of ["connection", "banner", "notice"]) {
        new MutationObserver(() => said.push(id)).observe(document.getElementById(id), { childList: true, characterData: true, subtree: true });
      }
    }""")
    filled(fake)
    fake.drive(50, speed=2.0)
    for number in range(100):
        fake.say(f"line {number}")
    wait_for_text(page, "#log", "line 99")
    assert page.evaluate("() => said") == []


@pytest.mark.soak
@pytest.mark.parametrize("motion", ["reduce", "no-preference"])
def test_nothing_moves_by_itself_for_those_who_do_not_want_it(fake, visit, motion):
    page = visit(fake.address, reduced_motion=motion)
    filled(fake)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    page.locator("#tasks [aria-current=true]").first.wait_for()
    moving = page.evaluate("() => document.getAnimations().length")
    assert (moving == 0) == (motion == "reduce")
