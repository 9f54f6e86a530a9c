"""``describe-task-tree``: what it shows of plans that run, have ended, or were ended; and that it changes nothing."""

import io
import re

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.tasks import tasks
from cramhy_runtime.cpl.tree import tree_report
from cramhy_runtime.repl.session import Interruption, Session


DRIVE = "(def-cram-function drive (x y) (par (sleep x) (wait-for (make-fluent :name 'arrived)) y))"
RUNNING = """\
[TOP-LEVEL]  running for 2 s, waits for the branches of PAR at <repl 3>:1:12
├─ [PAR-CHILD-#1/3]  running for 2 s, waits for the branches of PURSUE at <repl 3>:2:3
│  ├─ [PURSUE-CHILD-#1/2]  running for 2 s, waits for its child at <repl 3>:2:11
│  │  └─ [REPLACEABLE-FUNCTION-DRIVE] (DRIVE 5 HOME)  running for 2 s, waits for the branches of PAR at <repl 2>:1:32
│  │     ├─ [PAR-CHILD-#1/3]  running for 2 s, waits for the time 5 s (sleep 5) at <repl 2>:1:37
│  │     └─ [PAR-CHILD-#2/3]  running for 2 s, waits for the fluent #<FLUENT ARRIVED [NIL]> at <repl 2>:1:47
│  └─ [PURSUE-CHILD-#2/2]  running for 2 s, waits for the time 3 s (sleep 3) at <repl 3>:2:27
├─ [PAR-CHILD-#2/3]  succeeded after 1 s: 7, "there"
│  └─ [TAG-GRASP] (TAGGED GRASP)  succeeded after 1 s: 7, "there"
└─ [PAR-CHILD-#3/3]  running for 2 s, prints this
"""


class Lisp:
    """A session in which Lisp text is evaluated, with what it printed."""

    def __init__(self, backend):
        self.session = Session(time="virtual", backend=backend, turtlesim=False)
        self.session.package = "CRAM-USER"

    def __call__(self, text):
        return self.session.evaluate_text(text)

    def report(self, form="(describe-task-tree)"):
        """What ``form`` prints, numberless."""
        return self.numberless(self(f"(with-output-to-string (*standard-output*) {form})")[0])

    def numberless(self, text):
        """``text`` without the numbers of tasks, which some have and some have not."""
        return re.sub(r"(?<=\])-\d+", "", str(text))


@pytest.fixture
def lisp(fresh_kernel):
    yield Lisp("greenlet" if "Greenlet" in type(fresh_kernel.backend).__name__ else "threads")
    kernel.stop()
    tasks.recorded.clear()


def test_a_branch_sees_the_whole_plan_with_what_each_task_waits_for_and_where(lisp):
    lisp("(defvar *out* (make-string-output-stream))")
    lisp(DRIVE)
    lisp("""(top-level (par
  (pursue (drive 5 'home) (sleep 3))
  (with-tags (:tag grasp (sleep 1) (values 7 "there")))
  (progn (sleep 2) (describe-task-tree :stream *out*))))""")
    assert lisp.numberless(lisp("(get-output-stream-string *out*)")[0]) == RUNNING


def test_goals_are_shown_as_they_were_called(lisp):
    lisp("(declare-goal at-place (?place ?how))")
    lisp("(def-goal (at-place (:table ?side) ?how) (sleep 1))")
    lisp("(defvar *goals* nil)")
    lisp(
        "(top-level (par (let ((side :left)) (at-place (list :table side) :fast))"
        " (progn (sleep 0.5) (setf *goals* (with-output-to-string (*standard-output*) (describe-task-tree))))))"
    )
    assert "[GOAL-AT-PLACE] (GOAL (AT-PLACE (:TABLE :LEFT) :FAST))  running for 0.5 s" in lisp("*goals*")[0]


def test_a_thread_that_a_task_spawned_stands_below_it(lisp):
    lisp("""(defvar *seen*)
(top-level
  (cut:spawn-thread "listener"
    (lambda () (sleep 9)))
  (par (sleep 3) (seq (sleep 1) (setf *seen* (with-output-to-string (*standard-output*) (describe-task-tree))))))""")
    assert (
        lisp.numberless(lisp("*seen*")[0])
        == """\
[TOP-LEVEL]  running for 1 s, waits for the branches of PAR at <repl 1>:5:3
├─ [PAR-CHILD-#1/2]  running for 1 s, waits for the time 3 s (sleep 3) at <repl 1>:5:8
├─ [PAR-CHILD-#2/2]  running for 1 s, prints this
└─ thread listener  running, waits for the time 9 s (sleep 9) at <repl 1>:4:16
"""
    )


