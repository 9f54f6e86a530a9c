"""Both lectures as a program that takes a seed and a back end, prints its transcript, and counts what a run took.

The lines are those of ``tutorials/lectures.py``; after each plan of lecture 38 the turtle's pose is asked for, so that poses can be
compared. It is run as a process of its own, because "the same bytes" is said of processes.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
POSE = "(value *turtle-pose*)"
COLOURS = re.compile(r"\((R|G|B|WIDTH) \d+\)")
STAMP = re.compile(r"\b\d{10}\.\d{3}\b")
ADDRESS = re.compile(r"\{[0-9A-F]{10}\}")
ENTRY = re.compile(r"^(?=\[\(|WARNING:)", re.M)
PROMPT = re.compile(r"^(?=[A-Z-]+> |\d+\] )", re.M)
BACKENDS = ["threads", "greenlet"]


def run(seed=None, backend="threads"):
    """Type both lectures in a fresh process: its transcript."""
    environment = {key: value for key, value in os.environ.items() if key != "ROS_PACKAGE_PATH"}
    environment["PYTHONPATH"] = os.pathsep.join(str(ROOT / folder) for folder in ("src", "hy_src", "tutorials"))
    done = subprocess.run(
        [sys.executable, __file__, str(seed), backend],
        cwd=ROOT,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0 and not done.stderr, done.stdout[-2000:] + done.stderr
    return done.stdout


def answers(transcript):
    """(typed, answer) pairs of a transcript."""
    pairs = []
    for part in PROMPT.split(transcript)[1:]:
        head, _, rest = part.partition("\n")
        while rest and head.count("(") > head.count(")"):  # a form of several lines; the last one may be cut off
            line, _, rest = rest.partition("\n")
            head += "\n" + line
        pairs.append((head, rest))
    return pairs


def shown(text):
    """An answer without what no slide promises: time stamps, addresses, and the random colours and widths of the pen."""
    return COLOURS.sub(r"(\1 n)", ADDRESS.sub("{address}", STAMP.sub("time", text)))


def visible(transcript):
    """What a student sees, in a form in which two runs can be compared.

    For every line typed: the line; for each speaker (a process module, roslisp) what it said, in its order, warnings being
    one more speaker; the value. Where two process modules work at the same time no slide says which speaks first, so between
    them there is no order. In the plan with one module for two motions there is one, warning included, and so it is whole.
    """
    found = []
    for typed, answer in answers(transcript):
        if typed.endswith(POSE):
            continue
        entries, value = said(answer)
        if "cpl:par" in typed and typed.count("turtlesim-pen-control") > 1:
            entries = sorted(entries, key=speaker)
        found.append((typed, entries, value))
    return found


def said(answer):
    """The log lines and warnings of an answer, each with its lines, and the value below them."""
    first, *entries = ENTRY.split(shown(answer).rstrip("\n"))
    if not entries:
        return [], first
    last, _, value = entries[-1].rpartition("\n")
    return [entry.rstrip("\n") for entry in [first, *entries[:-1], last] if entry], value


def speaker(entry):
    """Who says a log line: ``TurtleSim navigation``, ``WARNING:``, ..."""
    return "WARNING" if entry.startswith("WARNING") else " ".join(entry.partition(": ")[2].split()[:2])


def poses(transcript):
    """The numbers of every pose that was asked for."""
    return [
        [float(number.replace("d", "e")) for number in re.findall(r"-?\d+\.\d+d-?\d+", answer)]
        for typed, answer in answers(transcript)
        if typed.endswith(POSE)
    ]


def main(seed, backend):
    from lectures import LECTURE_34, LECTURE_38, Typist

    from cramhy_runtime.repl.console import Console
    from cramhy_runtime.repl.session import Session

    texts = list(LECTURE_34)
    for text in LECTURE_38:
        texts += [text, POSE] if text.startswith(("(top-level", "(drive", "(sleep")) else [text]
    return Console(lambda: Session(time="virtual", seed=seed, backend=backend), Typist(texts)).run()


if __name__ == "__main__":
    sys.exit(main(None if sys.argv[1] == "None" else int(sys.argv[1]), sys.argv[2]))
