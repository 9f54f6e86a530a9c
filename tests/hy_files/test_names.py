"""The compiled code of a Hy file has what is ours in global variables, and knows which names are the user's all the same."""

from __future__ import annotations

import ast

import hy
import pytest

from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.session import Image


@pytest.mark.soak
def test_a_file_asks_for_the_package_once(load, tmp_path):
    load("""
    (defn read-twice [fluent] [(value fluent) (value fluent)])
    (defn describe [?speed] (a motion (type driving) (speed ?speed)))
    (defn plan [] (top-level (with-failure-handling [[simple-plan-failure [e] (leave 1)]] (par 1 (fail "no")))))
    (defn tags [] (top-level (with-tags (:tag here 1))))
    (whenever [(make-fluent :value 1)] (break))""")
    (path,) = tmp_path.glob("*.hy")
    tree = hy.compiler.hy_compile(hy.read_many(path.read_text(), filename=str(path)), "__main__", filename=str(path))
    text = ast.unparse(tree)
    assert text.count("__import__") == 1
    assert text.count("_cramhy = __import__('cramhy')") == 1
    for part in ("branching.par", "symbols.cram_language_implementation.value", "calls.block", "calls.wait_for", "calls.execute_tag"):
        assert text.count(f"_cramhy.{part}") == 1, part


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("(defn run [] (value (make-fluent :value 1)))", 1),
        ('(defn value [x] "mine") (defn run [] (value 1))', "mine"),
        ('(defn run [] (value 1)) (defn value [x] "mine")', "mine"),
        ("(import operator [neg :as value]) (defn run [] (value 1))", -1),
        ("(setv value 5) (defn run [] (value (make-fluent :value value)))", 5),
        ("(defn other [value] value) (defn run [] (value (make-fluent :value 2)))", 2),
        ('(defn call [value] (value 1)) (defn run [] (call (fn [x] "passed")))', "passed"),
        ('(defn run [] (defn inner [] (value 1)) (setv value (fn [x] "later")) (inner))', "later"),
        ('(defn run [] (let [value (fn [x] "let")] (value 1)))', "let"),
        ("(defn run [] (setv value (value (make-fluent :value 3))) value)", 3),
        ("(defn run [] (lfor value [abs] (value -2)))", [2]),
        ('(defn run [] "its value" (value (make-fluent :value 4))) ; value', 4),
        ('(setv value 6) (defn run [] f"{value} {(value (make-fluent :value value))}")', "6 6"),
        ("(defclass Box [] (setv value 1) (defn get [self] (value (make-fluent :value self.value)))) (defn run [] (.get (Box)))", 1),
        ('(setv (get (globals) "value") (fn [x] "hidden")) (defn run [] (value 1) ) (setv other value)', "hidden"),
        ("(defn run [] (value (make-fluent :value 7 #** {})))", 7),
        ("(defn make-fluent [#** given] (dict given)) (defn run [] (make-fluent :value 8))", {"value": 8}),
        ("(defn run [] (desig-prop-value (make-designator :motion '((:speed 9))) :speed))", 9),
        ("(defn make-designator [#* given] (list given)) (defn run [] (len (make-designator :motion 1)))", 2),
    ],
)
def test_a_function_of_the_users_is_called_wherever_it_was_defined(load, text, value):
    assert load(text).run() == value


def test_a_function_that_is_defined_after_the_first_call_is_called_from_then_on(load):
    module = load('(defn run [] (value (make-fluent :value 1))) (defn define [] (global value) (setv value (fn [x] "mine")))')
    assert module.run() == 1
    module.define()
    assert module.run() == "mine"