def test_dead_tasks_are_left_out_on_demand_and_depth_says_what_it_hides():
    found = {}

    def look():
        cpl.sleep(2)
        found["living"] = cpl.task_tree_text(dead=False)
        found["flat"] = cpl.task_tree_text(depth=0)
        found["one"] = cpl.task_tree_text(depth=1)

    cpl.top_level(lambda: cpl.par(lambda: cpl.par(lambda: cpl.sleep(5)), look))
    flat = found["flat"].splitlines()
    assert len(flat) == 1 and flat[0].endswith(", 3 more below")
    assert [line[:2] for line in found["one"].splitlines()] == ["[T", "├─", "└─"]
    assert found["one"].splitlines()[1].endswith(", 1 more below")
    assert len(found["living"].splitlines()) == 4


def test_suspended_and_created_tasks_are_marked():
    def plan():
        sleeper, idle = cpl.Task(lambda: cpl.sleep(9), "SLEEPER"), cpl.Task(lambda: 1, "IDLE")
        sleeper.execute()
        cpl.sleep(1)
        cpl.suspend(sleeper)
        return cpl.task_tree_text(sleeper), cpl.task_tree_text(idle)

    sleeper, idle = cpl.top_level(plan)
    assert sleeper.startswith("SLEEPER  suspended for 1 s, stopped") and idle == "IDLE  created\n"


def test_a_task_in_its_cleanup_says_so():
    def plan():
        task = cpl.Task(stubborn, "STUBBORN")
        task.execute()
        cpl.sleep(1)
        cpl.evaporate(task, sync=None)
        cpl.sleep(1)
        return cpl.task_tree_text(task)

    def stubborn():
        try:
            cpl.sleep(9)
        finally:
            cpl.sleep(5)

    assert cpl.top_level(plan).startswith("STUBBORN  running for 2 s, is being evaporated, waits for the time 6 s (sleep 5)")


def test_a_named_plan_that_has_ended_is_described_from_its_tree(lisp):
    lisp("(def-cram-function drive (x y) (sleep x) y)")
    lisp('(def-top-level-cram-function lecture (x) (drive x 2) (par 1 (drive 3 \'(4 5))) (fail "no grasp"))')
    lisp("(handler-case (lecture 1) (plan-failure () nil))")
    assert (
        lisp.report("(describe-task-tree 'lecture)")
        == """\
[LECTURE-TOP-LEVEL]  failed after 4 s: SIMPLE-PLAN-FAILURE, no grasp at <repl 2>:1:79
└─ [REPLACEABLE-FUNCTION-LECTURE] (TOP-LEVEL LECTURE)  failed after 4 s: SIMPLE-PLAN-FAILURE, no grasp at <repl 2>:1:79
   ├─ [REPLACEABLE-FUNCTION-DRIVE] (DRIVE 1 2)  succeeded after 1 s: 2
   └─ [PAR-CHILD-#2/2]  succeeded after 3 s: (4 5)
      └─ [REPLACEABLE-FUNCTION-DRIVE] (DRIVE 3 (4 5)), call 2  succeeded after 3 s: (4 5)
"""
    )


def test_a_recorded_plan_shows_all_its_dead_branches_and_why_they_failed(lisp):
    lisp("""(let ((*record-task-tree* t))
  (handler-case (top-level (par (sleep 9) (seq (sleep 1) (fail "no grasp")) (progn)))
    (plan-failure () nil)))""")
    assert (
        lisp.report()
        == """\
No plan runs now. The last one that was recorded:
[TOP-LEVEL]  failed after 1 s: SIMPLE-PLAN-FAILURE, no grasp at <repl 1>:2:58
├─ [PAR-CHILD-#1/3]  evaporated after 1 s
├─ [PAR-CHILD-#2/3]  failed after 1 s: SIMPLE-PLAN-FAILURE, no grasp at <repl 1>:2:58
└─ [PAR-CHILD-#3/3]  succeeded after 0 s: NIL
"""
    )


