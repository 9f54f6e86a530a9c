"""A session as a person has it, watched for as long as one likes, and what its process holds all the while.

    python session_for_hours.py --minutes 60 [--warm-up 5] [--every 5] [--backend greenlet] [--chromium] [--trace]
    python session_for_hours.py --minutes 1 --warm-up 0.3 --time virtual --quick

It starts ``roslisp_repl --serve --view --record`` as a process of its own, and types at its prompt again and again: plans that drive the
turtle by process modules, functions that are defined anew, errors with an answer to the debugger, output, clears of the paper. A client
hears all that the live page hears and asks for the state and the history (``--chromium``: the page itself), another hears the pose and the
log and publishes on a topic of its own. Every few seconds the session's memory (VmRSS) is taken; what it grew by after the warm-up is the
last line, as JSON: the difference of the medians of the first and the last tenth of the samples that count, and the slope of all of them.

``--quick`` types without a pause, in plans that last longer; with virtual time, which then goes twenty times as fast as the wall, an
hour of the turtle's time passes in three minutes. ``--trace`` has tracemalloc on, and tells which lines of source hold more in the end
than after the warm-up; such a process is larger and slower, and its VmRSS means little.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from statistics import median

ROOT = Path(__file__).parents[2]
PATIENCE = 120  # s for an answer at the prompt
PAGE_TOPICS = {
    "/cramhy/world": "cramhy_msgs/World",
    "/cramhy/tasks": "cramhy_msgs/TaskTree",
    "/cramhy/fluents": "cramhy_msgs/Fluents",
    "/cramhy/process_modules": "cramhy_msgs/ProcessModules",
    "/cramhy/pace": "cramhy_msgs/Pace",
    "/rosout": "rosgraph_msgs/Log",
}
DUMP = signal.SIGUSR2 if hasattr(signal, "SIGUSR2") else None
FIRST = ['(start-ros-node "soak")', '(init-ros-turtle "turtle1")']
FORMS = [
    "(defun there-and-back (n) (dotimes (i n) (send-vel-cmd 1.5 (if (evenp i) 0.9 -0.9)) (sleep {seconds})))",
    "(top-level (par (there-and-back 3) (wait-for (make-fluent :value {number}))))",
    "(drive 1.5 {angle})",
    "(move-simple {x} {y})",
    "(goto-location :left :bottom)",
    '(list {number} "{number}" \'again (format nil "~a" {angle}))',
    "(car {number})",  # an error: the debugger is answered
    "(top-level (with-retry-counters ((again 2)) (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) "
    "(do-retry again (retry)) (return nil))) (sleep 0.05) (fail 'simple-plan-failure))))",
    "(top-level (pursue (progn (sleep {seconds}) {number}) (whenever ((pulsed *turtle-pose*)) (value *turtle-pose*))))",
    '(ros-info (soak) "round {number}")',
    "(print {number})",
    "(call-clear-background)",
]


# ---------------------------------------------------------------------------------------------------------- in the session


def traced_session(arguments):
    """In the process that is watched: ``cramhy`` with tracemalloc, which compares on each `DUMP` with the one before."""
    import gc
    import tracemalloc

    tracemalloc.start(6)
    before = None

    def dump(number, frame):
        nonlocal before
        gc.collect()
        now = tracemalloc.take_snapshot().filter_traces([tracemalloc.Filter(False, tracemalloc.__file__)])
        if before is not None:
            for kind in ("lineno", "traceback"):
                for found in now.compare_to(before, kind)[:14]:
                    print(
                        f"; held: {found.size_diff / 1024:+9.1f} KiB {found.count_diff:+8d} blocks",
                        *(f"{frame.filename.rpartition('cramhy_runtime/')[2]}:{frame.lineno}" for frame in reversed(list(found.traceback))),
                        file=sys.stderr,
                    )
        before = now
        print("; held: that was a look", file=sys.stderr, flush=True)

    signal.signal(DUMP, dump)
    from cramhy_runtime.cli import main

    sys.exit(main(arguments))


# ------------------------------------------------------------------------------------------------------------- around it


class Watched:
    """The session's process, its prompt, and what it holds."""

    def __init__(self, folder, options):
        (folder / "run").mkdir(mode=0o700)
        words = [
            "repl",
            "--time",
            options.time,
            "--backend",
            options.backend,
            "--serve",
            "--view",
            "--record",
            str(folder / "soak.mcap"),
            "--load",
            "cram-my-beginner-tutorial",
            "--package",
            "tut",
        ]
        program = [__file__, "--traced", "--"] if options.trace else ["-m", "cramhy_runtime.cli"]
        environment = {**os.environ, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}", "XDG_RUNTIME_DIR": str(folder / "run")}
        environment.pop("DISPLAY", None)
        self.process = subprocess.Popen(
            [sys.executable, *program, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            cwd=ROOT,
        )
        self.prompts, self.tail, self.told = 0, "", threading.Condition()
        self.url, self.complaints, self.held = None, [], []
        for stream, hear in ((self.process.stdout, self._output), (self.process.stderr, self._errors)):
            threading.Thread(target=hear, args=(stream,), daemon=True).start()
        self._wait_for(lambda: self.prompts and self.url)

    def _output(self, stream):
        while data := os.read(stream.fileno(), 65536):
            with self.told:
                text = self.tail + data.decode()
                ends = list(re.finditer(r"(?:^|\n)(TUT|\d+\])>? ", text))
                self.prompts += len(ends)
                self.tail = text[ends[-1].end() :] if ends else text[-40:]
                self.asks = ends[-1][1] if ends else getattr(self, "asks", "")
                self.told.notify_all()

    def _errors(self, stream):
        for line in iter(stream.readline, b""):
            line = line.decode().rstrip()
            with self.told:
                if line.startswith("; The page: "):
                    self.url = line.rpartition(" ")[2]
                elif line.startswith("; held: "):
                    self.held.append(line)
                elif not line.startswith("; "):
                    self.complaints.append(line)
                self.told.notify_all()

    def _wait_for(self, condition):
        with self.told:
            if not self.told.wait_for(lambda: condition() or self.process.poll() is not None, PATIENCE) or self.process.poll() is not None:
                raise SystemExit(f"The session does not answer: {self.tail!r} {self.complaints}")

    def type(self, line):
        """Type a form and wait for the next prompt; an error is answered, as a person would, with abort."""
        for text in (line, "abort"):
            seen = self.prompts
            self.process.stdin.write(text.encode() + b"\n")
            self.process.stdin.flush()
            self._wait_for(lambda seen=seen: self.prompts > seen)
            if self.asks == "TUT":
                return

    def kilobytes(self):
        with open(f"/proc/{self.process.pid}/status") as file:
            return next(int(line.split()[1]) for line in file if line.startswith("VmRSS:"))

    def look(self):
        """Have the session say what holds more than at the last look; only with ``--trace``."""
        seen = len(self.held)
        self.process.send_signal(DUMP)
        self._wait_for(lambda: any("that was a look" in line for line in self.held[seen:]))

    def end(self):
        """End the session by end of input; its exit status."""
        self.process.stdin.close()
        return self.process.wait(PATIENCE)


class Clients(threading.Thread):
    """What connects to the session: a page, and a client that hears the pose and publishes."""

    def __init__(self, url, chromium, quick):
        super().__init__(daemon=True)
        host, _, token = url.partition("/#")
        self.url, self.address = url, f"{host.replace('http', 'ws')}/{token}"
        self.chromium, self.quick = chromium, quick
        self.heard, self.problem, self.over = 0, None, False
        self.start()

    def run(self):
        try:
            asyncio.run(self._all())
        except Exception as problem:
            if not self.over:
                self.problem = f"{type(problem).__name__}: {problem}"

    async def _all(self):
        if self.quick and not self.chromium:  # twenty times as fast as the wall
            await self._once("/cramhy/set_pace", {"paused": False, "speed": 20.0})
        await asyncio.gather(self._chromium() if self.chromium else self._page(), self._client())

    async def _once(self, service, values):
        from websockets.asyncio.client import connect

        async with connect(self.address, max_size=None, ping_interval=None) as socket:
            await socket.send(json.dumps({"op": "call_service", "service": service, "args": values}))
            await socket.recv()

    async def _chromium(self):
        import shutil

        from playwright.async_api import async_playwright

        async with async_playwright() as driver:
            browser = await driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            page = await browser.new_page()
            await page.goto(self.url)
            while not self.over:
                await asyncio.sleep(1)
            await browser.close()

    async def _page(self):
        from websockets.asyncio.client import connect

        async with connect(self.address, max_size=None, ping_interval=None) as socket:
            for topic, kind in PAGE_TOPICS.items():
                await socket.send(json.dumps({"op": "subscribe", "topic": topic, "type": kind, "queue_length": 0}))
            asked = 0.0
            async for _ in socket:
                self.heard += 1
                if time.monotonic() > asked + 30:  # a page that is loaded anew
                    asked = time.monotonic()
                    for service in ("get_state", "get_history"):
                        await socket.send(json.dumps({"op": "call_service", "service": f"/cramhy/{service}", "args": {}}))

    async def _client(self):
        from websockets.asyncio.client import connect

        async with connect(self.address, max_size=None, ping_interval=None) as socket:
            bound = {"throttle_rate": 2, "queue_length": 100} if self.quick else {}  # else the server leaves one that is too slow
            for topic, kind in (
                ("/turtle1/pose", "turtlesim/Pose"),
                ("/turtle1/color_sensor", "turtlesim/Color"),
                ("/rosout", "rosgraph_msgs/Log"),
            ):
                await socket.send(json.dumps({"op": "subscribe", "topic": topic, "type": kind, **bound}))
            await socket.send(json.dumps({"op": "advertise", "topic": "/soak/count", "type": "std_msgs/Int32"}))
            await socket.send(json.dumps({"op": "subscribe", "topic": "/soak/count", "type": "std_msgs/Int32"}))
            await asyncio.gather(self._publish(socket), self._hear(socket))

    async def _hear(self, socket):
        async for _ in socket:
            self.heard += 1

    async def _publish(self, socket):
        number = 0
        while not self.over:
            await asyncio.sleep(0.01 if self.quick else 0.1)
            number += 1
            await socket.send(json.dumps({"op": "publish", "topic": "/soak/count", "msg": {"data": number}}))
            if number % 50 == 0:
                await socket.send(json.dumps({"op": "call_service", "service": "/rosapi/topics", "args": {}}))


def growth(samples):
    """(kilobytes that the median of the last tenth is above that of the first, kilobytes per minute of the straight line through all)."""
    tenth = max(1, len(samples) // 10)
    values = [value for _, value in samples]
    middle, level = sum(at for at, _ in samples) / len(samples), sum(values) / len(values)
    spread = sum((at - middle) ** 2 for at, _ in samples) or 1.0
    slope = sum((at - middle) * (value - level) for at, value in samples) / spread
    return median(values[-tenth:]) - median(values[:tenth]), round(slope * 60, 1)


def forms(quick):
    """The texts to type, without end: each time with other numbers, as a person's."""
    number = 0
    while True:
        for form in FORMS:
            number += 1
            yield form.format(number=number, seconds=20 if quick else 0.5, angle=0.5 + number % 7 / 10, x=2 + number % 7, y=3 + number % 5)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--warm-up", type=float, default=None, metavar="MINUTES", help="which do not count (a tenth, at most five)")
    parser.add_argument("--every", type=float, default=None, metavar="SECONDS", help="between two samples (a hundredth of the time)")
    parser.add_argument("--time", choices=["wall", "virtual"], default="wall")
    parser.add_argument("--backend", choices=["threads", "greenlet"], default="threads")
    parser.add_argument("--chromium", action="store_true", help="the page itself instead of a client that hears what it hears")
    parser.add_argument("--quick", action="store_true", help="type without a pause, and let virtual time pass as fast as it can")
    parser.add_argument("--trace", action="store_true", help="tell which lines of source hold what")
    options = parser.parse_args()
    warm_up = min(5.0, options.minutes / 10) if options.warm_up is None else options.warm_up
    every = options.every or max(0.5, min(10.0, options.minutes * 60 / 200))
    with tempfile.TemporaryDirectory(prefix="session_for_hours") as name:
        folder = Path(name)
        session = Watched(folder, options)
        for form in FIRST:
            session.type(form)
        clients = Clients(session.url, options.chromium, options.quick)
        samples, typed, began, told = [], 0, time.monotonic(), -1.0
        until, looked = began + options.minutes * 60, not options.trace
        next_sample = began
        for form in forms(options.quick):
            now = time.monotonic()
            if now >= until:
                break
            if clients.problem:
                raise SystemExit(f"A client ended: {clients.problem}")
            if now >= next_sample:
                next_sample = now + every
                samples.append((now - began, session.kilobytes()))
                if now - told > 60:
                    told = now
                    print(
                        f"{(now - began) / 60:6.1f} min {samples[-1][1]:8d} kB, {typed} forms, {clients.heard} messages heard",
                        file=sys.stderr,
                        flush=True,
                    )
            if not looked and now - began > warm_up * 60:
                looked = True
                session.look()
            session.type(form)
            typed += 1
            if not options.quick:
                time.sleep(0.5)
        samples.append((time.monotonic() - began, session.kilobytes()))
        if options.trace:
            session.look()
            print("\n".join(session.held), file=sys.stderr)
        clients.over = True
        status = session.end()
        counted = [sample for sample in samples if sample[0] >= warm_up * 60]
        grown, slope = growth(counted)
        print(
            json.dumps(
                {
                    "kilobytes": [value for _, value in samples],
                    "first": counted[0][1],
                    "last": counted[-1][1],
                    "grown": grown,
                    "per minute": slope,
                    "minutes": round((counted[-1][0] - counted[0][0]) / 60, 2),
                    "typed": typed,
                    "heard": clients.heard,
                    "recorded": (folder / "soak.mcap").stat().st_size,
                    "status": status,
                    "complaints": session.complaints[:5],
                }
            )
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--traced"]:
        traced_session(sys.argv[3:])
    else:
        main()
