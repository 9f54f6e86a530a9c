"""Hy goes through the answers of a query: none is an empty list. Python's collections in goals and facts are lists, or refused."""

import pytest

from cramhy_runtime.prolog.builtins import rete


@pytest.fixture(autouse=True)
def empty_memory():
    rete.clear_alpha_network()
    yield
    rete.clear_alpha_network()


NONE = "(prolog '(member 9 (1 2)))"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "call",
    [
        NONE,
        f"(force-ll {NONE})",
        "(cut:force-ll (cram-prolog:prolog '(fail)))",
        f"(lazy-mapcar (fn [b] 1) {NONE})",
        f"(lazy-mapcan (fn [b] (lisp (1))) {NONE})",
        f"(lazy-filter (fn [b] True) {NONE})",
        f"(lazy-append {NONE} {NONE})",
        f"(lazy-take 2 {NONE})",
        f"(lazy-skip 2 {NONE})",
        f"(lazy-cdr {NONE})",
        f"(lazy-flatten {NONE})",
        f"(lazy-rests {NONE})",
        "(rete-holds '(nobody ?x))",
        "(rete-prove '((nobody ?x)))",
        "(desig-prop-values (a motion (type driving)) :goal)",
    ],
)
def test_no_answers_are_an_empty_list(load, call):
    found = load(f"(setv turns 0 found {call})\n(for [each found] (+= turns 1))\n(setv n (len found) no (not found))")
    assert found.found == [] and found.n == found.turns == 0 and found.no is True


def test_functions_as_values_give_empty_lists_too(load):
    assert load("(import cramhy [prolog force-ll])\n(setv found (list (map force-ll [(prolog '(fail))])))").found == [[]]


def test_one_answer_without_variables_is_one_answer(load):
    assert len(load("(setv found (prolog '(member 1 (1 2))))").found) == 1


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("form", "value"),
    [(f"(lazy-car {NONE})", None), (f"(lazy-elt {NONE} 1)", None), (f"(lazy-list-p {NONE})", None), ("(lazy-append [] [])", [])],
)
def test_an_empty_list_is_taken_for_nil(load, form, value):
    assert load(f"(setv found {form})").found == value


def test_no_answers_are_false_to_plans_and_rules(load):
    found = load("""
(defn answers [n] (prolog `(member ~n (3 4))))
(setv f (make-fluent :name 'f :value 1) seen [])
(top-level (par (do (wait-for (fl-funcall answers f)) (.append seen f.value)) (do (sleep 1) (setv f.value 2) (sleep 1) (setv f.value 3))))
(def-fact-group lists-of-answers []
  (<- (wanted ?x) (member ?x (1 3)) (lisp-pred answers ?x))
  (<- (unwanted ?x) (member ?x (1 3)) (lisp-fun answers ?x nil)))
(setv wanted (lfor b (prolog '(wanted ?x)) (var-value '?x b)) unwanted (lfor b (prolog '(unwanted ?x)) (var-value '?x b)))
""")
    assert (found.seen, found.wanted, found.unwanted) == ([3], [3], [1])


def test_no_answers_are_nil_to_lisp(load):
    found = load("""
(lisp-package :lists-of-answers)
(def-cram-function who [n] (prolog `(member ~n (3 4))))
(setv here (top-level (who 1)))
(in-package :lists-of-answers)
(cl:defparameter *said* (cl:mapcar #'cl:null (cl:list (cpl:top-level (who 1)) (cpl:top-level (who 3)))))
(in-hy)
(setv said (list (. (lisp *said*) value)))
""")
    assert found.here == [] and found.said == [True, None]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("inserted", "answers"),
    [
        ("(range 3)", [0, 1, 2]),
        ('#{"shelf" "box"}', ["box", "shelf"]),
        ("(frozenset [2 1])", [1, 2]),
        ("(.keys {1 2 3 4})", [1, 3]),
        ("(deque [1 2])", [1, 2]),
        ("(np.array [1 2])", [1, 2]),
        ("[(range 2) 7]", [[0, 1], 7]),
        ("#(1 2)", [1, 2]),
    ],
)
def test_a_collection_in_a_goal_is_a_list(load, inserted, answers):
    found = load(f"""
(import collections [deque] numpy :as np)
(setv it {inserted} found (lfor b (prolog `(member ?x ~it)) (var-value '?x b)))
(rete-assert `(things ~it))
(setv facts (lfor b (rete-holds '(things ?it)) (var-value '?it b)) again (len (rete-holds `(things ~it))))
""")
    assert found.found == answers and found.facts == [answers] and found.again == 1


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("inserted", "text"),
    [
        ("(gfor n [1] n)", "A goal has a generator for an argument"),
        ("(map str [1])", "A goal has an iterator for an argument"),
        ("[(iter [1])]", "A goal has an iterator for an argument"),
        ('{"a" 1}', "The goal member is about lists, and a dict is none: {'a': 1}. Write list(d) for its keys"),
    ],
)
def test_an_iterator_or_a_dict_is_refused(load, inserted, text):
    with pytest.raises(TypeError, match=text.replace("(", r"\(").replace(")", r"\)")):
        load(f"(setv it {inserted})\n(prolog `(member ?x ~it))")


def test_a_collection_that_a_function_of_hy_returns_is_a_list(load):
    found = load("""
(defn sides [n] (set (range n)))
(def-fact-group results []
  (<- (side ?n ?side) (lisp-fun sides ?n ?all) (member ?side ?all)))
(setv sides-of (lfor b (prolog '(side 3 ?s)) (var-value '?s b)))
""")
    assert found.sides_of == [0, 1, 2]