def test_without_a_plan_it_says_what_would_be_kept(lisp):
    lisp("(top-level (par 1 2))")
    assert lisp.report() == "No plan runs now. Plans that begin while *record-task-tree* is true are kept for this report.\n"
    assert lisp("(describe-task-tree :stream (make-broadcast-stream))") == []


def test_after_a_deadlock_the_plan_is_shown_as_it_was(lisp):
    with pytest.raises(kernel.Deadlock):
        lisp("(top-level (par (sleep 3) (wait-for (make-fluent :name 'never))))")
    assert (
        lisp.report("(describe-task-tree :depth 1)")
        == """\
No plan runs now. The last one when nothing could happen any more, at 3 s:
[TOP-LEVEL]  running for 3 s, waits for the branches of PAR at <repl 1>:1:12
└─ [PAR-CHILD-#2/2]  running for 3 s, waits for the fluent #<FLUENT NEVER [NIL]> at <repl 1>:1:27
"""
    )


def test_after_ctrl_c_the_plan_is_shown_as_it_was(lisp):
    kernel.call_at(2.0, kernel.interrupt)
    with pytest.raises(Interruption):
        lisp("(top-level (sleep 5))")
    assert (
        lisp.report()
        == """\
No plan runs now. The last one when it was interrupted, at 2 s:
[TOP-LEVEL]  running for 2 s, waits for the time 5 s (sleep 5) at <repl 1>:1:12
"""
    )


@pytest.mark.parametrize(
    ("form", "text"),
    [
        (
            "(describe-task-tree 'nobody)",
            "There is no task tree of NOBODY. What is described is a task, a task tree, or the name of a "
            "top-level that has run; nil is for all that runs now.",
        ),
        ("(describe-task-tree :depth -1)", "The depth of a report is a number of levels, 0 or more, not -1."),
    ],
)
def test_what_cannot_be_described_is_an_error_that_says_what_can(lisp, form, text):
    assert lisp(f"(handler-case {form} (error (e) (princ-to-string e)))") == [text]


def test_it_takes_no_pulse_and_changes_no_name():
    pulsed = []

    def plan(look):
        fluent = cpl.make_fluent(name="BEAT")
        waiting = cpl.fl_pulsed(fluent)

        def beat():
            cpl.sleep(1)
            cpl.pulse(fluent)
            if look:
                cpl.task_tree_text()
            cpl.sleep(1)

        def hear():
            cpl.sleep(1.5)
            pulsed.append(cpl.wait_for(waiting, timeout=0))

        cpl.par(beat, hear)
        numbered = cpl.Task(lambda: 1, lambda: "X")
        if look:
            cpl.task_tree_text(numbered)
        return int(numbered.name.partition("-")[2])

    before, after = cpl.top_level(lambda: plan(False)), cpl.top_level(lambda: plan(True))
    assert after == before + 1 and pulsed == [True, True]


def test_a_value_that_cannot_be_printed_does_not_break_the_report(lisp):
    lisp('(defclass shy () ()) (defmethod print-object ((x shy) stream) (error "no"))')
    lisp("(let ((*record-task-tree* t)) (top-level (make-instance 'shy)))")
    assert "succeeded after 0 s: #<error printing a SHY: no (at " in lisp.report()


def test_a_file_without_box_characters_gets_ascii():
    class Old(io.StringIO):
        encoding = "ascii"

    out = Old()
    cpl.top_level(lambda: cpl.par(lambda: cpl.describe_task_tree(stream=out), lambda: cpl.sleep(1)))
    assert [line[:3] for line in out.getvalue().splitlines()] == ["[TO", "|- ", "`- "]


def test_a_terminal_gets_colours_when_rich_is_there(monkeypatch):
    pytest.importorskip("rich")

    class Terminal(io.StringIO):
        encoding = "utf-8"

        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    out = Terminal()
    cpl.top_level(lambda: cpl.describe_task_tree(stream=out))
    plain = re.sub(r"\x1b\[[0-9;]*m", "", out.getvalue())
    assert "\x1b[" in out.getvalue() and plain.endswith("running for 0 s, prints this\n")


def test_plans_are_not_kept_unless_recording_is_on():
    cpl.top_level(lambda: cpl.par(lambda: 1, lambda: 2))
    assert not tasks.recorded and tree_report.living_plans() == []
