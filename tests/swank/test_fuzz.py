"""Random frames: whatever comes, each gets a reason or is left out, and the session goes on."""

from __future__ import annotations

import random

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.swank import rpcs, wire

HARMLESS = [name for name in rpcs.known() if name not in ("quit-lisp", "set-default-directory")]
WORDS = """:emacs-rex :emacs-interrupt :emacs-return-string :emacs-return :emacs-pong :emacs-channel-send :return nil t quote . ' :repl-thread
-1 0 1 2 99999999999 1.5 "" "car" "(car 5)" "(" "COMMON-LISP-USER" "no package" "#.(" "*standard-output*" "\\\\" swank::%cursor-marker%
(:position 1) ((:position 5) (:line 1 1)) (nil . t) é "\U0001f422" """.split()


def random_value(lot, depth=0):
    kind = lot.random()
    if kind < 0.15 and depth < 4:
        return f"({' '.join(random_value(lot, depth + 1) for _ in range(lot.randrange(4)))})"
    if kind < 0.25:
        return "'" + random_value(lot, depth + 1)
    return lot.choice(WORDS)


def random_call(lot, number):
    values = " ".join(random_value(lot) for _ in range(lot.randrange(5)))
    package = lot.choice(["nil", '"CL-USER"', "5", '"x"'])
    return f"(:emacs-rex (swank:{lot.choice(HARMLESS)} {values}) {package} {random_value(lot)} {number})"


def random_frame(lot, number):
    """The bytes of the content of a frame."""
    kind = lot.random()
    if kind < 0.5:
        return random_call(lot, number).encode()
    if kind < 0.7:
        return f"({lot.choice(WORDS)} {' '.join(random_value(lot) for _ in range(lot.randrange(6)))})".encode()
    if kind < 0.85:  # a good message, damaged
        data = bytearray(random_call(lot, number).encode())
        for _ in range(lot.randrange(1, 4)):
            place = lot.randrange(len(data))
            data[place : place + lot.randrange(3)] = bytes(lot.randrange(256) for _ in range(lot.randrange(3)))
        return bytes(data)
    return bytes(lot.randrange(256) for _ in range(lot.randrange(60)))


@pytest.mark.parametrize("seed", [*range(3), *(pytest.param(seed, marks=pytest.mark.soak) for seed in range(3, 53))])
def test_random_frames(emacs, seed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    lot = random.Random(seed)
    for number in range(1000, 1200):
        data = random_frame(lot, number)
        kernel.post(lambda data=data: emacs.connection.receive(data))
        if number % 10 == 0:
            kernel.sleep(0.1)
            leave_debuggers(emacs)
    kernel.sleep(1)
    leave_debuggers(emacs)
    emacs.number = 10_000
    assert emacs.call('(swank:interactive-eval "(+ 1 2)")').startswith("=> 3")
    assert all(line.count("\n") == 0 for line in emacs.server.logged)


def leave_debuggers(emacs):
    for request in list(emacs.connection.running):
        request.interrupt()
    kernel.sleep(0.1)


@pytest.mark.parametrize("seed", range(3))
def test_random_texts_are_read_or_refused(seed):
    lot = random.Random(seed)
    for _ in range(500):
        text = "".join(lot.choice("()'\"`,@\\; \n.ab1:?#\x00é") for _ in range(lot.randrange(40)))
        try:
            wire.write(wire.read(text))
        except wire.TextError as problem:
            assert str(problem)