HANDLER = "(top-level (with-failure-handling [[simple-plan-failure [e] (leave (type e))]] (fail {})))"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "text",
    [
        f"(defn run [] {HANDLER.format('(simple-plan-failure)')}) (defclass simple-plan-failure [PlanFailure])",
        f"(defn run [] (defclass simple-plan-failure [PlanFailure]) {HANDLER.format('(simple-plan-failure)')})",
        f"(defclass Mine [PlanFailure]) (defn with-type [simple-plan-failure] {HANDLER.format('(Mine)')}) (defn run [] (with-type Mine))",
    ],
)
def test_a_class_of_the_users_is_handled_wherever_it_was_defined(load, text):
    found = load(f"(import cramhy_runtime.cpl [PlanFailure]) {text}").run()
    assert found.__name__ in ("simple_plan_failure", "Mine")


def test_the_type_of_lisp_is_handled_where_there_is_no_such_class(load):
    found = load(f"(setv named 'simple-plan-failure) (defn run [] {HANDLER.format(chr(34) + 'no' + chr(34))})").run()
    assert found.__name__ == "SimplePlanFailure"


def test_a_block_is_left_from_a_function_and_what_comes_behind_it_is_not_run(load):
    module = load("""
    (setv notes [])
    (defn run [n]
      (top-level
        (.append notes "before")
        (with-failure-handling [[simple-plan-failure [e] (for [x [1 2]] (when (= x n) (leave "left" n))) (leave)]]
          (fail "no"))))""")
    assert list(map(module.run, [1, 2, 3])) == [("left", 1), ("left", 2), None] and len(module.notes) == 3


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "form",
    [
        '(with-failure-handling [[simple-plan-failure [e] (leave (note 2))]] (fail "no"))',
        "(try-in-order (fail) (leave (note 2)))",
        "(par (note 2) 1)",
        "(with-process-modules-running [] (note 2))",
        "(lazy-dolist [x (lazy-list [] (cont (note 2)))] (leave x))",
        "(value (make-fluent :value (note 2)))",
        "(plan)",
    ],
)
def test_an_operator_among_the_arguments_of_a_call_runs_when_its_turn_comes(load, form):
    module = load(f"""
    (setv notes [])
    (defn note [n] (.append notes n) n)
    (def-cram-function plan [] (note 2))
    (defn run [] (top-level [(note 1) {form} (note 3)]))""")
    assert (module.run(), module.notes) == ([1, 2, 3], [1, 2, 3])


def test_the_variables_of_a_block_stay_its_own(load):
    module = load("""
    (defn run [n]
      (setv found 0)
      (lazy-dolist [x (lazy-list [[i 0]] (cont i (+ i 1)))]
        (nonlocal found)
        (setv found x)
        (when (= x n) (leave found))))""")
    assert module.run(3) == 3


@pytest.mark.soak
def test_macros_of_another_file_use_plans_where_they_are_expanded(load):
    plans = load("(defmacro both [#* forms] `(hy.R.cramhy.top-level (hy.R.cramhy.par ~@forms)))  (defn helper [] (top-level (par 3 4)))")
    text = f"(require {plans.__name__} [both]) (import {plans.__name__} [helper]) (defn run [] [(both 1 2) (helper)])"
    assert load(text).run() == [1, 3]


@pytest.mark.soak
def test_a_macro_may_run_a_plan_while_the_file_is_compiled(load):
    text = "(eval-and-compile (defn planned [] (top-level (par 1 (value (make-fluent :value 2))))))"
    assert load(f"{text} (defmacro at-compile-time [] (planned)) (defn run [] [(planned) (at-compile-time)])").run() == [1, 1]


def test_each_image_has_its_own_symbols_and_all_have_ours(load):
    module = load("(lisp-package :names-in-images) (defn own [] (lisp (cup :cup))) (defn ours [] (lisp (:cup wait-for)))")
    own, ours = module.own(), module.ours()
    assert own is module.own() and ours is module.ours()
    with Image() as image:
        image.start(seed=1)
        other = module.own()
        assert other.car is find_package("NAMES-IN-IMAGES").intern("CUP")
        assert other.car is not own.car and other.cdr.car is own.cdr.car
        assert module.ours() is ours
    assert module.own() is own
