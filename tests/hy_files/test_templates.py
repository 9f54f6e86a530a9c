"""Backquotes in plain Hy: goals of Prolog with values of Hy in them."""

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

BEGINNING = """
(setv x 3 side :left name 'bottle-1 numbers [4 [5 6]])
(defn told [goal] (lfor solution (prolog goal) (var-value '?a solution)))
"""


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("goal", "answers"),
    [
        ("`(== ?a ~x)", "(3)"),
        ("`(member ?a [1 2 ~x])", "(1 2 3)"),
        ("`(member ?a ~[1 2 x])", "(1 2 3)"),
        ("`(member ?a (0 ~@(range 2) ~(* x 2) ~@None))", "(0 0 1 6)"),
        ("`(== ?a (1 . ~x))", "((1 . 3))"),
        ("`(== ?a ~numbers)", "((4 (5 6)))"),
        ('`(== ?a [~side ~name ~"text" "text" nil])', '((:LEFT BOTTLE-1 "text" "text" NIL))'),
        ("`(== ?a (member ?b :c))", "((MEMBER ?B :C))"),
        ("`(and (member ?b [1 ~x 5]) (lisp-fun max ?b 2 ?a))", "(2 3 5)"),
    ],
)
@pytest.mark.parametrize("way", ["(lfor s (prolog {}) (var-value '?a s))", "(do (setv goal {}) (told goal))"])
def test_a_goal_has_the_values_of_hy(load, goal, answers, way):
    """The goal stands in the call, or was made before."""
    module = load(f"{BEGINNING}\n(setv answer {way.format(goal)})")
    printed = "(" + " ".join(prin1_to_string(value) for value in module.answer) + ")"
    assert printed.replace(f"{module.__name__.replace('_', '-').upper()}::", "") == answers


def test_a_goal_of_lists_and_names(load):
    assert load(f"{BEGINNING}(setv answer (told ['and ['member '?a [1 2 3]] ['> '?a 1]]))").answer == [2, 3]
