"""What lenses start: processes of their own, which the user interrupts as by Ctrl-C, and which end with the server.

A plan may drive a robot. So it is asked to end, by a signal, and its cleanup forms run, also when the server itself is ended.
"""

from __future__ import annotations

import asyncio
import os
import signal

from lsprotocol import types as lsp

MOST_OUTPUT = 100_000
"""Characters of what a process prints; of a longer output the end is kept."""
MOST_RUNNING = 4
GRACE = 10.0
"""Seconds after which a process that was interrupted is killed. It is longer than what its cleanup forms get (``--cleanup-limit``)."""


MOMENT, PAUSE = 1.5, 0.02
"""Seconds that the end of the server waits for processes, and from one look to the next."""


class Runs:
    """The processes that run for a server."""

    def __init__(self, server):
        self.server, self.processes = server, {}
        self._last = 0

    async def run(self, errand):
        """Run an `Errand` to its end. Returns ``{"status", "output", "what"}``; the output is shown line by line in the editor's log."""
        if len(self.processes) >= MOST_RUNNING:
            return self.refuse(f"{MOST_RUNNING} plans run already. Interrupt one first.")
        process = await asyncio.create_subprocess_exec(
            *errand.words,
            cwd=errand.folder,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
            env={**os.environ, "CRAMHY_TIME": os.environ.get("CRAMHY_TIME", "virtual"), "PYTHONUNBUFFERED": "1"},
            limit=1 << 20,
        )
        self._last += 1
        number = self._last
        self.processes[number] = process
        self._log(f"Running {errand.what}")
        output = ""
        try:
            while part := await process.stdout.read(1 << 16):
                text = part.decode("utf-8", "replace")
                output = (output + text)[-MOST_OUTPUT:]
                self._log(text.rstrip("\n"))
            status = await process.wait()
        finally:
            self.processes.pop(number, None)
            _ask_to_end(process)  # the server ends
        self._tell(errand.what, status, output)
        return {"status": status, "output": output, "what": errand.what}

    def refuse(self, why):
        """Tell the user why nothing runs. Returns the answer for the client."""
        self._show(lsp.MessageType.Warning, why)
        return {"status": None, "output": why, "what": ""}

    def _tell(self, what, status, output):
        lines = [line for line in output.strip().split("\n") if line.strip()]
        if status == 0:
            self._show(lsp.MessageType.Info, f"{what}: {lines[-1] if lines else 'done'}"[:300])
        elif status < 0 or status == 130:
            self._show(lsp.MessageType.Warning, f"{what} was interrupted.")
        else:
            told = next((line for line in lines if line.startswith("cramhy:") or "FAIL" in line.upper()), lines[-1] if lines else "")
            self._show(lsp.MessageType.Error, f"{what}: {told}"[:300])

    def interrupt(self):
        """Interrupt all that runs, through its cleanup forms. Returns how many there were."""
        loop = asyncio.get_running_loop()
        running = [process for process in self.processes.values() if process.returncode is None]
        for process in running:
            process.send_signal(signal.SIGINT)
            loop.call_later(GRACE, _kill, process)
        return len(running)

    async def end(self):
        """Ask all to end, because the server ends, and wait a `MOMENT`, so that who started them is answered before pygls cancels it."""
        for process in self.processes.values():
            _ask_to_end(process)
        looks = int(MOMENT / PAUSE)
        while self.processes and looks:
            await asyncio.sleep(PAUSE)
            looks -= 1
        await asyncio.sleep(PAUSE)

    def _show(self, kind, text):
        self.server.window_show_message(lsp.ShowMessageParams(kind, text))

    def _log(self, text):
        self.server.window_log_message(lsp.LogMessageParams(lsp.MessageType.Log, text))


def _ask_to_end(process):
    if process.returncode is None:
        process.terminate()


def _kill(process):
    if process.returncode is None:
        process.kill()
