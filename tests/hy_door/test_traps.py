"""The traps of cpl.md 17 in plain Hy, as a Hy programmer meets them. docs/explanation/traps.md says what keeps us out of them."""

import itertools
import re
from pathlib import Path

import pytest
from systems import ONE_BACKEND
from plain_hy import hy_module, hy_value

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "traps.md"

BEGINNING = """
(import cramhy_runtime [kernel] cramhy_runtime.cpl [PlanFailure SimplePlanFailure CommonLispErrorEnvelope] gc weakref)
(setv log [])
(defn note [thing] (.append log thing) thing)
(defn for-ever [] (while True))
(setv never (make-fluent :name 'never))
"""

TRAPS = {
    1: (  # handlers before unwinding
        """(top-level
             (with-failure-handling [[simple-plan-failure [e] (note "handler") (leave 1)]]
               (try (fail "x") (finally (note "cleanup")))))""",
        (1, ["handler", "cleanup"]),
    ),
    2: (  # decline and fall through
        """(top-level
             (with-failure-handling [[simple-plan-failure [e] (note "outer") (leave 2)]]
               (with-failure-handling [[simple-plan-failure [e] (note "first")] [plan-failure [e] (note "second")]]
                 (fail "x"))))""",
        (2, ["first", "second", "outer"]),
    ),
    3: (  # handlers are not active inside themselves
        """(top-level
             (with-failure-handling [[simple-plan-failure [e] (note f"outer {e}") (leave 3)]]
               (with-failure-handling [[simple-plan-failure [e] (note f"inner {e}") (fail "of the handler")]]
                 (fail "x"))))""",
        (3, ["inner x", "outer of the handler"]),
    ),
    4: (  # errors from foreign code: their frames have unwound, and all handlers hear of them
        """(top-level
             (with-failure-handling [[ZeroDivisionError [e] (note "outer") (leave 4)]]
               (with-failure-handling [[ZeroDivisionError [e] (note "inner")]]
                 (try (/ 1 0) (finally (note "cleanup"))))))""",
        (4, ["cleanup", "inner", "outer"]),
    ),
    5: ('(try (top-level (fail "x")) (except [e Exception] "an error") (except [e PlanFailure] "a failure"))', ("a failure", [])),
    6: (  # evaporation is not an exception
        """(top-level
             (par
               (pursue (while True (try (sleep 1000) (except [e Exception] (note "seen")))) (sleep 1))
               (pursue (do (try (sleep 1000) (except [] (note "eaten"))) (sleep 1000) (note "never")) (sleep 1))))""",
        (None, ["eaten"]),
    ),
    7: ('(top-level (pursue (try (for-ever) (finally (sleep 1) (note "cleaned"))) (do (sleep 1) "won")))', ("won", ["cleaned"])),
    8: (  # blocked threads must be reachable
        """(top-level
             (pursue
               (wait-for never)
               (par (wait-for never) (sleep 1000))
               (with-tags (par (:tag other (sleep 1000)) (join-task other)))
               (do (sleep 1) "won")))
           (kernel.now)""",
        (1.0, []),
    ),
    9: ('(top-level (pursue (wait-for never :timeout 1000) (do (sleep 1) "won"))) (kernel.now)', (1.0, [])),
    10: (  # cleanup is shielded: of a branch that a request to end finds in it, and of one that it led there
        """(top-level
             (with-failure-handling [[simple-plan-failure [e] (leave 10)]]
               (par (try 1 (finally (sleep 2) (note "a"))) (try (sleep 9) (finally (sleep 3) (note "b"))) (do (sleep 1) (fail "x")))))""",
        (10, ["a", "b"]),
    ),
    11: (  # order of cleanup
        """(top-level
             (pursue (try (par (try (sleep 9) (finally (sleep 1) (note "child")))) (finally (note "parent"))) (sleep 1)))""",
        (None, ["child", "parent"]),
    ),
    12: (  # success waits, failure does as well
        """(top-level
             (with-retry-counters [[attempts 1]]
               (with-failure-handling [[simple-plan-failure [e] (do-retry attempts (retry)) (leave 12)]]
                 (par (try (sleep 9) (finally (sleep 1) (note "over"))) (do (note "begins") (sleep 1) (fail "x"))))))""",
        (12, ["begins", "over", "begins", "over"]),
    ),
    13: (  # the same condition object
        """(setv thrown (SimplePlanFailure "x"))
           (try (top-level (par (par (seq (fail thrown))))) (except [e PlanFailure] (is e thrown)))""",
        (True, []),
    ),
    14: (  # envelope matching order
        """(top-level
             (with-failure-handling [[plan-failure [e] (note (type e)) (leave 14)] [ValueError [e] (note (type e))]]
               (par (raise (ValueError "x")))))
           (lfor type log type.__name__)""",
        (["ValueError", "CommonLispErrorEnvelope"], None),
    ),
    15: (  # position rules
        """(top-level
             [(par (do (sleep 2) 1) 2) (pursue (do (sleep 1) 1) (do (sleep 1) 2)) (try-all (do (sleep 1) 1) (do (sleep 1) 2))
              (try (try-all (fail "a") (fail "b")) (except [e PlanFailure] (lfor part e.failures (str part))))])""",
        ([1, 2, 1, ["b", "a"]], []),
    ),
    16: (  # dynamic variables are not inherited, task variables are copied
        """(import cramhy_runtime.lisp_core.dynamic [binding])
           (define-task-variable *place* "home")
           (with [_ (binding *place* "away")]
             (top-level (par (do (note *place*.value) (setv *place*.value "lost")) (do (sleep 1) (note *place*.value)))))
           *place*.value""",
        ("home", ["away", "away"]),
    ),
    17: (  # plan functions run in a task of their own
        """(def-cram-function own-task [] (current-task))
           (top-level (let [own (own-task)] [(is own (current-task)) (is own.parent (current-task))]))""",
        ([False, True], []),
    ),
    18: (  # several values
        """(def-cram-function several [] #(1 2))
           (top-level [(par #(1 2) 3) (pursue #(1 2) (sleep 1)) (seq 0 #(1 2)) (try-in-order (fail "x") #(1 2)) (several)])""",
        ([(1, 2)] * 5, []),
    ),
    19: (  # truthiness
        '(top-level (lfor true [0 0.0 "" []] (wait-for (make-fluent :value true))))',
        ([0, 0.0, "", []], []),
    ),
    20: (  # equality of fluents
        "(setv f (make-fluent :value 1) g (make-fluent :value 1)) [(= f g) (in f [g f]) (len #{f g f}) (get {f 1 g 2} g)]",
        ([False, True, 2, 2], []),
    ),
    21: (  # and, or, not, chained comparison
        """(setv f (make-fluent :value 2))
           (for [ask [(fn [] (and f 1)) (fn [] (not f)) (fn [] (if f 1 2)) (fn [] (< 1 f 3))]]
             (try (ask) (except [e TypeError] (note 1))))
           [(value (& f 9)) (value (| f 9)) (value (bnot f)) (value (& (> f 1) (< f 3)))]""",
        ([9, 2, None, True], [1, 1, 1, 1]),
    ),
    22: (  # missed pulses
        """(setv f (make-fluent :value 0))
           (top-level
             (pursue
               (whenever [(pulsed f :handle-missed-pulses :always)] (note f.value) (sleep 1))
               (do (sleep 0.5) (for [i [1 2 3]] (setv f.value i)) (sleep 9) "won")))""",
        ("won", [3, 3, 3]),
    ),
    23: (  # reading consumes, looking does not
        """(setv f (make-fluent :value 0) pulse (pulsed f))
           (setv f.value 1)
           (repr pulse) (str pulse)
           [(value pulse) (value pulse)]""",
        ([True, None], []),
    ),
    24: (  # notify all
        """(setv f (make-fluent))
           (top-level (par (note [1 (wait-for f)]) (note [2 (wait-for f)]) (note [3 (wait-for (pulsed f))]) (do (sleep 1) (setv f.value 7))))
           (sorted (map str log))""",
        (["[1, 7]", "[2, 7]", "[3, True]"], None),
    ),
    25: (  # lost wake-up
        """(setv a (make-fluent :value 0) b (make-fluent :value 0) both (+ a b))
           (top-level
             (par
               (wait-for (> both 199))
               (for [_ (range 100)] (setv a.value (+ a.value 1)) (sleep 0))
               (for [_ (range 100)] (setv b.value (+ b.value 1)) (sleep 0)))
             (value both))""",
        (200, []),
    ),
    26: (  # errors in net functions
        """(setv f (make-fluent :value 1) net (fl-funcall (fn [n] (/ 1 n)) f))
           [(try (setv f.value 0) (except [e ZeroDivisionError] "the one that assigns")) (do (setv f.value 2) (value net))]""",
        (["the one that assigns", 0.5], []),
    ),
    27: (  # eager first computation
        '(try (+ (make-fluent :name \'pose) 1) (except [e Exception] "at once"))',
        ("at once", []),
    ),
    28: (  # weak dependants
        """(setv f (make-fluent :value 1) net (+ f 1) held (weakref.ref net))
           (del net)
           (setv f.value 2)
           (gc.collect)
           (held)""",
        (None, []),
    ),
    29: (  # recursive locks
        """(setv f (make-fluent :value 0))
           (register-update-callback f 'count (fn [value] (note value) (when (< f.value 3) (setv f.value (+ f.value 1)))))
           (setv f.value 1)
           f.value""",
        (3, [1, 2, 3]),
    ),
    30: (  # suspend is a tree operation
        """(top-level
             (with-tags
               (par
                 (:tag patrol (par (for [i (range 9)] (sleep 1) (note i)) (sleep 9)))
                 (do (sleep 1.5) (with-task-suspended [patrol] (note "suspended") (sleep 5) (note "wakes"))))))
           (cut log 4)""",
        ([0, "suspended", "wakes", 1], None),
    ),
    31: (  # suspension inside critical regions
        """(top-level
             (with-tags
               (par
                 (:tag region (without-scheduling (note "in") (sleep 2) (note "out")) (retry-after-suspension (note "begins") (sleep 3)))
                 (do (sleep 1) (with-task-suspended [region] (note "suspended")))
                 (do (sleep 3) (with-task-suspended [region] (note "again"))))))""",
        (None, ["in", "out", "suspended", "begins", "again", "begins"]),
    ),
    32: (  # idempotence
        """(top-level
             (with-tags
               (par (:tag work (sleep 1) "done")
                    (do (suspend work) (suspend work) (wake-up work) (wake-up work) (sleep 2) (evaporate work) (evaporate work) 1))))""",
        ("done", []),
    ),
    33: (  # requests to tasks that are dead
        """(top-level
             (with-tags
               (par (:tag work 1) (do (sleep 1) (evaporate work) (suspend work) (wake-up work) (with-task-suspended [work] "goes on")))))""",
        (1, []),
    ),
    34: ("(top-level (par-loop [n (range 20)] (note n) (sleep 1))) (= log (list (range 20)))", (True, None)),  # starting order
    35: (  # showing a task
        '(top-level (let [me (current-task)] (.startswith (repr me) "<ToplevelTask [TOP-LEVEL]-")))',
        (True, []),
    ),
    36: (  # return from inside par: Hy's return belongs to a function in the branch; in the branch itself it is refused
        '(top-level ((fn [] (note (par ((fn [] (return 1))) 2)) "goes on")))',
        ("goes on", [1]),
    ),
    37: (  # blocks named nil: leave is of the innermost form that has one
        """(top-level
             (with-failure-handling [[plan-failure [e] (leave "outer")]]
               (note (try-in-order (leave "inner") 2))
               (note (try-each-in-order [n [1 2]] (leave n)))
               (fail "x")))""",
        ("outer", ["inner", 1]),
    ),
    38: (  # the end of the program, and Ctrl-C
        """(kernel.call-at 1 kernel.interrupt)
           (try (top-level (par (try (sleep 9) (finally (sleep 1) (note "cleaned")))))
             (except [KeyboardInterrupt] "interrupted"))""",
        ("interrupted", ["cleaned"]),
    ),
    39: (  # nobody polls
        """(top-level
             (pursue
               (par-loop [_ (range 100)] (wait-for never))
               (do
                 (sleep 1)
                 (setv tasks (lfor task (. (kernel.active) tasks) :if (is-not task (kernel.current)) task)
                       before (lfor task tasks task.ticket))
                 (sleep 1000)
                 [(len tasks) (= before (lfor task tasks task.ticket))])))""",
        ([103, True], []),
    ),
    40: (  # data races
        """(setv count [0])
           (defn add [] (for [_ (range 3000)] (setv (get count 0) (+ (get count 0) 1))))
           (top-level (par (add) (add) (add)))
           count""",
        ([9000], []),
    ),
    42: (  # policy conditions are no plan failures
        """(define-policy in-time [] (:check (sleep 1) True))
           (top-level
             (with-failure-handling [[plan-failure [e] (note "failure")] [policy-condition [e] (leave "policy")]]
               (par (with-policy in-time [] (sleep 9)))))""",
        ("policy", []),
    ),
    43: (  # names are not unique
        """(defn once [] (top-level (par (. (current-task) name))))
           (= (once) (once))""",
        (False, []),
    ),
}

