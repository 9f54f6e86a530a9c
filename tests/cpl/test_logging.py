"""The event log: the line of an event, which tags there are, and what the runtime tells. Source: cpl.md section 10."""

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.cpl import logging
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream
from cramhy_runtime.repl.session import Session


@pytest.fixture
def log():
    """``log("FAIL", "PAR")`` makes these the active tags; ``log.text()`` is what was logged since."""
    stream = StringOutputStream()

    def log(*tags):
        stream.take()
        logging.log_set(list_from([keyword(tag) for tag in tags]))

    log.text = stream.take
    logging.LOG_OUTPUT.value = stream
    yield log
    logging.LOG_OUTPUT.value = None
    logging.log_set(None)


@pytest.fixture
def lisp(fresh_kernel, log):
    session = Session(time="virtual", turtlesim=False, backend=fresh_kernel.backend.name)
    session.package = "CRAM-USER"
    return session.evaluate_text


def events(text):
    """The kinds of the events and what they say, without times and tasks."""
    return [tuple(part.strip() for part in line.split(" > ", 1)[1].split(" ; ", 1)) for line in text.splitlines()]


def test_a_line_says_when_who_what_kind_and_what(lisp, log):
    lisp("(cpl-impl:log-set '(:change-status))")
    lisp("(top-level (par (sleep 1.5) (sleep 1)))")
    first, *_, last = log.text().splitlines()
    assert first.startswith("   0.000 , 0.000    - [TOP-LEVEL]-")
    assert last.startswith("   1.500 , 1.500    - [TOP-LEVEL]-")
    assert last[23:].partition(" > ")[2] == "CHANGE-STATUS                  ; :RUNNING -> :SUCCEEDED"


def test_outside_of_plans_there_are_no_times_and_the_kinds_arguments_are_formatted(lisp, log):
    lisp("(cpl-impl:log-enable cpl-impl:+log-default+)")
    assert lisp('(cpl-impl:log-event (:context "KIND ~a" 1) (:display "~s and ~a" "two" "three") (:tags :debug :gc))') == []
    assert log.text() == f'     n/a , n/a      - {"main":<20} > {"KIND 1":<30} ; "two" and three\n'


def test_long_names_lose_their_middle():
    assert logging.shortened("abcdefghijklmnopqrstuvwxyz") == "abcdefghi..rstuvwxyz"
    assert logging.shortened("a name of 20 letters") == "a name of 20 letters"


def test_the_right_margin_breaks_what_happened_below_itself(lisp, log):
    lisp("(cpl-impl:log-set '(:debug))")
    event = """(cpl-impl:log-event (:display "~{~a~^ ~_~}" '("aaaaaaaaaaaaaaaaaaaa" "bbbbbbbbbbbbbbbbbbbb" "cccccccccccccccccccc"))
                                   (:tags :debug))"""
    lisp(event)
    first, second, third = log.text().splitlines()
    assert second == " " * first.index("aaaa") + "bbbbbbbbbbbbbbbbbbbb"
    lisp(f"(let ((cpl-impl:*log-right-margin* 200)) {event})")
    assert len(log.text().splitlines()) == 1


def test_the_predefined_lists_are_the_originals(lisp):
    shown = {name: [tag.name for tag in lisp(f"cpl-impl:+log-{name}+")[0]] for name in ("default", "verbose", "very-verbose", "language")}
    assert shown["default"] == ["DEBUG", "FINISH", "SEND-EVENT", "RECEIVE-EVENT", "DEBUGGER"]
    assert shown["verbose"] == ["PROPAGATE-EVENT", "JOIN-TASK", "WAIT-FOR", "REGISTER-CHILD", "TEARDOWN", *shown["default"]]
    assert shown["very-verbose"] == ["EVENT-LOOP", "CHANGE-STATUS", "GC", *shown["verbose"]]
    assert shown["language"] == ["FAIL", "PAR", "PURSUE", "TRY-ALL", "TRY-IN-ORDER", "WITH-PARALLEL-CHILDS", "WITH-TAGS"]
    assert len(lisp("cpl-impl:+log-all+")[0]) == 21


