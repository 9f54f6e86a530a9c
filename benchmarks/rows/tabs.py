"""Rows of the course in a browser's tab: what a first visit fetches, the time until the first prompt, the next visit, and a restart.

Chromium visits a site that `cramhy browser` has just written, from a host on this machine. The next visits are without a network. The
figures in seconds are processor time of two threads, that of the page and that of Python's worker, which wait for each other. Threads of
Chromium that compile WebAssembly beside them, on other processors, do not count.
"""

from __future__ import annotations

import contextlib
import gzip
import os
import sys
import tempfile
import threading
import time
from pathlib import Path

from . import Row

ROOT = Path(__file__).parents[2]
FETCHED = Row("a tab: what the first visit fetches", None, goal=9.0, unit="MB")
FIRST = Row("a tab: the first visit, until the prompt", None, goal=4.0, unit="s")
NEXT = Row("a tab: the next visit, without a network", None, goal=2.5, unit="s")
RESTART = Row("a tab: Restart, until the prompt", None, goal=2.0, unit="s")
ROWS = (FETCHED, FIRST, NEXT, RESTART)
ROUNDS = 3
SPARE = 20.0  # s in which Chromium makes the Python for a restart ready, on a busy machine
LIMIT = 120_000  # ms
TEXTS = (".js", ".mjs", ".css", ".html", ".json", ".svg")
"""What hosts pack by themselves."""


class Missing(Exception):
    """What is needed and is not here: its name, and how it is installed."""


def measured(only=""):
    """Yield (row, figures of the rounds), or (row, why it is not measured here)."""
    wanted = [row for row in ROWS if only in row.name]
    if not wanted:
        return
    with tempfile.TemporaryDirectory() as folder:
        try:
            figures = _figures(Path(folder) / "site")
        except Missing as why:
            figures = dict.fromkeys(ROWS, str(why))
    for row in wanted:
        yield row, figures[row]


def _figures(folder):
    sys.path.insert(0, str(ROOT / "tests"))
    from browsers import chromium_path
    from cramhy_runtime.browser import local_host, pyodide_files, site

    path = chromium_path()
    if path is None:
        raise Missing("Chromium is missing: apt-get install chromium, or set CRAMHY_CHROMIUM")
    try:
        from playwright import sync_api
    except ImportError:
        raise Missing("playwright is missing: pip install playwright") from None
    try:
        site.write(folder, pyodide_files.FETCHED / "pyodide")
    except (pyodide_files.UnfitPyodide, site.SiteError) as problem:
        raise Missing(f"Pyodide or Node is missing: make pyodide. ({problem})") from None
    figures = {row: [] for row in ROWS}
    figures[FETCHED] = [sum(_transferred(file) for file in folder.rglob("*") if file.is_file()) / 1e6]
    for _ in range(ROUNDS):
        with _served(local_host.open_host(folder)) as (address, cut), sync_api.sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-dev-shm-usage"])
            clock, page = _Clock(browser), browser.new_page()
            page.set_default_timeout(LIMIT)
            for row in (FIRST, NEXT):
                clock.start()
                page.goto(address)
                page.locator("body[data-prompt=waits]").wait_for()
                figures[row].append(clock.used())
                page.evaluate("navigator.serviceWorker.ready.then(() => true)")
                cut()
            _wait_until_idle(clock)
            clock.start()
            prompts = page.locator("body").get_attribute("data-prompts")
            page.locator("#repl-restart").click()
            page.locator(f'body[data-prompt=waits]:not([data-prompts="{prompts}"])').wait_for()
            figures[RESTART].append(clock.used())
            browser.close()
    return figures


def _transferred(file):
    data = file.read_bytes()
    return len(gzip.compress(data)) if file.suffix in TEXTS else len(data)


@contextlib.contextmanager
def _served(host):
    from cramhy_runtime.browser import local_host

    thread = threading.Thread(target=host.serve_forever, daemon=True)
    thread.start()

    def cut():
        if thread.is_alive():
            host.shutdown()
            host.server_close()
            thread.join()

    try:
        yield local_host.address(host), cut
    finally:
        cut()


class _Clock:
    """The processor seconds of the threads that count. Linux tells what a thread has used."""

    def __init__(self, browser):
        if not Path("/proc/self/task").is_dir():
            raise Missing("Linux is missing, which tells the time of a thread")
        self.session = browser.new_browser_cdp_session()
        self.begun = {}

    def _ticks(self):
        found = {}
        for process in self.session.send("SystemInfo.getProcessInfo")["processInfo"]:
            for thread in Path(f"/proc/{process['id']}/task").iterdir() if process["type"] == "renderer" else ():
                with contextlib.suppress(OSError):  # it has just ended
                    name, _, fields = (thread / "stat").read_text().partition("(")[2].rpartition(")")
                    if thread.name == str(process["id"]) or name.startswith("DedicatedWorker"):
                        found[thread] = sum(map(int, fields.split()[11:13]))
        return found

    def start(self):
        self.begun = self._ticks()

    def used(self):
        """Seconds since `start`. Threads that have ended do not count, for they are those of the visit before."""
        return sum(ticks - self.begun.get(thread, 0) for thread, ticks in self._ticks().items()) / os.sysconf("SC_CLK_TCK")


def _wait_until_idle(clock):
    """Return when the other Python has been made: it begins five seconds after the prompt."""
    latest = time.monotonic() + SPARE
    time.sleep(6)
    while time.monotonic() < latest:
        clock.start()
        time.sleep(1)
        if clock.used() < 0.05:
            return
