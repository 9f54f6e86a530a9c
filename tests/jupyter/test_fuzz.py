"""Random, cut and hostile frames on the shell and control channels: whatever comes, the kernel lives and answers afterwards."""

from __future__ import annotations

import json
import random
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

KINDS = """execute_request complete_request inspect_request is_complete_request history_request comm_info_request kernel_info_request
connect_request comm_open comm_msg comm_close input_reply interrupt_request debug_request usage_request create_subshell_request
delete_subshell_request list_subshell_request no_such_request execute_reply status _request """.split()
FIELDS = """code cursor_pos silent store_history user_expressions allow_stdin stop_on_error detail_level hist_access_type n output raw session
start stop pattern unique comm_id target_name data metadata command seq arguments subshell_id value""".split()
CODES = ["(", ")", "(list", "'(1", "#.(", '"open', "(car 5)", "(+ 1 1)", "%time", "%time wall x", "%watch", "%watch 5", "%pace 1", "%%hy"]
CODES += [
    "%%hy\n[",
    "%%hy\n)",
    "(in-package :nowhere)",
    "#\\",
    "|a",
    ";;",
    "#|",
    '(error "x")',
    "é",
    "\U0001f422",
    "mapc",
    "cpl:wi",
    "(" * 900,
]
WORDS = [None, True, False, 0, -1, 2**70, 1.5, -1e300, "", [], {}, [[]], {"a": {}}, "\ud83d", "\x00", "range", "tail", "search", *CODES]


def random_value(lot, depth=0):
    kind = lot.random()
    if kind < 0.1 and depth < 4:
        return [random_value(lot, depth + 1) for _ in range(lot.randrange(4))]
    if kind < 0.2 and depth < 4:
        return {lot.choice(FIELDS): random_value(lot, depth + 1) for _ in range(lot.randrange(4))}
    return lot.choice(WORDS)


def packed(value):
    return json.dumps(value).encode()


def random_frames(lot, session):
    """The frames of a message: its header, parent, metadata and content signed well or badly, cut, or no message at all."""
    content = {name: random_value(lot) for name in lot.sample(FIELDS, lot.randrange(8))}
    if lot.random() < 0.5:
        content.update(code=lot.choice(CODES), cursor_pos=lot.randrange(-3, 9))
    header = {**session.msg_header("x"), "msg_type": lot.choice(KINDS)}
    header["date"] = "2026-01-01T00:00:00Z"
    how = lot.random()
    if how < 0.15:
        header[lot.choice([*header, "subshell_id"])] = random_value(lot)
    elif how < 0.2:
        del header[lot.choice(list(header))]
    parts = [packed(header), packed({}), packed({}), packed(content)]
    if how > 0.9:
        parts[lot.randrange(4)] = packed(random_value(lot))
    elif how > 0.85:
        parts[lot.randrange(4)] = lot.choice([b"", b"{", b"[" * 5000, bytes(lot.randrange(256) for _ in range(20))])
    elif how > 0.82:
        parts = parts[: lot.randrange(4)]
    signature = session.sign(parts) if lot.random() < 0.85 else lot.choice([b"", b"no signature", bytes(32)])
    frames = [b"<IDS|MSG>", signature, *parts]
    if lot.random() < 0.05:
        frames = frames[lot.randrange(1, len(frames)) :]
    if lot.random() < 0.05:
        frames += [bytes(lot.randrange(256) for _ in range(lot.randrange(30)))]
    return frames


def lives(cells, code):
    """The answer to a cell. It is sent anew while it is left out because a cell of the frames before it has failed."""
    while (answer := cells.run(code)).reply["status"] == "aborted":
        pass
    return answer.text


@pytest.mark.parametrize("count", [400, pytest.param(10_000, marks=pytest.mark.soak)])
def test_whatever_frames_come_the_kernel_lives_and_answers(cells, count):
    lot = random.Random(19)
    session = cells.client.session
    for number in range(count):
        channel = cells.client.shell_channel if lot.random() < 0.7 else cells.client.control_channel
        channel.socket.send_multipart(random_frames(lot, session))
        if number % 100 == 99:
            assert lives(cells, "%%lisp\n(cl:+ 3 4)") == "7"
    for channel in (cells.client.shell_channel, cells.client.iopub_channel, cells.client.control_channel):
        while channel.msg_ready():
            channel.get_msg(timeout=1)
    cells.run("%time virtual")
    cells.run("%%hy\n(in-package :cl-user)")
    assert cells.run("(cl:list 1 2)").text == "(1 2)"
    cells.client.control_channel.send(session.msg("debug_request", {"command": "initialize", "seq": 1}))
    assert cells.client.control_channel.get_msg(timeout=60)["content"]["success"] is False