NOT_IN_HY = {41: "a Hy program has no debugger that stops before the stack unwinds: docs/hy.md, at the prompt of hy"}

_numbers = itertools.count(1)


@pytest.fixture(params=ONE_BACKEND)
def plain_hy(request):
    """A function of a Hy text: what its last form gives, and what was noted."""
    with Image(as_now=True):
        session = Session(time="virtual", turtlesim=False, backend=request.param, time_limit=3600)
        session.evaluate_text(f"(defpackage trap-{next(_numbers)} (:use :cpl)) (in-package :trap-{next(_numbers) - 1})")
        module = hy_module(session, BEGINNING)
        try:
            yield lambda text: (hy_value(module, text), module.log)
        finally:
            kernel.stop()


def test_each_trap_is_tried_in_plain_hy_or_has_a_reason():
    numbers = [int(number) for number in re.findall(r"^(\d+)\. \*\*", PAGE.read_text(), re.M)]
    assert sorted([*TRAPS, *NOT_IN_HY]) == numbers == list(range(1, 44))
    assert len(TRAPS) == 42


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("number", TRAPS)
def test_trap(plain_hy, number):
    text, (value, noted) = TRAPS[number]
    found, log = plain_hy(text)
    assert (list(found) if isinstance(found, Cons) else found) == value
    assert noted is None or log == noted
