"""The npm package roslib, as it is, under Node: it drives the turtle, asks for all that rosapi tells, and serves a plan in Lisp."""

from __future__ import annotations

import json
import subprocess

import pytest


@pytest.mark.soak
def test_roslib_under_node(roslib_folder, beside):
    from cramhy_runtime import kernel, rosbridge
    from cramhy_runtime.repl.session import Session

    session = Session(time="wall")
    session.package = "CRAM-USER"
    server = rosbridge.start(session)
    found = {}

    def client():
        done = subprocess.run(["node", "drive.js", server.address], cwd=roslib_folder, capture_output=True, text=True, timeout=100)
        found.update(json.loads(line) for line in done.stdout.splitlines())
        assert (done.returncode, done.stderr) == (0, ""), done.stderr

    try:
        session.evaluate_text('(roslisp:start-ros-node "lisp")')
        finish = beside(client)
        (total,) = session.evaluate_text(
            """(progn (roslisp:wait-for-service "/sum" 60)
                      (roslisp:msg-slot-value (roslisp:call-service "/sum" "roscpp_tutorials/TwoInts" :a 20 :b 22) :sum))"""
        )
        finish()
    finally:
        kernel.stop()
    assert total == 42
    assert found.pop("first")["x"] == pytest.approx(5.5444, abs=1e-3)
    assert found.pop("node")["publishing"] == ["/rosout", "/turtle1/color_sensor", "/turtle1/pose"]
    pose = ["x", "y", "theta", "linear_velocity", "angular_velocity"]
    vector = {"x": "float64", "y": "float64", "z": "float64"}
    refused = {"refused": "The service /kill refused, without a reason."}
    assert found == {
        "moved": True,
        "png": pose,
        "cbor": pose,
        "spawn": {"name": "anna"},
        "pen": {},
        "teleport": {},
        "relative": {},
        "kill": {},
        "killed": refused,
        "clear": {},
        "reset": {},
        "topics": True,
        "types": True,
        "for type": ["/turtle1/color_sensor"],
        "topic type": "geometry_msgs/Twist",
        "services": True,
        "services for type": ["/spawn"],
        "service type": "turtlesim/SetPen",
        "request": ["x", "y", "theta", "name"],
        "response": ["name"],
        "message": {"linear": vector, "angular": vector},
        "nodes": True,
        "actions": [],
        "param": 200,
        "params": True,
        "asked": [20, 22],
        "answered": True,
    }
