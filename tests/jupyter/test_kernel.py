"""The kernel through Jupyter's own client: each kind of message, what is printed, interruption through cleanup, input, bad messages."""

from __future__ import annotations

import signal

import pytest


def test_a_cell_answers_with_the_value_of_its_last_form(cells):
    answer = cells.run("(defvar *seven* 7)\n(list 1 *seven*)")
    assert (answer.reply["status"], answer.text) == ("ok", "(1 7)")
    assert answer.of("execute_input")[0]["code"].startswith("(defvar")
    assert cells.run("(values 1 2)").text == "1\n2"
    assert not cells.run("(values)").of("execute_result")


def test_the_package_stays_for_the_next_cell(cells):
    cells.run("(defpackage :garden (:use :cl)) (in-package :garden)")
    assert cells.run("(package-name *package*)").text == '"GARDEN"'


def test_what_a_program_prints_goes_out_in_order_while_it_runs(cells):
    answer = cells.run('(progn (format t "one~%") (warn "two") (format t "three~%") (read-line))', typed=["four"])
    assert answer.printed.index("one") < answer.printed.index("two") < answer.printed.index("three")
    assert answer.of("input_request") and answer.text.startswith('"four"')


def test_without_a_front_end_for_input_the_input_has_ended(cells):
    assert cells.run('(read-line *standard-input* nil "none")').text.startswith('"none"')


def test_an_error_is_told_as_at_the_prompt_with_its_restarts(cells):
    answer = cells.run('(restart-case (car 7) (use-nothing () :report "Use nothing." nil))')
    (error,) = answer.of("error")
    shown = "\n".join(error["traceback"])
    assert answer.reply["status"] == "error" and error["ename"] == "TYPE-ERROR"
    assert "is not of type" in shown and "(car 7)" in shown and "Use nothing." in shown and "[ABORT]" in shown
    assert cells.run("(+ 1 1)").text == "2"


def test_an_error_in_a_branch_of_a_plan_is_told_once_after_its_cleanup(cells):
    answer = cells.run('(cpl:top-level (cpl:par (unwind-protect (cpl:sleep 5) (print :cleaned)) (error "broken arm")))')
    assert len(answer.of("error")) == 1 and "broken arm" in answer.reply["evalue"] and ":CLEANED" in answer.printed


def test_the_debugger_asks_if_it_is_told_to(cells):
    cells.run("%debugger on")
    try:
        answer = cells.run('(restart-case (error "which?") (take (x) x) (five () :report "Take five." 5))', typed=["(+ 40 2)", "9", "1"])
    finally:
        cells.run("%debugger off")
    assert answer.text == "5"
    assert "42" in answer.printed and "There is no choice 9" in answer.printed and "Take five." in answer.printed


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("form", ["(cpl:wait-for (cpl:make-fluent :value nil))", "(loop (cpl:sleep 1))", "(loop)"])
def test_an_interrupt_ends_a_cell_through_the_cleanup_of_its_plan(cells, form):
    def stop(kind, content):
        if kind == "stream" and "begun" in content["text"]:
            cells.manager.interrupt_kernel()

    answer = cells.run(f'(cpl:top-level (unwind-protect (progn (format t "begun~%") {form}) (format t "cleaned up~%")))', on_message=stop)
    assert answer.reply["status"] == "error" and answer.reply["ename"] == "Interrupted"
    assert "cleaned up" in answer.printed
    assert cells.run("(+ 2 2)").text == "4"


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "form", ["(while True)", "(for [i (range (** 10 12))])", "(wait-for (make-fluent :value None))", "(while True (sleep 1))"]
)
def test_an_interrupt_ends_a_cell_of_hy_through_its_cleanup(cells, form):
    def stop(kind, content):
        if kind == "stream" and "begun" in content["text"]:
            cells.manager.interrupt_kernel()

    answer = cells.run(f'%%hy\n(top-level (try (print "begun") {form} (finally (sleep 1) (print "cleaned up"))))', on_message=stop)
    assert answer.reply["ename"] == "Interrupted" and "cleaned up" in answer.printed
    assert cells.run("(+ 2 2)").text == "4"


def test_an_interrupt_while_time_is_paused_lets_the_cleanup_end(cells):
    def stop(kind, content):
        if kind == "stream" and "begun" in content["text"]:
            cells.manager.interrupt_kernel()

    cells.run("%%hy\n(import cramhy-runtime [kernel]) (.pause (kernel.pace))")
    plan = '(unwind-protect (progn (format t "begun~%") (cpl:sleep 100)) (cpl:sleep 1) (format t "cleaned up~%"))'
    answer = cells.run(f"(cpl:top-level {plan})", on_message=stop)
    assert answer.reply["ename"] == "Interrupted" and "cleaned up" in answer.printed
    assert cells.run("(cpl:top-level (cpl:sleep 1) :goes-on)").text == ":GOES-ON"


