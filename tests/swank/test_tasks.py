"""Plans that run while Emacs looks on: the list of threads, interrupts, ends."""

from __future__ import annotations

import pytest

PLAN = "(cpl:top-level (unwind-protect (cpl:par (loop (sleep 1)) (loop (sleep 2))) (setf *stopped* :stopped)))"


@pytest.fixture
def plan(emacs):
    """The number of the call of a plan that runs without end; its cleanup sets ``*stopped*``."""
    emacs.repl("(defvar *stopped* nil)")
    number = emacs.rex(f'(swank-repl:listener-eval "{PLAN}")', thread=":repl-thread")
    emacs.call('(swank:interactive-eval "(sleep 3)")')
    return number


def threads(emacs):
    head, *rows = emacs.call("(swank:list-threads)")
    assert head == [":id", ":name", ":status"]
    return rows


def index_of(emacs, text):
    return next(index for index, row in enumerate(threads(emacs)) if text in row[1])


def test_the_list_is_the_tree_of_tasks(emacs, plan):
    rows = threads(emacs)
    names = [row[1] for row in rows]
    assert names[0] == "main" and names[1] == "  Emacs: listener-eval"
    assert names[2].startswith("    [TOP-LEVEL]") and names[3].startswith("      [PAR-CHILD-#1/2]")
    assert rows[3][2].startswith("waits for the time ")
    assert emacs.call("(swank:quit-thread-browser)") is None
    assert emacs.refused("(swank:kill-nth-thread 1)") == "There is no thread 1 in the list. List them again."


def test_an_interrupt_runs_the_cleanup(emacs, plan):
    emacs.interrupt()
    assert emacs.wait(plan) == [":abort", "interrupted"]
    assert emacs.repl("*stopped*") == ":STOPPED\n"
    assert len(threads(emacs)) == 2


def test_an_interrupt_of_any_thread_means_the_newest_form(emacs, plan):
    other = emacs.rex('(swank:interactive-eval "(sleep 1000)")')
    emacs.call('(swank:interactive-eval "1")')
    emacs.interrupt("t")
    assert emacs.wait(other) == [":abort", "interrupted"]
    assert len(threads(emacs)) > 3


def test_an_interrupt_of_nothing_does_nothing(emacs):
    emacs.interrupt()
    emacs.interrupt("t")
    emacs.interrupt("12345")
    assert emacs.repl("1") == "1\n"


def test_a_loop_without_waits_is_interrupted(emacs):
    number = emacs.rex('(swank-repl:listener-eval "(loop)")', thread=":repl-thread")
    emacs.call('(swank:interactive-eval "1")')
    emacs.interrupt()
    assert emacs.wait(number) == [":abort", "interrupted"]


def test_a_second_interrupt_abandons_the_cleanup(emacs):
    form = "(unwind-protect (sleep 1000) (loop (sleep 1)))"
    number = emacs.rex(f'(swank-repl:listener-eval "{form}")', thread=":repl-thread")
    emacs.call('(swank:interactive-eval "(sleep 1)")')
    emacs.interrupt()
    emacs.call('(swank:interactive-eval "(sleep 5)")')
    assert number not in emacs.answers
    emacs.interrupt()
    assert emacs.wait(number) == [":abort", "interrupted"]


def test_a_form_that_has_not_begun_is_interrupted(emacs):
    number = emacs.rex('(swank-repl:listener-eval "(setf *never* 1)")', thread=":repl-thread")
    emacs.interrupt()
    assert emacs.wait(number) == [":abort", "interrupted"]
    assert emacs.repl("(boundp '*never*)") == "NIL\n"


def test_a_form_is_killed_in_the_list(emacs, plan):
    emacs.call(f"(cl:mapc 'swank:kill-nth-thread '({index_of(emacs, 'listener-eval')}))")
    assert emacs.wait(plan) == [":abort", "interrupted"]
    assert emacs.repl("*stopped*") == ":STOPPED\n"


def test_a_branch_is_killed_in_the_list(emacs):
    form = "(cpl:top-level (cpl:pursue (loop (sleep 1)) (sleep 1000)))"
    number = emacs.rex(f'(swank-repl:listener-eval "{form}")', thread=":repl-thread")
    emacs.call('(swank:interactive-eval "(sleep 3)")')
    emacs.call(f"(swank:kill-nth-thread {index_of(emacs, '#2/2')})")
    assert emacs.wait(number)[0] in (":ok", ":abort")
    assert len(threads(emacs)) == 2


def test_the_main_task_is_not_killed(emacs):
    index = index_of(emacs, "main")
    assert emacs.refused(f"(swank:kill-nth-thread {index})") == "The main task cannot be killed. To end the session, type (quit)."


def test_a_task_is_stopped_in_the_debugger(emacs, plan):
    emacs.call(f"(swank:debug-nth-thread {index_of(emacs, '#1/2')})")
    thread, level, condition, restarts, _ = emacs.debugged()
    assert level == 1 and condition[0].startswith("  Stopped from Emacs.") and restarts[0] == ["CONTINUE", "Return from BREAK."]
    emacs.refused("(swank:sldb-continue)", thread=thread)
    assert plan not in emacs.answers
    index = index_of(emacs, "main")
    assert emacs.refused(f"(swank:debug-nth-thread {index})").startswith("Only tasks that a form from this Emacs has started")


def test_a_client_that_goes_takes_its_plans_with_it(emacs, plan, session):
    from .client import Emacs

    emacs.connection.lost()
    other = Emacs(session, emacs.server)
    assert other.call('(swank:interactive-eval "*stopped*")') == "=> :STOPPED"
    assert len(threads(other)) == 2
    assert emacs.server.connections == [other.connection]


def test_the_turtle_stops(session):
    from cramhy_runtime import kernel
    from cramhy_runtime.turtlesim.node import start_with_first_node

    from .client import Emacs

    start_with_first_node()
    emacs = Emacs(session)
    for form in (
        '(roslisp:start-ros-node "driver")',
        '(defvar *publisher* (roslisp:advertise "turtle1/cmd_vel" "geometry_msgs/Twist"))',
        '(defun drive (speed) (roslisp:publish *publisher* (roslisp:make-message "geometry_msgs/Twist" (x linear) speed)))',
        "(defvar *x* nil)",
        '(roslisp:subscribe "turtle1/pose" "turtlesim/Pose" (lambda (pose) (setf *x* (turtlesim-msg:x pose))))',
    ):
        emacs.repl(form)
    form = "(cpl:top-level (unwind-protect (loop (drive 0.5) (sleep 0.1)) (drive 0)))"
    number = emacs.rex(f'(swank-repl:listener-eval "{form}")', thread=":repl-thread")
    before = emacs.call('(swank:interactive-eval "(progn (sleep 1) *x*)")')
    assert emacs.call('(swank:interactive-eval "(progn (sleep 1) *x*)")') != before
    emacs.interrupt()
    assert emacs.wait(number) == [":abort", "interrupted"]
    stopped = emacs.call('(swank:interactive-eval "(progn (sleep 1) *x*)")')
    kernel.sleep(2)
    assert emacs.call('(swank:interactive-eval "(progn (sleep 1) *x*)")') == stopped


def test_a_server_is_not_started_twice_from_emacs(emacs):
    assert emacs.refused('(swank:start-swank-server-in-thread 1 "f")') == "A session listens once. Connect to the same port again."
