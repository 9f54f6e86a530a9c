"""What an editor waits for: the language server's answers over its pipe, medians and best of many.

Goals: completion and hover within 50 ms in the course's package, within 100 ms where the kitchen has loaded all of CRAM's packages. First
diagnostics within 300 ms of typing, the server's pause included. The first check of a file includes what its system depends on.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).parents[1]
ENVIRONMENT = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
ENVIRONMENT["PYTHONPATH"] = f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"
COURSE = ROOT / "tutorials" / "cram_my_beginner_tutorial" / "src" / "process-modules.hy"
KITCHEN = ROOT / "tutorials" / "kitchen" / "cram_my_pick_place_tutorial" / "src" / "setting-a-table.hy"
ROUNDS = 30


class Editor:
    """A client at the pipe of ``cramhy lsp``."""

    def __init__(self, folder):
        self.server = subprocess.Popen(
            [sys.executable, "-m", "cramhy_runtime.cli", "lsp"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=ENVIRONMENT,
        )
        self.number, self.versions = 0, {}
        self.ask("initialize", {"processId": None, "rootUri": folder.as_uri(), "capabilities": {}})
        self.tell("initialized", {})

    def _send(self, message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.server.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
        self.server.stdin.flush()

    def _read(self):
        length = 0
        while (line := self.server.stdout.readline()).strip():
            if line.lower().startswith(b"content-length"):
                length = int(line.split(b":")[1])
        return json.loads(self.server.stdout.read(length))

    def tell(self, method, params):
        self._send({"method": method, "params": params})

    def ask(self, method, params):
        self.number += 1
        self._send({"id": self.number, "method": method, "params": params})
        while (message := self._read()).get("id") != self.number:
            pass
        return message["result"]

    def open(self, file):
        """Open a file and wait for what the compiler tells of it. Returns the seconds that it took."""
        uri, begin = file.as_uri(), perf_counter()
        self.versions[uri] = 1
        text = file.read_text(encoding="utf-8")
        self.tell("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "hy", "version": 1, "text": text}})
        self.told(uri)
        return perf_counter() - begin

    def type(self, file, text):
        """Change the file's text and wait for the next diagnostics. Returns the seconds that it took."""
        uri, begin = file.as_uri(), perf_counter()
        self.versions[uri] += 1
        params = {"textDocument": {"uri": uri, "version": self.versions[uri]}, "contentChanges": [{"text": text}]}
        self.tell("textDocument/didChange", params)
        self.told(uri)
        return perf_counter() - begin

    def told(self, uri):
        while True:
            message = self._read()
            if message.get("method") == "textDocument/publishDiagnostics" and message["params"]["uri"] == uri:
                return message["params"]["diagnostics"]


def position(text, word, further):
    offset = text.index(word) + further
    return {"line": text.count("\n", 0, offset), "character": offset - text.rfind("\n", 0, offset) - 1}


def row(name, seconds, goal):
    best, median = 1000 * min(seconds), 1000 * statistics.median(seconds)
    reached = "" if best <= goal else "  missed"
    print(f"{name:<58} {best:8.1f} {median:8.1f}  {goal:6} ms{reached}")


def answers(editor, file, where, word, goal):
    text, document = file.read_text(encoding="utf-8"), {"uri": file.as_uri()}
    for name, further in (("completion", len(word)), ("hover", 2)):
        params = {"textDocument": document, "position": position(text, word, further)}
        times = []
        for _ in range(ROUNDS):
            begin = perf_counter()
            found = editor.ask(f"textDocument/{name}", params)
            times.append(perf_counter() - begin)
        assert found, name
        row(f"{name} in {where}", times, goal)


def main():
    print(f"{'':<58} {'best':>8} {'median':>8}    goal")
    for file, where, word, goal in (
        (COURSE, "the course's package", "pm-execute", 50),
        (KITCHEN, "the kitchen's, with all of CRAM's packages", "perform", 100),
    ):
        editor = Editor(file.parents[1])
        row(f"first check, from the start of the server, {where}", [editor.open(file)], 3000)
        answers(editor, file, where, word, goal)
        text = file.read_text(encoding="utf-8")
        times = [editor.type(file, text + f"\n(defun added-{number} (x) (undefined-{number}))\n") for number in range(ROUNDS)]
        row(f"diagnostics after typing, with the pause, {where}", times, 300)
        times = [editor.type(file, text + "\n(" * (1 + number % 2)) for number in range(ROUNDS)]
        row(f"a missing bracket, {where}", times, 50)
        editor.server.kill()


if __name__ == "__main__":
    main()
