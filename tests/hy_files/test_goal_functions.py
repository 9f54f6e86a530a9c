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


@pytest.mark.soak(all_but=1)
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


@pytest.mark.soak(all_but=1)
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


CALLABLES = {
    "a class of C without a signature": ("SimpleNamespace :part 0.5", "(. it part)", 0.5),
    "a class with parameters that are named only": ("Named :part 0.5", "it.part", 0.5),
    "a class with one before the named one": ("Both 3 :part 0.5", "[it.first it.part]", [3, 0.5]),
    "a dataclass": ("Data :part 0.5", "[it.part it.other]", [0.5, 7]),
    "a named tuple": ("Pair :other 1 :part 2", "(list it)", [2, 1]),
    "a function with a parameter that is named only": ("only :part 4", "it", 8),
    "a function whose first parameter is named, too": ("both :first 1 :part 2", "(list it)", [1, 2]),
    "a function with a rest and a named parameter": ("rest 1 2 :part 3", "(list it)", [1, 2, 3]),
    "a function that takes all names": ("all-names :part 1 :the-other 2", '[(get it 0) (get it 1)]', [1, 2]),
    "a partial": ("fixed :part 2", "(list it)", [1, 2]),
    "a partial that is given another value": ("fixed :first 9 :part 2", "(list it)", [9, 2]),
    "a bound method": ("obj.method :part 2", "(list it)", [5, 2]),
    "a bound method with one before": ("obj.beside 4 :part 2", "(list it)", [5, 4, 2]),
    "a class method": ("Named.made :part 0.5", "it.part", 0.5),
    "an object that is called": ("obj :part 2", "it", 7),
    "a function with a wrapper": ("wrapped :part 4", "it", 8),
    "a built-in function": ("bi.sum (1 2) :start 10", "it", 13),
    "a built-in function without a signature": ("bi.max (3 1) :default 4", "it", 3),
    "a class of Python's own": ("bi.int \"11\" :base 2", "it", 3),
    "a mapping of names": ("bi.dict :part 1 :other 2", '[(get it "part") (get it "other")]', [1, 2]),
    "a keyword that is data": ("first-of :left 1", "(= it (lisp :left))", True),
    "a keyword that is data of a function with a rest": ("listed :left 1", "[(= (get it 0) (lisp :left)) (get it 1)]", [True, 1]),
    "a single keyword of a class without a signature": ("bi.str :left", "it", ":LEFT"),
    "Python's own under a name of the user's": ("largest 3 9", "it", 9),
}  # fmt: skip
"""What is called with keyword arguments: the call, what is looked at of its value, and that."""
MADE = """
(import builtins :as bi types [SimpleNamespace] functools [partial wraps] collections [namedtuple] dataclasses [dataclass])
(defclass Named [] (defn __init__ [self * [part 0]] (setv self.part part)) (defn [classmethod] made [cls * part] (cls :part part)))
(defclass Both [] (defn __init__ [self first * part] (setv self.first first self.part part)))
(defclass [dataclass] Data [] (setv #^ float part 0) (setv #^ int other 7))
(setv Pair (namedtuple "Pair" ["part" "other"]))
(defn only [* [part 1]] (* 2 part))
(defn both [first * part] [first part])
(defn rest [#* those part] [#* those part])
(defn all-names [#** named] [(get named "part") (get named "the_other")])
(defn first-of [key other] key)
(defn listed [#* those] those)
(setv largest max)
(setv fixed (partial both :first 1))
(defclass Object []
  (defn method [self * part] [5 part])
  (defn beside [self first * part] [5 first part])
  (defn __call__ [self * part] (+ 5 part)))
(setv obj (Object))
(defn wrapper [function] (defn [(wraps function)] inner [#* those #** named] (function #* those #** named)) inner)
(setv wrapped (wrapper only))
"""


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("way", ["query", "rule", "inserted"])
@pytest.mark.parametrize("case", CALLABLES)
def test_keywords_in_a_goal_are_arguments_with_names_of_anything_that_is_called(load, case, way):
    """As in a call of Hy: the keyword says which argument comes next."""
    call, look, wanted = CALLABLES[case]
    ask = {
        "query": f"(prolog '(lisp-fun {call} ?r))",
        "rule": f"(do (def-fact-group g [] (<- (made ?r) (lisp-fun {call} ?r))) (prolog '(made ?r)))",
        "inserted": f"(prolog `(lisp-fun ~{call} ?r))",
    }[way]
    module = load(f"{MADE} (setv answers (lfor s {ask} (var-value '?r s)) answer (if answers (let [it (get answers 0)] {look}) None))")
    assert module.answer == wanted


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("form", ["(def-fact-group g [] (<- (at pose.x)))", "(prolog '(member ?x (pose.x)))", "(lisp pose.x)"])
def test_an_attribute_that_is_data_is_refused(load, form):
    with pytest.raises(SyntaxError) as told:
        load(form)
    assert "pose.x is no Lisp data: attributes are not evaluated in it; give the value a variable first" in str(told.value)
