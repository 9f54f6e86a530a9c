"""A goal that ends in a variable, ``(joints ?robot . ?names)``, is unified with facts and heads of any length, as lists are."""

import pytest
from prolog_text import ask, group


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(
    "goal, answers",
    [
        ("(joints r2 . ?n)", '(((?N "pan" "tilt")))'),
        ("(joints r3 ?a . ?n)", '(((?A . "a") (?N "b" "c")))'),
        ("(joints r1 . ?n)", "(((?N)))"),
        ("(and (joints ?r . ?_))", "(((?R . R2)) ((?R . R1)) ((?R . R3)))"),
        ("(joints . ?all)", '(((?ALL R2 "pan" "tilt")) ((?ALL R1)) ((?ALL R3 "a" "b" "c")))'),
        ("(joints r4 . ?n)", "NIL"),
        ("(joints r2 ?a ?b ?c . ?n)", "NIL"),
        ('(and (== ?n ("pan" "tilt")) (joints ?r . ?n))', '(((?N "pan" "tilt") (?R . R2)))'),
        ('(and (== ?n (?x "tilt")) (joints r2 . ?n))', '(((?N "pan" "tilt") (?X . "pan")))'),
        ("(names-of r3 ?n)", '(((?N "a" "b" "c")))'),
        ("(sized ?r (?a ?b))", '(((?R . R2) (?A . "pan") (?B . "tilt")))'),
        ("(bulky ?r)", "(((?R . R2)) ((?R . R3)))"),
        ("(forall (joints ?r . ?n) (== ?n ?n))", "(NIL)"),
        ("(once (joints ?r . ?n))", '(((?R . R2) (?N "pan" "tilt")))'),
        ("(and (joints ?r . ?n) (cut))", '(((?R . R2) (?N "pan" "tilt")))'),
        ("(and (joints ?r . ?n) (not (joints ?r ?one . ?)))", "(((?R . R1) (?N)))"),
        ("(and (joints r2 . ?n) (joints r2 . ?n))", '(((?N "pan" "tilt")))'),
    ],
)
def test_it_is_unified_with_facts_of_any_length(goal, answers):
    group("joints", '((joints r2 "pan" "tilt"))', "((joints r1))", "((joints ?robot . ?names) (fail))", '((joints r3 "a" "b" "c"))')
    group(
        "uses",
        "((names-of ?robot ?names) (joints ?robot . ?names))",
        "((sized ?robot ?names) (joints ?robot . ?given) (== ?given ?names))",
        "((bulky ?robot) (joints ?robot ?first . ?others) (bound ?first))",
    )
    assert ask(goal) == answers
