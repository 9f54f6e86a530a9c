"""A Chromium without a window, for the tests of the page. Without Chromium or Playwright they are skipped, with the reason."""

from __future__ import annotations

import os
import shutil
from contextlib import contextmanager

import pytest


def chromium_path():
    """Where Debian, Ubuntu, macOS or the user ($CRAMHY_CHROMIUM) have a Chromium or a Chrome; None when nowhere."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
    return os.environ.get("CRAMHY_CHROMIUM") or next(filter(None, map(shutil.which, names)), None)


class _Driver:
    """The one driver of Playwright's of this process: a second one would not start while it runs."""

    running, users = None, 0


@contextmanager
def _driver(playwright):
    if not _Driver.users:
        _Driver.running = playwright.sync_playwright().start()
    _Driver.users += 1
    try:
        yield _Driver.running
    finally:
        _Driver.users -= 1
        if not _Driver.users:
            _Driver.running.stop()


@contextmanager
def chromium():
    """A Chromium of Playwright's, which ends with the block."""
    playwright = pytest.importorskip("playwright.sync_api", reason="the page is tested through playwright: pip install playwright")
    path = chromium_path()
    if path is None:
        pytest.skip("no Chromium is on the PATH to test the page in: apt-get install chromium, or set CRAMHY_CHROMIUM")
    with _driver(playwright) as driver:
        started = driver.chromium.launch(executable_path=path, headless=True, args=["--no-sandbox", "--disable-dev-shm-usage"])
        yield started
        started.close()