def test_a_display_is_updated_while_a_plan_runs_and_not_where_nobody_looks_on(cells):
    plan = "(cpl:top-level (cpl:par (cpl:sleep 2) (cpl:sleep 1)))"
    cells.run("%%hy\n(import cramhy-runtime.jupyter [live]) (setv live.SOON 0 live.OFTEN 0)")
    try:
        kinds = [kind for kind, _ in cells.run(plan, typed=[]).messages if "display" in kind]
        assert kinds[0] == "display_data" and "update_display_data" in kinds
        assert not [kind for kind, _ in cells.run(plan).messages if "display" in kind]  # as with nbconvert
        cells.run("%live off")
        assert not [kind for kind, _ in cells.run(plan, typed=[]).messages if "display" in kind]
    finally:
        cells.run("%live on")
        cells.run("%%hy\n(setv live.SOON 0.5 live.OFTEN 0.25)")


def test_an_interrupt_between_cells_does_nothing(cells):
    cells.manager.signal_kernel(signal.SIGINT)
    assert cells.run("(+ 3 3)").text == "6"


def test_an_interrupt_while_a_cell_reads_a_line(cells):
    asked = cells.client.execute('(unwind-protect (read-line) (print "over"))', allow_stdin=True, stop_on_error=False)
    assert cells.client.get_stdin_msg(timeout=60)["msg_type"] == "input_request"
    cells.manager.interrupt_kernel()
    while (reply := cells.client.get_shell_msg(timeout=60))["parent_header"].get("msg_id") != asked:
        pass
    assert reply["content"]["ename"] == "Interrupted"
    assert cells.run("(+ 1 1)").text == "2"


def test_cells_of_hy(cells):
    assert cells.run("%%hy\n(require cramhy *)\n(setv answer [1 2])\nanswer").text == "[1 2]"
    cells.run("(in-hy)")
    assert cells.run('(print "from Hy")\n(len answer)').printed == "from Hy\n"
    answer = cells.run("(/ 1 0)")
    assert answer.reply["status"] == "error" and "division" in answer.reply["evalue"].lower()
    assert cells.run("(in-package :cl-user) (cons 1 2)").text == "(1 . 2)"
    assert cells.run("(cons 3 4)").text == "(3 . 4)"


def test_a_cell_writes_a_file(cells):
    cells.run("%%writefile made/five.lisp\n(defun five () 5)")
    assert cells.run('(load "made/five.lisp") (five)').text == "5"


def test_user_expressions_and_silence(cells):
    answer = cells.run("(+ 1 1)", user_expressions={"good": "(* 6 7)", "bad": "(car 1)"})
    assert answer.reply["user_expressions"]["good"]["data"]["text/plain"] == "42"
    assert answer.reply["user_expressions"]["bad"]["ename"] == "TYPE-ERROR"
    assert not cells.run("(+ 1 1)", silent=True).of("execute_result")


def test_completion(cells):
    found = cells.client.complete("(list (mapc", reply=True, timeout=60)["content"]
    assert "mapcar" in found["matches"] and (found["cursor_start"], found["cursor_end"]) == (7, 11)
    found = cells.client.complete("(cpl:with-fail)", cursor_pos=14, reply=True, timeout=60)["content"]
    assert "cpl:with-failure-handling" in found["matches"]
    assert cells.client.complete("(zzzzzz", reply=True, timeout=60)["content"]["matches"] == []


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("text", "offered"), [("(cp", ["cpl:", "cpm:"]), ("(top", ["top-level"]), ("(make-fluent :na", [":name"]), ("(defn f [", [])]
)
def test_completion_in_hy_is_that_of_its_prompt(cells, text, offered):
    code = f"%%hy\n{text}"
    found = cells.client.complete(code, reply=True, timeout=60)["content"]
    assert set(offered) <= set(found["matches"]) and len(found["matches"]) < 50
    assert all(name.startswith(code[found["cursor_start"] : found["cursor_end"]]) for name in found["matches"])


def test_inspection(cells):
    found = cells.client.inspect("(mapcar #'car", 3, reply=True, timeout=60)["content"]
    assert found["found"] and "(mapcar" in found["data"]["text/plain"]
    cells.run('(defun spin (angle &key (speed 1)) "Turns." (list angle speed))')
    found = cells.client.inspect("(spin 3 ", 8, reply=True, timeout=60)["content"]
    assert "(spin ANGLE &KEY (SPEED 1))" in found["data"]["text/plain"] and "Turns." in found["data"]["text/plain"]
    assert not cells.client.inspect("zzzz", 2, reply=True, timeout=60)["content"]["found"]


@pytest.mark.parametrize(
    ("code", "status"), [("(list 1", "incomplete"), ("(list 1)", "complete"), ('(print "a', "incomplete"), ("%%hy\n[1 2", "incomplete")]
)
def test_is_complete(cells, code, status):
    assert cells.completeness(code) == status


def test_kernel_info(cells):
    info = cells.client.kernel_info(reply=True, timeout=60)["content"]
    assert info["implementation"] == "cramhy" and info["language_info"]["file_extension"] == ".lisp"