PLANS = {
    "CHANGE-STATUS": ("(sleep 1)", ":CREATED -> :RUNNING"),
    "FINISH": ("(sleep 1)", "is :SUCCEEDED."),
    "REGISTER-CHILD": ("(par (sleep 1))", '#<TASK "[PAR-CHILD-#1/1]'),
    "WAIT-FOR": ("(wait-for (make-fluent :name 'door) :timeout 1)", "#<FLUENT DOOR [NIL]>"),
    "FAIL": ('(with-failure-handling ((plan-failure (f) f (return))) (fail "no ~a" "fuel"))', "no fuel"),
    "TRY-IN-ORDER": ('(try-in-order (fail "first") 2)', "failed: first"),
    "PAR": ("(par 1 2)", "decided: 0 running, 2 done, 0 failed"),
    "PURSUE": ("(pursue 1 (sleep 9))", "decided: 1 running, 1 done, 0 failed"),
    "TRY-ALL": ('(try-all (fail "x") 2)', "branches: 2"),
    "WITH-TAGS": ("(with-tags (:tag grasp 1))", "((TAGGED GRASP))"),
    "WITH-PARALLEL-CHILDS": ('(cpl-impl::with-parallel-childs "X" (a b c) (1) (when b a c (return)))', ":SUCCEEDED"),
    "JOIN-TASK": ('(join-task (make-instance \'task :name "joined" :thread-fun (lambda () 1)))', '#<TASK "joined"'),
    "SEND-EVENT": (
        '(evaporate (make-instance \'task :name "gone" :thread-fun (lambda () (sleep 9))) :reason "late")',
        '#<EVENT :EVAPORATE "late"> to gone',
    ),
    "RECEIVE-EVENT": ("(pursue (sleep 1) (sleep 9))", "#<EVENT :EVAPORATE>"),
    "TEARDOWN": ("(pursue (sleep 1) (sleep 9))", "[PURSUE-CHILD-#2/2]"),
    "ON-SUSPENSION": ("(with-tags (par (:tag a (on-suspension 1 (sleep 5))) (progn (sleep 1) (with-task-suspended (a) 1))))", "1 handler"),
    "EVENT-LOOP": ("(with-tags (par (:tag a (sleep 5)) (progn (sleep 1) (with-task-suspended (a) 1))))", "waiting for the wake-up"),
    "PROPAGATE-EVENT": (
        "(with-tags (par (:tag a (par (sleep 5))) (progn (sleep 1) (with-task-suspended (a) (sleep 1)))))",
        "#<EVENT :SUSPEND> to [PAR-CHILD-#1/1]",
    ),
}


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("tag", PLANS)
def test_the_runtime_tells_the_events_of_each_tag_and_no_others(lisp, log, tag):
    body, said = PLANS[tag]
    lisp(f"(cpl-impl:log-set '(:{tag}))")
    lisp(f"(top-level {body})")
    told = events(log.text())
    assert told and {kind for kind, _ in told} == {tag}
    assert any(said in what for _, what in told), told


def test_nothing_is_told_when_no_tag_is_active(lisp, log):
    for body, _ in PLANS.values():
        lisp(f"(top-level {body})")
    assert log.text() == ""


def test_equal_runs_log_equal_lines_in_virtual_time(lisp, log):
    logging.log_set(logging.tag_list(name for name in logging.TAGS if name not in ("REGISTER-CHILD", "CHANGE-STATUS", "FINISH")))

    def run():
        lisp('(top-level (par (sleep 1) (pursue (sleep 2) (sleep 3)) (try-in-order (fail "x") 1)))')
        return events(log.text())

    assert run()[0] == run()[0] and len(run()) > 5


def test_new_tags_come_after_those_there_are(lisp, log):
    lisp("(cpl-impl::define-log-tags :my-robot)")
    try:
        lisp("(cpl-impl:log-set '(:my-robot :debug))")
        assert lisp("(cpl-impl:list-active-log-tags)")[0].cdr.car.name == "MY-ROBOT"
        lisp('(cpl-impl:log-event (:context "ROBOT") (:display "moves") (:tags :my-robot))')
        assert events(log.text()) == [("ROBOT", "moves")]
    finally:
        logging.log_set(None)
        logging.known_tags.remove("MY-ROBOT")


def test_without_a_stream_of_its_own_the_log_goes_to_the_trace_output(lisp, log):
    logging.LOG_OUTPUT.value = None
    (text,) = lisp("""(with-output-to-string (*trace-output*)
                      (cpl-impl:log-set '(:debug)) (cpl-impl:log-event (:display "here") (:tags :debug)))""")
    assert str(text).endswith("; here\n")


def test_the_end_hook_of_log_block_gets_the_id_and_what_the_body_said(lisp):
    text = """
    (let ((calls nil))
      (flet ((begin (x) (push (list :begin x) calls) '(17 18)) (end (id ok) (push (list :end id ok) calls)))
        (cpl-impl::log-block begin (5) end (cpl-impl::log-succeed))
        (cpl-impl::log-block begin (6) end (cpl-impl::log-succeed) (cpl-impl::log-fail))
        (ignore-errors (cpl-impl::log-block begin (7) end (error "x")))
        (assert (= 9 (cpl-impl::log-block begin (8) end 9))))
      (mapcar #'third (remove :begin (reverse calls) :key #'first)))"""
    assert list(lisp(text)[0]) == [True, None, None, None]


def test_python_code_is_logged_as_lisp_code_is(log):
    log("FAIL")
    with pytest.raises(cpl.PlanFailure):
        cpl.top_level(lambda: cpl.fail("no fuel"))
    text = log.text()
    assert " > FAIL " in text and text.endswith(" no fuel\n")
