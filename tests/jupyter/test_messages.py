"""Each kind of message of Jupyter's protocol, by its client: what is asked, what comes back, and refusals with their reasons."""

from __future__ import annotations

import pytest

PATIENCE = 60


def reply(cells, kind, content, channel="shell"):
    """The reply to a message, its content; and what came on iopub for it."""
    session = cells.client.session
    message = session.msg(kind, content)
    where = getattr(cells.client, f"{channel}_channel")
    where.send(message)
    while True:
        came = where.get_msg(timeout=PATIENCE)
        if came["parent_header"].get("msg_id") == message["header"]["msg_id"]:
            return came["content"]


def test_kernel_info_offers_neither_subshells_nor_a_debugger(cells):
    info = reply(cells, "kernel_info_request", {})
    assert info["status"] == "ok" and info["supported_features"] == []
    assert info["language_info"]["codemirror_mode"] == "commonlisp"


def test_history_tells_the_cells(cells):
    for code in ("(list :remember 1)", "(list :remember 2)"):
        cells.run(code)
    tail = reply(cells, "history_request", {"hist_access_type": "tail", "n": 2, "output": False, "raw": True})
    assert [entry[2] for entry in tail["history"]] == ["(list :remember 1)", "(list :remember 2)"]
    number = tail["history"][0][1]
    found = reply(cells, "history_request", {"hist_access_type": "search", "pattern": "*remember 2*", "n": 5, "output": True, "raw": True})
    assert found["history"] == [[0, number + 1, ["(list :remember 2)", None]]]
    some = reply(cells, "history_request", {"hist_access_type": "range", "start": number, "stop": number + 1, "output": False, "raw": True})
    assert [entry[2] for entry in some["history"]] == ["(list :remember 1)"]


def test_silent_cells_are_not_in_the_history(cells):
    cells.run("(list :hush)", silent=True)
    tail = reply(cells, "history_request", {"hist_access_type": "tail", "n": 1, "output": False, "raw": True})
    assert "hush" not in str(tail["history"])


def test_a_debug_request_is_refused_with_the_reason(cells):
    refused = reply(cells, "debug_request", {"type": "request", "seq": 7, "command": "initialize", "arguments": {}}, "control")
    assert (refused["success"], refused["request_seq"], refused["command"]) == (False, 7, "initialize")
    assert "%debugger on" in refused["message"]


def test_a_subshell_is_refused_with_the_reason(cells):
    refused = reply(cells, "create_subshell_request", {}, "control")
    assert refused["status"] == "error" and "one shell" in refused["evalue"]


def test_an_interrupt_that_comes_as_a_message(cells):
    def stop(kind, content):
        if kind == "stream" and "begun" in content["text"]:
            cells.client.control_channel.send(cells.client.session.msg("interrupt_request", {}))

    answer = cells.run(
        '(cpl:top-level (unwind-protect (progn (format t "begun~%") (loop (cpl:sleep 1))) (format t "cleaned up~%")))', on_message=stop
    )
    assert answer.reply["ename"] == "Interrupted" and "cleaned up" in answer.printed
    assert cells.client.control_channel.get_msg(timeout=PATIENCE)["content"]["status"] == "ok"


def test_connections_of_widgets_open_speak_and_close(cells):
    send, session = cells.client.shell_channel.send, cells.client.session
    send(session.msg("comm_open", {"comm_id": "one", "target_name": "nobody", "data": {}}))
    closed = None
    while closed is None:
        came = cells.client.get_iopub_msg(timeout=PATIENCE)
        closed = came if came["msg_type"] == "comm_close" else None
    assert closed["content"]["comm_id"] == "one"  # nobody serves it
    send(session.msg("comm_msg", {"comm_id": "one", "data": {}}))
    send(session.msg("comm_close", {"comm_id": "one", "data": {}}))
    assert reply(cells, "comm_info_request", {}) == {"comms": {}, "status": "ok"}


