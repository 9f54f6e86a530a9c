"""Recordings: every message and every event with its time, the same bytes for the same run, and a plan that never suffers from it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from cramhy_runtime.session import Image

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import chronicler, recorder
from cramhy_runtime.chronicle.recordings import RecordingError
from cramhy_runtime.extras import install_command
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.message_json import to_json
from cramhy_runtime.ros.messages import message_class_exact

pytest.importorskip("mcap")

EPOCH = 1292688669674000000

DRIVE = """
(progn
  (roslisp:start-ros-node "driver")
  (defparameter *seen* (make-fluent :name "seen"))
  (roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (pose) (setf (value *seen*) pose)))
  (let ((pub (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist")))
    (top-level
      (pursue
        (sleep 3)
        (loop do (roslisp:publish pub (roslisp:make-message "geometry_msgs/Twist" (x linear) 2 (z angular) (random 2.0)))
                 (sleep 0.5))))))"""


def messages_of(path, topic):
    """(log time, data) of a topic's messages, by mcap's own reader."""
    from mcap.reader import make_reader

    with open(path, "rb") as file:
        return [(message.log_time, json.loads(message.data)) for _, _, message in make_reader(file).iter_messages([topic])]


def test_every_pose_that_somebody_saw_is_there_with_its_time(session, tmp_path):
    seen = []
    node = graph.active().node("onlooker", hidden=True)
    node.subscribe(
        "/turtle1/pose", message_class_exact("turtlesim/Pose"), lambda pose: seen.append((EPOCH + round(kernel.now() * 1e9), to_json(pose)))
    )
    with chronicle.record(tmp_path / "x.mcap"):
        session.evaluate_text(DRIVE)
    assert len(seen) > 180
    assert messages_of(tmp_path / "x.mcap", "/turtle1/pose") == seen


def test_every_task_that_began_ended(session, tmp_path):
    with chronicle.record(tmp_path / "x.mcap"):
        session.evaluate_text(DRIVE)
        session.evaluate_text("(top-level (dotimes (i 2000) (par 1 2)))")
    tasks = [task for _, tree in messages_of(tmp_path / "x.mcap", "/cramhy/tasks") for task in tree["tasks"]]
    began = {task["id"] for task in tasks if task["state"] == "RUNNING"}
    ended = {task["id"]: task for task in tasks if task["ended"] is not None}
    assert began == set(ended) and len(began) == 3 + 1 + 4000
    assert all(task["began"] <= task["ended"] for task in ended.values())


def test_topics_that_appear_later_and_latched_messages_are_recorded(session, tmp_path):
    session.evaluate_text("""(progn (roslisp:start-ros-node "n")
        (roslisp:publish (roslisp:advertise "/map" "std_msgs/String" :latch t) (roslisp:make-message "std_msgs/String" :data "world")))""")
    with chronicle.record(tmp_path / "x.mcap"):
        session.evaluate_text("""(progn (sleep 1) (let ((pub (roslisp:advertise "/late" "std_msgs/Int32")))
            (roslisp:publish pub (roslisp:make-message "std_msgs/Int32" :data 1)) (sleep 1) (roslisp:unadvertise "/late") (sleep 1)
            (roslisp:publish (roslisp:advertise "/late" "std_msgs/String") (roslisp:make-message "std_msgs/String" :data "other"))))""")
    path = tmp_path / "x.mcap"
    start = EPOCH + 1094000000
    assert messages_of(path, "/map") == [(start, {"data": "world"})]
    assert messages_of(path, "/late") == [(start + 10**9, {"data": 1}), (start + 3 * 10**9, {"data": "other"})]


def test_a_program_does_not_see_that_it_is_recorded(session, tmp_path):
    with chronicle.record(tmp_path / "x.mcap"):
        values = session.evaluate_text("""(progn (roslisp:start-ros-node "n") (let ((pub (roslisp:advertise "/words" "std_msgs/String")))
            (list (roslisp:publish pub (roslisp:make-message "std_msgs/String" :data "x")) (roslisp:num-subscribers pub))))""")
    assert list(values[0]) == [0, 0]
    assert [data for _, data in messages_of(tmp_path / "x.mcap", "/words")] == [{"data": "x"}]


def test_afterwards_nothing_is_left(session, tmp_path):
    chronicle.record(tmp_path / "x.mcap").close()
    here = graph.active()
    assert chronicler.there() is None and not here.on_change and not [name for name in here.nodes if "cramhy" in name]


def test_the_file_is_a_recording_from_the_first_moment_on(session, tmp_path):
    made = chronicle.record(tmp_path / "x.mcap", ["errand.lisp"])
    found = chronicle.read(tmp_path / "x.mcap")
    assert (found.count, found.about["program"]) == (0, "errand.lisp") and found.cut.startswith(f"The recording {tmp_path / 'x.mcap'} is ")
    made.close()


def test_in_wall_time_what_happened_is_in_the_file_while_nothing_happens(tmp_path, monkeypatch):
    from cramhy_runtime.repl.session import Session

    monkeypatch.setattr(recorder, "FLUSH", 10**7)
    session = Session(time="wall", turtlesim=False)
    session.package = "CRAM-USER"
    try:
        made = chronicle.record(tmp_path / "x.mcap")
        session.evaluate_text("(top-level (sleep 0.001))")
        states, looks = [], 0
        while states[-1:] != ["SUCCEEDED"] and looks < 1000:
            kernel.sleep(0.02)
            looks += 1
            states = [task["state"] for *_, data in chronicle.read(tmp_path / "x.mcap").messages() for task in data.get("tasks", ())]
        assert states[-1:] == ["SUCCEEDED"] and not made.closed
        made.close()
    finally:
        kernel.stop()


def test_a_recording_ends_with_its_session_and_after_the_cleanup_of_its_plans(session, tmp_path):
    recording = chronicle.record(tmp_path / "a.mcap")
    kernel.spawn(session.evaluate_text, "(top-level (unwind-protect (sleep 1000) (sleep 0.5)))")
    kernel.sleep(1)
    kernel.stop()
    assert recording.closed and not chronicle.read(tmp_path / "a.mcap").cut
    assert {task["state"] for task in messages_of(tmp_path / "a.mcap", "/cramhy/tasks")[-1][1]["tasks"]} == {"EVAPORATED"}


def test_a_recording_of_a_session_that_is_over_can_be_closed_when_another_one_is_recorded(session, tmp_path):
    from cramhy_runtime.repl.session import Session

    first = chronicle.record(tmp_path / "a.mcap")
    session.evaluate_text("(top-level (par (sleep 1) (sleep 2)))")
    Session(time="virtual", seed=7)
    with chronicle.record(tmp_path / "b.mcap"):
        session.evaluate_text("(cpl:top-level (cpl:par (cpl:sleep 1) (cpl:sleep 2)))")
    first.close()
    for name in ("a", "b"):
        tasks = [task for _, tree in messages_of(tmp_path / f"{name}.mcap", "/cramhy/tasks") for task in tree["tasks"]]
        assert [task["state"] for task in tasks].count("SUCCEEDED") == 3
    from cramhy_runtime.cpl.tree import finished_plans

    assert finished_plans.observers.value == ()


def test_two_recordings_at_once_and_a_page_beside_them(session, tmp_path):
    chronicle.start()
    with chronicle.record(tmp_path / "a.mcap"), chronicle.record(tmp_path / "b.mcap"):
        session.evaluate_text(DRIVE)
    chronicle.stop()
    assert messages_of(tmp_path / "a.mcap", "/cramhy/tasks") == messages_of(tmp_path / "b.mcap", "/cramhy/tasks") != []


def test_a_recording_that_begins_in_the_middle_begins_with_what_there_is(session, tmp_path):
    session.evaluate_text("""(progn (roslisp:start-ros-node "n") (sleep 0.5))""")
    chronicle.start()
    session.evaluate_text(DRIVE.replace('(roslisp:start-ros-node "driver")', ""))
    with chronicle.record(tmp_path / "x.mcap"):
        session.evaluate_text("(sleep 1)")
    worlds = messages_of(tmp_path / "x.mcap", "/cramhy/world")
    assert worlds[0][1]["complete"] and len(worlds[0][1]["strokes"]) > 5
    assert messages_of(tmp_path / "x.mcap", "/cramhy/tasks")[0][1]["complete"]


def test_schemas_tell_what_the_messages_hold(session, tmp_path):
    from mcap.reader import make_reader

    with chronicle.record(tmp_path / "x.mcap"):
        session.evaluate_text(DRIVE)
    with open(tmp_path / "x.mcap", "rb") as file:
        summary = make_reader(file).get_summary()
    schemas = {schema.name: json.loads(schema.data) for schema in summary.schemas.values()}
    assert {schema.encoding for schema in summary.schemas.values()} == {"jsonschema"}
    assert {channel.message_encoding for channel in summary.channels.values()} == {"json"}
    pose = schemas["turtlesim/Pose"]
    assert pose["title"] == "turtlesim/Pose" and pose["properties"]["theta"] == {"type": "number"}
    world = schemas["cramhy_msgs/World"]["properties"]
    assert world["turtles"]["items"]["properties"]["r"] == {"type": "integer", "minimum": 0, "maximum": 255}
    assert schemas["rosgraph_msgs/Log"]["properties"]["header"]["properties"]["stamp"]["properties"].keys() == {"secs", "nsecs"}


def test_what_the_file_says_of_itself(session, tmp_path):
    with chronicle.record(tmp_path / "x.mcap", ["drive.lisp", "turtle.asd"]):
        session.evaluate_text("(sleep 1)")
    about = chronicle.read(tmp_path / "x.mcap").about
    assert about.pop("version")
    assert about == {"time": "virtual", "seed": "7", "epoch": "1292688669.674", "program": "drive.lisp\nturtle.asd"}


SCRIPT = """
import sys, os, signal
from cramhy_runtime import chronicle, kernel
from cramhy_runtime.repl.session import Session
session = Session(time="virtual", seed=int(sys.argv[2]), backend=sys.argv[4])
session.package = "CRAM-USER"
if sys.argv[3] != "unseen":
    recording = chronicle.record(sys.argv[1])
session.evaluate_text('''%s''')
if sys.argv[3] == "kill":
    os.kill(os.getpid(), signal.SIGKILL)
if sys.argv[3] == "close":
    recording.close()
if sys.argv[3] == "error":
    raise SystemExit(3)
"""


def run_script(path, seed=1, end="close", backend="threads", told=None):
    script = SCRIPT % (DRIVE + SHOW)
    done = subprocess.run([sys.executable, "-c", script, str(path), str(seed), end, backend], capture_output=True, timeout=120)
    if told is not None:
        told.append(done.stdout)
    return done.returncode


SHOW = """
(defclass thing () ())
(defparameter *who* (make-fluent :name "who"))
(top-level
  (par (progn (setf (value *who*) (make-instance (quote thing))) (sleep 1))
       (progn (setf (value *who*) (cpl-impl:current-task)) (sleep 0.5) (cpl:describe-task-tree))
       (progn (sleep 0.7) (print (list (make-instance (quote thing)) (cpl-impl:current-task) (value *who*))))))"""


@pytest.mark.soak
def test_the_same_seed_gives_the_same_bytes_and_recording_does_not_change_the_run(tmp_path):
    told = []
    for name, seed, end, backend in (
        ("a", 1, "close", "threads"),
        ("b", 1, "close", "greenlet"),
        ("c", 2, "close", "threads"),
        ("d", 1, "unseen", "threads"),
    ):
        assert run_script(tmp_path / name, seed, end, backend, told) == 0
    contents = [(tmp_path / name).read_bytes() for name in "abc"]
    assert contents[0] == contents[1] != contents[2]
    assert len(chronicle.read(tmp_path / "a").topics) >= 6
    assert told[0] == told[1] == told[3] and b"THING {1001" in told[0] and b"[PAR-CHILD-#1/3]" in told[0]


@pytest.mark.soak
def test_a_process_that_is_killed_leaves_a_file_that_can_be_read(tmp_path):
    assert run_script(tmp_path / "x.mcap", end="kill") == -signal.SIGKILL
    found = chronicle.read(tmp_path / "x.mcap")
    assert found.cut == (
        f"The recording {tmp_path / 'x.mcap'} is damaged or cut off, as when the process that wrote it was killed; "
        "what comes before that is there."
    )
    assert found.count > 100 and found.end >= 2


@pytest.mark.soak
def test_a_process_that_ends_by_an_error_closes_its_recording(tmp_path):
    assert run_script(tmp_path / "x.mcap", end="error") == 3
    assert chronicle.read(tmp_path / "x.mcap").cut == ""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no disk that is always full")
def test_a_full_disk_ends_the_recording_but_not_the_plan(session, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(recorder, "FLUSH", 10**8)
    made = chronicle.record(tmp_path / "x.mcap")
    with open("/dev/full", "wb") as full:
        os.dup2(full.fileno(), made._part.file.fileno())
    session.evaluate_text(DRIVE)
    assert made.closed and made.problem == "No space left on device"
    made.close()
    told = " ".join(capsys.readouterr().err.split())
    assert (
        told.count(
            f"The recording {tmp_path / 'x.mcap'} ends here: No space left on device. Make room on that disk, or choose "
            "another place. The plan goes on."
        )
        == 1
    )
    assert not session.evaluate_text("(sleep 1)")[0]


@pytest.mark.parametrize(
    "path, text",
    [
        (
            "nowhere/x.mcap",
            "The recording {0}/nowhere/x.mcap cannot be written: No such file or directory. Make its folder first, or choose another one.",
        ),
        ("", "The recording {0} cannot be written: Is a directory. Choose the name of a file."),
        pytest.param(
            "/dev/full",
            "The recording /dev/full cannot be written: No space left on device. Make room on that disk, or choose another place.",
            marks=pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no disk that is always full"),
        ),
    ],
)
def test_a_file_that_cannot_be_written_is_told_at_once(session, tmp_path, path, text):
    with pytest.raises(RecordingError) as problem:
        chronicle.record(tmp_path / path)
    assert str(problem.value) == text.format(tmp_path)
    assert chronicler.there() is None


def test_without_a_session_nothing_can_be_recorded(tmp_path):
    with kernel.aside(), pytest.raises(RecordingError) as problem:
        chronicle.record(tmp_path / "x.mcap")
    assert str(problem.value) == (
        f"Nothing can be recorded in {tmp_path / 'x.mcap'}: no session runs. Start one first, by the REPL or kernel.start()."
    )


def test_without_mcap_it_is_told_how_to_get_it(session, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mcap", None)
    for asked, what in ((chronicle.record, "Recording"), (chronicle.read, "Reading a recording")):
        with pytest.raises(RecordingError) as problem:
            asked(tmp_path / "x.mcap")
        assert str(problem.value) == f"{what} needs the Python package mcap, which is not installed. Type: {install_command('record')}"


@pytest.mark.soak
def test_the_lecture_is_recorded_whole(tmp_path):
    """Lecture 38 with its two process modules, as ``tutorials/lectures.py`` types it."""
    from cramhy_runtime.repl.session import Session

    sys.path.insert(0, str(Path(__file__).parents[2] / "tutorials"))
    try:
        import lectures
    finally:
        sys.path.pop(0)
    seen = []
    with Image(as_now=True):
        session = Session(time="virtual", seed=3)
        graph.active().node("onlooker", hidden=True).subscribe(
            "/turtle1/pose", message_class_exact("turtlesim/Pose"), lambda pose: seen.append(to_json(pose))
        )
        with chronicle.record(tmp_path / "x.mcap"):
            for form in lectures.LECTURE_38:
                session.evaluate_text(form)
    path = tmp_path / "x.mcap"
    assert [data for _, data in messages_of(path, "/turtle1/pose")] == seen and len(seen) > 600
    modules = [data["modules"] for _, data in messages_of(path, "/cramhy/process_modules")]
    assert {module["name"] for listed in modules for module in listed} == {"TURTLESIM-NAVIGATION", "TURTLESIM-PEN-CONTROL"}
    assert any(module["queue"] for listed in modules for module in listed)
    tasks = [task for _, tree in messages_of(path, "/cramhy/tasks") for task in tree["tasks"]]
    assert {task["id"] for task in tasks} == {task["id"] for task in tasks if task["ended"] is not None}
    assert {"TOP-LEVEL", "PROCESS-MODULES", "PAR", "PURSUE"} <= {task["operator"] for task in tasks}
    worlds = [data for _, data in messages_of(path, "/cramhy/world")]
    assert len({(stroke["r"], stroke["g"], stroke["b"]) for world in worlds for stroke in world["strokes"]}) > 8
