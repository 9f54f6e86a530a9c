"""Plans as a Hy programmer writes them: Python's lists and exceptions, comprehensions, `match`, hyrule's macros, Lisp's plans beside them."""

import pytest
from harness import new_session, surroundings
from plain_hy import hy_module, hy_value

BEGINNING = """
(require hyrule [-> case ncut defmacro! loop])
(import hyrule [inc recur] cramhy_runtime [cpl])
(defclass DoorStuck [cpl.PlanFailure])
(setv notes [])
(defn note [x] (.append notes x) x)
"""


@pytest.fixture
def run(backend):
    with surroundings():
        module = hy_module(new_session(backend), BEGINNING)
        yield lambda text: hy_value(module, text)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("(top-level (par-loop [x (lfor i (range 1 3) (* i 10))] (sleep x) (note x)))", 10),
        ("(top-level (-> 5 (inc) (par 2)))", 6),
        ('(top-level (case 2 1 "one" 2 (par "two" "x")))', "two"),
        ("(top-level (par (ncut [1 2 3 4] 1:3) 1))", [2, 3]),
        ("(defmacro! twice [form] `(do (setv ~g!x ~form) (par ~g!x ~form))) (top-level (twice (+ 1 2)))", 3),
        ("(defmacro both [#* forms] `(top-level (par ~@forms))) (both (do (sleep 1) 7) 8)", 7),
        ("(top-level (loop [[i 5] [acc 1]] (if (= i 0) acc (recur (- i 1) (* acc i)))))", 120),
        ('(top-level (with-failure-handling [[ValueError [e] (leave (str e))]] (raise (ValueError "x"))))', "x"),
        ('(top-level (with-failure-handling [[#(KeyError ValueError) [e] (leave 1)]] (raise (ValueError "x"))))', 1),
        ('(try (top-level (par (raise (KeyError "k")) (sleep 9))) (except [e KeyError] (get e.args 0)))', "k"),
        (
            "(top-level (with-failure-handling [[DoorStuck [e] (when True (for [x [1 2]] (leave x)))]] (par (fail (DoorStuck)) (sleep 3))))",
            1,
        ),
        ("(top-level (par #(1 2) 3))", (1, 2)),
        ("(top-level (match (par [1 2] 0) [a b] (+ a b)))", 3),
        ("(defn go [n] (top-level (defn inner [k] (* k n)) (par (inner 2) 1))) (go 21)", 42),
        ("(top-level (par None False))", None),
        ('(top-level (par f"{(+ 1 2)} x" 1))', "3 x"),
        (
            '(def-cram-function go [place [speed 1] #** more] "Goes." [place speed more]) (top-level (go "a" :speed 3 :extra 4))',
            ["a", 3, {"extra": 4}],
        ),
        ("(top-level (setv f (make-fluent :value 1)) (par (do (wait-for (> f 2)) f.value) (do (sleep 1) (setv f.value 3))))", 3),
        ("(setv f (make-fluent :value 1)) (top-level (value (pulsed f :handle-missed-pulses :always)))", None),
        ("(top-level (wait-for (make-fluent :value None) :timeout 2))", None),
        ("(cpl:top-level (cpl-impl::with-task [] (cpl:par 1 2)))", 1),
        ("(list (cut:force-ll (cut:lazy-list [[i 1]] (when (< i 3) (cut:cont i (+ i 1))))))", [1, 2]),
        ('(defn value [] "mine") (value)', "mine"),
        ("(let [x 5] (top-level (par (+ x 1) 2)))", 6),
        ("(lfor s [1 2] (do (setv ?s s) (desig-prop-value (desig:a motion (speed ?s)) :speed)))", [1, 2]),
    ],
)
def test_a_plan(run, text, value):
    assert run(text) == value


def test_a_plan_in_hy_and_one_in_lisp_use_each_others_modules_facts_and_functions(backend):
    with surroundings():
        session = new_session(backend)
        module = hy_module(session, BEGINNING)
        session.evaluate_text("""
            (def-process-module arm (d) (list :arm (second (reference d))))
            (def-cram-function lift (what) (pm-execute 'arm (a motion (type lifting) (thing ?what))))
            (defvar ?what "cup")""")
        hy_value(
            module,
            """
            (def-fact-group lifting [motion-grounding]
              (<- (motion-grounding ?d [lift ?thing]) (desig-prop ?d (type lifting)) (desig-prop ?d (thing ?thing))))
            (def-process-module base [d] (desig-prop-value d :speed))
            (defn use [] (setv ?thing "plate") (pm-execute 'arm (a motion (type lifting) (thing ?thing))))
            (def-cram-function drive [speed] (setv ?speed speed) (pm-execute 'base (a motion (type driving) (speed ?speed))))""",
        )
        assert list(hy_value(module, "(top-level (with-process-modules-running [arm] (use)))"))[1] == "plate"
        assert session.evaluate_text("(top-level (with-process-modules-running (arm base) (drive 4)))") == [4]


def test_a_package_of_messages_adds_the_names_that_mean_nothing_else(run):
    """In Lisp the names of TURTLESIM-MSG are in conflict with those of CL-TRANSFORMS; in Hy the first package counts."""
    assert run('(load-msg "turtlesim/Pose") [(. (lisp pose) package name) (. (lisp linear_velocity) package name)]') == [
        "CL-TRANSFORMS",
        "TURTLESIM-MSG",
    ]
