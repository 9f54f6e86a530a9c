"""``lisp-fun`` and ``lisp-pred`` find functions of Hy wherever a goal is written."""

from __future__ import annotations

import pytest

ANSWERS = "(defn told [goal] (lfor s (prolog goal) (var-value '?r s)))"
QUERIES = {
    "a local function": ("(defn ask [k] (defn scaled [n] (* k n)) (lfor s (prolog '(lisp-fun scaled 4 ?r)) (var-value '?r s)))"
                         "(setv answer (+ (ask 3) (ask 5)))", [12, 20]),
    "a local function that is inserted": ("(defn ask [f] (lfor s (prolog `(lisp-fun ~f 4 ?r)) (var-value '?r s)))"
                                          "(setv answer (+ (ask (fn [n] (* 2 n))) (ask float)))", [8, 4.0]),
    "a solution that is asked for later": ("(defn ask [k] (defn up [n] (+ k n)) (prolog '(and (member ?n (1 2)) (lisp-fun up ?n ?r))))"
                                           "(setv ten (ask 10) twenty (ask 20))"
                                           "(setv answer (lfor ss [ten twenty] s ss (var-value '?r s)))", [11, 12, 21, 22]),
    "an attribute of a module": ("(import math) (setv answer (lfor s (prolog '(lisp-fun math.sqrt 16 ?r)) (var-value '?r s)))", [4.0]),
    "an import and a name with a mark": ("(import math [hypot]) (defn far? [n] (> n 3)) (setv answer (lfor s"
                                         " (prolog '(and (lisp-fun hypot 3 4 ?r) (lisp-pred far? ?r))) (var-value '?r s)))", [5.0]),
    "a class": ("(defclass Point [] (defn __init__ [self x] (setv self.x x)))"
                "(setv answer (lfor s (prolog '(lisp-fun Point 4 ?r)) (. (var-value '?r s) x)))", [4]),
    "keywords": ("(defn way [speed [angle 1]] [speed angle])"
                 "(setv answer (lfor s (prolog '(lisp-fun way :angle 2 :speed 3 ?r)) (list (var-value '?r s))))", [[3, 2]]),
    "a function of Lisp": ("(setv answer (lfor s (prolog '(lisp-fun length (1 2) ?r)) (var-value '?r s)))", [2]),
    "a goal that was made before": ("(defn twice [n] (* 2 n)) (setv goal '(lisp-fun twice 4 ?r))"
                                    "(setv answer (lfor s (prolog goal) (var-value '?r s)))", [8]),
}  # fmt: skip


@pytest.mark.parametrize("case", QUERIES)
def test_a_query_calls_what_a_name_means_there(load, case):
    text, answer = QUERIES[case]
    assert load(text).answer == answer


GROUPS = {
    "defined after the rule, and again": ("(<- (p ?x ?r) (lisp-fun twice ?x ?r))",
                                          "(defn twice [n] (* 2 n)) (setv one (ask)) (defn twice [n] (* 3 n)) (setv answer [one (ask)])",
                                          [[8], [12]]),
    "defined again": ("(<- (p ?x ?r) (lisp-fun known ?x ?r))",
                      "(setv one (ask)) (defn known [n] (* 7 n)) (setv answer [one (ask)])", [[5], [28]]),
    "an attribute": ("(<- (p ?x ?r) (lisp-fun math.sqrt ?x ?r))", "(setv answer (ask))", [2.0]),
    "in a condition": ("(<- (p ?x ?r) (or (lisp-pred isinstance ?x ?x) (and (== ?x ?y) (lisp-fun known ?y ?r))))", "(setv answer (ask))", [5]),
}  # fmt: skip


@pytest.mark.parametrize("case", GROUPS)
def test_a_rule_calls_what_a_name_means(load, case):
    rule, then, answer = GROUPS[case]
    module = load(f"""(import math) (defn known [n] (+ n 1)) (def-fact-group g [] {rule})
        (defn ask [] (lfor s (prolog '(p 4 ?r)) (var-value '?r s))) {then}""")
    assert module.answer == answer


def test_a_group_in_a_function_calls_the_functions_of_that_function(load):
    module = load("""(defn facts [k] (defn scaled [n] (* k n)) (def-fact-group g [] (<- (p ?x ?r) (lisp-fun scaled ?x ?r))))
        (facts 3)
        (setv answer (lfor s (prolog '(p 2 ?r)) (var-value '?r s)))""")
    assert module.answer == [6]


@pytest.mark.parametrize("form", ["(def-fact-group g [] (<- (at pose.x)))", "(prolog '(member ?x (pose.x)))", "(lisp pose.x)"])
def test_an_attribute_that_is_data_is_refused(load, form):
    with pytest.raises(SyntaxError) as told:
        load(form)
    assert "pose.x is no Lisp data: attributes are not evaluated in it; give the value a variable first" in str(told.value)