def test_the_controls_of_time_pause_step_and_go_on_while_a_cell_runs(cells):
    pytest.importorskip("ipywidgets", reason="the buttons are made with it")
    (shown,) = cells.run("%pace").of("display_data")
    assert "application/vnd.jupyter.widget-view+json" in shown["data"]
    comms = reply(cells, "comm_info_request", {"target_name": "jupyter.widget"})["comms"]
    send, session = cells.client.shell_channel.send, cells.client.session
    states = {}
    control = session.msg("comm_open", {"comm_id": "page", "target_name": "jupyter.widget.control", "data": {}})
    send({**control, "metadata": {"version": "1.0.0"}})
    send(session.msg("comm_msg", {"comm_id": "page", "data": {"method": "request_states"}}))
    while not states:
        came = cells.client.get_iopub_msg(timeout=PATIENCE)
        if came["msg_type"] == "comm_msg" and came["content"]["data"].get("method") == "update_states":
            states = {name: each["state"] for name, each in came["content"]["data"]["states"].items()}
    assert set(states) <= set(comms) | {"page"}
    (pause,) = [name for name, state in states.items() if state.get("description") == "Pause"]
    (step,) = [name for name, state in states.items() if state.get("description") == "Step"]

    def press(paused):
        send(session.msg("comm_msg", {"comm_id": pause, "data": {"method": "update", "state": {"value": paused}}}))

    press(True)
    while not (came["msg_type"] == "comm_msg" and came["content"]["data"].get("state", {}).get("description") == "Go on"):
        came = cells.client.get_iopub_msg(timeout=PATIENCE)

    statuses = []

    def use(kind, content):
        if kind == "status":
            statuses.append(content["execution_state"])
        if kind == "stream" and "begun" in content["text"]:
            send(session.msg("comm_msg", {"comm_id": step, "data": {"method": "custom", "content": {"event": "click"}}}))
        elif kind == "stream" and "stepped" in content["text"]:
            press(False)

    plan = '(format t "begun~%") (cpl:sleep 0.5) (format t "stepped~%") (cpl:sleep 100) :over'
    answer = cells.run(f"(cpl:top-level {plan})", on_message=use)
    assert answer.text == ":OVER" and answer.printed == "begun\nstepped\n"


WRONG = [
    ("execute_request", {}, "execute_request has no field code."),
    ("execute_request", {"code": None}, "The field code of execute_request is a string, not None."),
    ("complete_request", {"code": 5, "cursor_pos": 0}, "The field code of complete_request is a string, not 5."),
    ("complete_request", {"code": "(", "cursor_pos": "x"}, "The field cursor_pos of complete_request is an integer, not 'x'."),
    ("inspect_request", {"code": "(car"}, "inspect_request has no field cursor_pos."),
    ("inspect_request", {"code": "(car", "cursor_pos": True}, "The field cursor_pos of inspect_request is an integer, not True."),
    ("is_complete_request", {"code": ["("]}, "The field code of is_complete_request is a string, not ['(']."),
    ("is_complete_request", b"[1]", "The content of is_complete_request is an object, not [1]."),
    (
        "history_request",
        {"hist_access_type": "tail", "n": "x", "output": False, "raw": True},
        "history_request was not understood: TypeError",
    ),
    ("no_such_request", {"a": 1}, "This kernel does not know messages of the kind 'no_such_request'."),
]


@pytest.mark.parametrize(("kind", "content", "reason"), WRONG)
def test_a_wrong_message_is_refused_with_the_reason(cells, kind, content, reason):
    refused = reply(cells, kind, content)
    assert refused["status"] == "error" and refused["evalue"].startswith(reason)


@pytest.mark.parametrize("cursor", [-(10**6), 10**9])
def test_a_cursor_outside_of_the_cell_is_moved_into_it(cells, cursor):
    assert reply(cells, "complete_request", {"code": "(mapc", "cursor_pos": cursor})["status"] == "ok"
    assert reply(cells, "inspect_request", {"code": "(mapc", "cursor_pos": cursor})["status"] == "ok"


def test_cells_behind_one_that_fails_are_not_run(cells):
    """The first cell waits for a line, which is typed when the others have been sent: else it might end before they are there."""
    send = cells.client.execute
    asked = [send('(progn (read-line) (error "stop"))', allow_stdin=True)]
    cells.client.get_stdin_msg(timeout=PATIENCE)
    asked += [send("(defvar *never* 1)"), send("(defvar *never* 2)")]
    cells.client.input("go on")
    statuses = {}
    while len(statuses) < 3:
        came = cells.client.get_shell_msg(timeout=PATIENCE)
        if came["parent_header"].get("msg_id") in asked:
            statuses[came["parent_header"]["msg_id"]] = came["content"]["status"]
    assert [statuses[each] for each in asked] == ["error", "aborted", "aborted"]
    assert cells.run("(boundp '*never*)").text == "NIL"


def test_what_a_setting_refuses(cells):
    for code, reason in (
        ("%time bogus", "Behind %time stands virtual or wall, not bogus."),
        ("%debugger", "Behind %debugger stands on or off, not nothing."),
        ("%pace 2", "%pace stands alone, without 2."),
        ("%watch 7", "%watch is for fluents, and 7 is none. Give it forms whose values are fluents."),
        ("%watch", "%watch is for fluents: give it forms whose values are fluents, or off."),
    ):
        assert cells.run(code).reply["evalue"] == reason
    assert "is unbound" in cells.run("%watch *no-such-fluent*").reply["evalue"]
