"""The Lisp packages ACTIONLIB-LISP and ACTIONLIB. Source: roslisp.md 13.

They are made when a program first names one of them or asks for their system (``image.define_actionlib``); the course has no
actions. The functions of both on goals that were sent are the same; ACTIONLIB's take the handles of its `send-goal`, too.
"""

from __future__ import annotations

import importlib

from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import ACTIONLIB
from cramhy_runtime.lisp_core.floats import literal_float
from cramhy_runtime.lisp_core.classes import register_class
from cramhy_runtime.lisp_core.packages import ensure_package, on_demand, sym

NAMES = ("ACTIONLIB-LISP", "ACTIONLIB")


def define_faces():
    """Make the packages, once."""
    if on_demand.pop(NAMES[0], None) is None:
        return
    for name in NAMES:
        on_demand.pop(name, None)
        ensure_package(name)
    from cramhy_runtime.actionlib import calls, client, goal_server, server, simple_client
    from . import macro_support

    define_face(
        "ACTIONLIB-LISP",
        functions={
            simple_client: "cancel-all-goals cancel-goal comm-state goal-id goal-status is-connected make-simple-action-client result "
            "make-action-client send-goal send-goal-and-wait state stop-tracking-goal terminal-state wait-for-result wait-for-server",
            "cancel": simple_client.cancel_goal,
            "cancel-at-before-time": simple_client.cancel_at_before_time,
        },
        export="simple-action-client",
        internal="make-action-client",
    )
    define_face(
        "ACTIONLIB",
        functions={
            calls: "make-action-client call-goal send-goal send-goal-and-wait simple-state goal feedback",
            simple_client: "wait-for-server cancel-goal cancel-all-goals cancel-at-before-time is-connected goal-id "
            "goal-status comm-state terminal-state result",
            server: "start-action-server cancel-request-received",
            macro_support: "build-goal end-goal tell-feedback check-left",
            "connected-to-server": simple_client.is_connected,
            "wait-for-result": simple_client.wait_for_the_result,
        },
        variables={
            "*action-server-timeout*": literal_float(client.CONNECTED),
            "*status-publish-interval*": literal_float(goal_server.PERIOD),
            "*gc-interval*": literal_float(goal_server.MEMORY),
        },
        export="exec-callback-tag abort-goal feedback-signal server-lost",
        # macros expand into the first ones: a kept file names them, and so makes the packages
        internal="build-goal end-goal tell-feedback check-left cancel-all-goals cancel-at-before-time is-connected goal-status comm-state "
        "terminal-state",
    )
    for cls in (
        client.ActionClient,
        simple_client.SimpleActionClient,
        simple_client.ClientGoalHandle,
        calls.HandlingClient,
        calls.GoalHandle,
        calls.ServerLost,
        calls.FeedbackSignal,
    ):
        register_class(sym(cls.lisp_name), cls)
    export(ACTIONLIB)
    importlib.import_module("cramhy.actionlib")
