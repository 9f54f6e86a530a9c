"""Browsers without a window, for the tests of the page. Where one is missing, or Playwright, a test is skipped, with the reason."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

import pytest

CHROMIUM = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FIREFOX = ("firefox", "firefox-esr")
KINDS = ("chromium", "firefox")


def _found(variable, names):
    return os.environ.get(variable) or next(filter(None, map(shutil.which, names)), None)


def chromium_path():
    """Where Debian, Ubuntu, macOS or the user ($CRAMHY_CHROMIUM) have a Chromium or a Chrome; None when nowhere."""
    return _found("CRAMHY_CHROMIUM", CHROMIUM)


def firefox_path():
    """Where Debian, Ubuntu or the user ($CRAMHY_FIREFOX) have a Firefox; None when nowhere."""
    return _found("CRAMHY_FIREFOX", FIREFOX)


class _Driver:
    """The one driver of Playwright's of this process: a second one would not start while it runs."""

    running, users = None, 0


@contextmanager
def _driver():
    playwright = pytest.importorskip("playwright.sync_api", reason="the page is tested through playwright: pip install playwright")
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
    path = chromium_path()
    if path is None:
        pytest.skip("no Chromium is on the PATH to test the page in: apt-get install chromium, or set CRAMHY_CHROMIUM")
    with _driver() as driver:
        started = driver.chromium.launch(executable_path=path, headless=True, args=["--no-sandbox", "--disable-dev-shm-usage"])
        yield started
        started.close()


@contextmanager
def firefox():
    """A Firefox as its distributor made it, driven by Playwright over WebDriver BiDi. It ends with the block."""
    path = firefox_path()
    if path is None:
        pytest.skip("no Firefox is on the PATH to test the page in: apt-get install firefox-esr, or set CRAMHY_FIREFOX")
    with tempfile.TemporaryDirectory() as folder, _driver() as driver:
        program = Path(folder) / "firefox"
        relay = Path(__file__).with_name("firefox_relay.py")
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{relay}" "{path}" "$@"\n')
        program.chmod(0o700)
        started = driver.firefox.launch(channel="moz-firefox", executable_path=program, headless=True)
        yield started
        started.close()


@contextmanager
def browser(kind):
    """One of `KINDS`."""
    with {"chromium": chromium, "firefox": firefox}[kind]() as started:
        yield started
