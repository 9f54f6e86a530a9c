"""A process that runs plans for hours holds in the end what it held in the beginning.

A million pulses of fluents and a hundred thousand tasks, in one process, on each back end: branches that succeed, fail, are evaporated and
suspended, nets, callbacks, timers (``plans_for_hours.py``). In the ordinary suite a fiftieth of that.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from systems import SOAK

PULSES, TASKS = (1_000_000, 100_000) if SOAK else (20_000, 2_000)
MORE_OBJECTS = 500
MORE_KILOBYTES = 4_000  # of some 23,000; a hundredth of a kilobyte for each task would be 1,000


@pytest.mark.soak
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_nothing_grows(backend):
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    command = [sys.executable, str(Path(__file__).with_name("plans_for_hours.py")), backend, str(PULSES), str(TASKS)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    told = json.loads(done.stdout)
    if SOAK:
        print(backend, told)
    before, after = told["before"], told["after"]
    assert told["pulses"] >= PULSES and told["tasks"] >= TASKS
    assert told["alive"] == 0 and told["timer"] is None
    assert after["threads in use"] == before["threads in use"] == 0 and after["threads"] <= before["threads"]
    assert after["objects"] <= before["objects"] + MORE_OBJECTS
    assert after["kilobytes"] <= before["kilobytes"] + MORE_KILOBYTES
