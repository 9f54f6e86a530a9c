"""Random frames, half documents and long lines: whatever comes, the server answers the next request, and it ends when the client does."""

from __future__ import annotations

import json
import random
import subprocess
import sys

import pytest

URI = "untitled:frames.lisp"
METHODS = """initialized textDocument/didOpen textDocument/didChange textDocument/didClose textDocument/hover textDocument/completion
textDocument/rename textDocument/formatting textDocument/codeAction textDocument/foldingRange textDocument/semanticTokens/full
textDocument/codeLens textDocument/nothing workspace/executeCommand $/cancelRequest""".split()
VALUES = [None, True, -1, 0, 10**30, 1.5, "", "x", URI, "file:///nowhere.hy", [], {}, {"line": 0, "character": 0}, {"uri": URI}, "\ud800"]
TEXTS = ["(", ")", "(defun f (x)", '"', "#|", "(in-package :cpl)\n(par", "#.(", "\u00e9\U0001f422(", "", "'" * 500, "(" * 300]


def frame(body):
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    return b"Content-Length: %d\r\n\r\n" % len(data) + data


def random_frame(lot, number):
    kind = lot.random()
    if kind < 0.5:
        names = lot.sample(["textDocument", "position", "range", "newName", "contentChanges", "options", "text"], 4)
        return frame({"jsonrpc": "2.0", "id": number, "method": lot.choice(METHODS), "params": {n: lot.choice(VALUES) for n in names}})
    if kind < 0.7:
        item = {"uri": URI, "languageId": "lisp", "version": number, "text": lot.choice(TEXTS)}
        return frame({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": item}})
    if kind < 0.85:
        return frame(bytes(lot.randrange(256) for _ in range(lot.randrange(1, 60))))
    return frame(json.dumps(lot.choice(VALUES)).encode())


def answer_of(stream, number):
    while True:
        length = 0
        while (line := stream.readline()).strip():
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        assert length, "the server has ended"
        message = json.loads(stream.read(length))
        if message.get("id") == number and "method" not in message:
            return message


@pytest.fixture(scope="module")
def server():
    made = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    send(made, {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}, "processId": None, "rootUri": None}})
    answer_of(made.stdout, 1)
    yield made
    made.stdin.write(b"Content-Length: 500\r\n\r\n{half")  # and the client is gone
    made.stdin.close()
    made.stdout.read()
    assert made.wait(300) == 0


def send(server, message):
    server.stdin.write(message if isinstance(message, bytes) else frame(message))
    server.stdin.flush()


def alive(server, number):
    item = {"uri": "untitled:alive.lisp", "languageId": "lisp", "version": 1, "text": "(defun f (x)\n  (g x))"}
    send(server, {"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": item}})
    params = {"textDocument": {"uri": item["uri"]}}
    send(server, {"jsonrpc": "2.0", "id": number, "method": "textDocument/foldingRange", "params": params})
    assert answer_of(server.stdout, number)["result"][0]["endLine"] == 1


@pytest.mark.parametrize("seed, count", [(1, 200), pytest.param(2, 10_000, marks=pytest.mark.soak)])
def test_random_frames(server, seed, count):
    lot = random.Random(seed)
    for number in range(count):
        send(server, random_frame(lot, f"r{seed}-{number}"))
        if number % 20 == 19:
            alive(server, f"a{seed}-{number}")


def test_headers_that_are_none(server):
    send(server, b"Content-Length: x\r\n" + b"Content-Length: " + b"9" * 5000 + b"\r\n" + b"\r\n\r\n" + b"y" * 3_000_000 + b"\r\n\r\n")
    alive(server, "headers")


def test_a_line_of_ten_megabytes(server):
    item = {"uri": "untitled:long.lisp", "languageId": "lisp", "version": 1, "text": "(a " * 3_400_000}
    send(server, {"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": item}})
    params = {"textDocument": {"uri": item["uri"]}, "position": {"line": 0, "character": 5_000_000}}
    send(server, {"jsonrpc": "2.0", "id": "long", "method": "textDocument/hover", "params": params})
    assert answer_of(server.stdout, "long")["result"] is None
    alive(server, "after")
