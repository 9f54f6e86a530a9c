"""A session with the page, a recording and a client holds after a while what it will hold for hours.

The hour is ``python tests/soak/session_for_hours.py``; here it is the same program for less than a minute, in which plan time passes
twenty times as fast. In that time pools and the past for pages that come late still fill up, so the bound there is wide: it finds what
grows by megabytes in a minute. What grows slowly is found by the second test: it fills the past far beyond its bound, and counts.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from systems import SOAK

MINUTES = 60.0 if SOAK else 0.7
MORE_KILOBYTES = 2_000  # after the first five minutes of an hour
MORE_IN_A_MINUTE = 12_000  # after the first third of it


@pytest.mark.skipif(sys.platform != "linux", reason="what a process holds is told by Linux")
@pytest.mark.soak
def test_a_session_does_not_grow():
    for module in ("uvicorn", "websockets", "mcap"):
        pytest.importorskip(module)
    words = ["--minutes", str(MINUTES)] + (["--warm-up", "5"] if SOAK else ["--warm-up", "0.25", "--time", "virtual", "--quick"])
    done = subprocess.run([sys.executable, str(Path(__file__).with_name("session_for_hours.py")), *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    if SOAK:
        print({name: value for name, value in told.items() if name != "kilobytes"})
    assert told["status"] == 0 and told["complaints"] == []
    assert told["typed"] > 20 and told["heard"] > 1000 and told["recorded"] > 100_000
    assert told["grown"] < (MORE_KILOBYTES if SOAK else MORE_IN_A_MINUTE), told


@pytest.mark.soak
def test_the_past_takes_little_however_long_it_was():
    """A turtle that drives and draws, as the board notes it: what the history holds stays the same from the tenth minute."""
    import tracemalloc

    from cramhy_runtime.chronicle.history import History
    from cramhy_runtime.chronicle.merge import State
    from cramhy_runtime.ros.messages import message_class_exact

    world, turtle, stroke = (message_class_exact(f"cramhy_msgs/{name}") for name in ("World", "Turtle", "Stroke"))
    fluents, fluent = (message_class_exact(f"cramhy_msgs/{name}") for name in ("Fluents", "Fluent"))
    tree, task = message_class_exact("cramhy_msgs/TaskTree"), message_class_exact("cramhy_msgs/Task")
    history, state, held = History(), State(), []
    minutes = 180 if SOAK else 20
    tracemalloc.start()
    try:
        for number in range(minutes * 60 * 20):
            now, x, y = number / 20, 5 + 4 * (number % 100) / 100, 5 + 4 * (number * 7 % 100) / 100
            strokes = [stroke(x, y, x + 0.1, y + 0.1, 1, 2, 3, 3)]
            published = [
                ("world", world(stamp=now, turtles=[turtle(name="turtle1", x=x, y=y)], strokes=strokes)),
                (
                    "fluents",
                    fluents(
                        stamp=now,
                        fluents=[fluent(str(number // 50), "POSE", f"x {x} y {y}", 1.0)],
                        removed=[str(number // 50 - 10)] if number % 50 == 0 else [],
                    ),
                ),
                (
                    "tasks",
                    tree(
                        stamp=now,
                        tasks=[task(id=str(number // 10), name=f"[PAR-CHILD-{number // 10}]", state="RUNNING")],
                        removed=[str(number // 10 - 1000)] if number % 10 == 0 else [],
                    ),
                ),
            ]
            for kind, message in published:
                state.add(kind, message)
            history.add(published, state)
            if number % 1200 == 0:
                held.append(tracemalloc.get_traced_memory()[0] / 1024)
    finally:
        tracemalloc.stop()
    assert history.size <= history.most and history.numbers[0] > 1
    print([round(each) for each in held])
    assert max(held) < 6_000 and max(held[10:]) - held[10] < 1_500, held
    newest = history.get(0)
    assert newest.later["world"] and newest.state.messages()["tasks"].tasks