def test_messages_that_are_wrong_cost_nothing(cells):
    session, channel = cells.client.session, cells.client.shell_channel
    for kind, content in (
        ("execute_request", {}),
        ("execute_request", {"code": None}),
        ("complete_request", {"code": 5, "cursor_pos": "x"}),
        ("inspect_request", {"code": "(car", "cursor_pos": -(10**6)}),
        ("no_such_request", {"a": [1]}),
        ("is_complete_request", {"code": None}),
    ):
        channel.send(session.msg(kind, content))
    channel.socket.send_multipart([b"<IDS|MSG>", b"no signature", b"{", b"{}", b"{}", b"{}"])
    channel.socket.send_multipart([b"rubbish"])
    assert cells.run("(* 3 3)").text == "9"


def test_a_turtle_that_drove_is_shown(cells):
    answer = cells.run(
        '(roslisp:start-ros-node "drives") (roslisp:call-service "/turtle1/teleport_relative" \'turtlesim-srv:TeleportRelative :linear 2 :angular 1)'
    )
    (picture,) = answer.of("display_data")
    assert picture["data"]["image/svg+xml"].startswith("<svg") and "turtle1" in picture["data"]["text/plain"]
    assert not cells.run("(+ 1 1)").of("display_data")
    cells.run("(roslisp:shutdown-ros-node)")


def test_values_that_are_shown_as_html(cells):
    table = cells.run('(cut:force-ll (prolog:prolog \'(prolog:member ?x (1 2 "<b>"))))').html
    assert table.startswith("<table>") and "?X" in table and "&lt;b&gt;" in table and "<b>" not in table
    assert "not resolved yet" in cells.run("(desig:a motion (type driving) (speed 3))").html
    tree = cells.run('(roslisp:make-message "geometry_msgs/Twist" (:x :linear) 1.5)').html
    assert "geometry_msgs/Twist" in tree and "1.5" in tree
    assert "lost" in cells.run('(make-condition \'simple-error :format-control "lost")').html
    assert cells.run("(list 1 2)").html is None
    (outline,) = cells.run("(prolog:explain '(member 3 (1 2)))").of("display_data")
    assert "3 is not among (1 2)." in outline["data"]["text/html"] and "3 is not among (1 2)." in outline["data"]["text/plain"]
    assert "no solution" in cells.run("(with-output-to-string (*standard-output*) (prolog:explain '(member 3 (1 2))))").text
    cells.run("(defvar *speed* (cpl:make-fluent :name 'speed :value 0))")
    cells.run("%watch *speed*")
    (plot,) = cells.run("(cpl:top-level (cpl:sleep 1) (setf (cpl:value *speed*) 5))").of("display_data")
    assert "SPEED" in plot["data"]["image/svg+xml"]
    assert "<svg" in cells.run("*speed*").html and not cells.run("(+ 1 1)").of("display_data")
    cells.run("%watch off")
    assert "<svg" not in cells.run("*speed*").html


@pytest.mark.parametrize(
    ("code", "typed", "value"),
    [
        ('%%hy\n(input "x? ")', ["this"], "this"),
        ('%%hy\n(import sys)\n(.write sys.stdout "x? ")\n(.rstrip (.readline sys.stdin))', ["this"], "this"),
        ('(py:input "x? ")', ["this"], "this"),
        ('(if (y-or-n-p "x? ") "this" "that")', ["perhaps", "y"], "this"),
        ('%%hy\n(import getpass)\n(getpass.getpass "x? ")', ["this"], "this"),
    ],
    ids=["input", "readline", "input from Lisp", "y-or-n-p", "getpass"],
)
def test_a_cell_that_asks(cells, code, typed, value):
    answer = cells.run(code, typed=typed)
    assert answer.text.startswith(f'"{value}"')
    assert "x? " in answer.printed + "".join(asked["prompt"] for asked in answer.of("input_request"))
    assert all(asked["password"] == ("getpass" in code) for asked in answer.of("input_request"))


@pytest.mark.parametrize("code", ['%%hy\n(input "x? ")', '(y-or-n-p "x? ")', "(py:input)", "(read-line)"])
def test_a_cell_that_asks_where_nobody_can_answer_fails(cells, code):
    assert cells.run(code).reply["ename"] in ("END-OF-FILE", "PYTHON:EOF-ERROR", "EOFError")


def test_an_error_in_a_cell_of_hy_has_its_name_of_python(cells):
    for code, name in (("(+ 1 two)", "NameError"), ("(/ 1 0)", "ZeroDivisionError"), ("(top-level (get [] 3))", "IndexError")):
        answer = cells.run(f"%%hy\n{code}")
        assert answer.reply["ename"] == name and answer.of("error")[0]["traceback"][0] == name
    assert cells.run("%%lisp\n(+ 1 two)").reply["ename"] == "UNBOUND-VARIABLE"


@pytest.mark.parametrize(
    "code", ['%%hy\n(import time)\n(print "begun")\n(time.sleep 1000)', '(progn (print "begun") (py:call "time.sleep" 1000))']
)
def test_a_cell_that_sleeps_in_python_is_interrupted(cells, code):
    def stop(kind, content):
        if kind == "stream" and "begun" in content["text"]:
            cells.manager.interrupt_kernel()

    assert cells.run(code, on_message=stop).reply["ename"] == "Interrupted"
    assert cells.run("%%lisp\n(+ 1 1)").text == "2"
