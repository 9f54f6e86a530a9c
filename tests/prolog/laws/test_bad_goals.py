"""Goals that cannot be proved as they stand: what is warned of or signalled, with the rule and its place, and that nothing is lost.

The texts of the conditions are those of the original. What is said beyond that is printed below them: see ``printed``.
"""

import re

import pytest

from cramhy_runtime.lisp_core.source_places import locate
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for
from cramhy_runtime.repl.session import condition_of

RULES = """(in-package {package})
(def-fact-group family ()
  (<- (parent tom bob))
  (<- (ancestor ?x ?y)
    (parent ?x ?y))
  (<- (ancestor ?x ?y)
    (parent ?x ?z)
    (or (fail)
        (ancestr ?z ?y)))
  (<- (older ?age ?sum)
    (lisp-fun + ?age 1 ?sum))
  (<- (young ?age)
    (member ?_ (1 2))
    (< ?age 18))
  (<- (twice ?x) (not (oldr ?x)) (oldr ?x))
  (<- (spelled ?x)
    (lisp-fun lenght ?x 3))
  (<- (uneven ?x) (bound ?x 3) (parent ?x ?x)))
"""


@pytest.fixture
def printed(lisp, tmp_path, monkeypatch):
    """``printed(query)``: what the proof of a query prints, with the rules above in force from a file; no line is left out."""
    package = lisp("(package-name *package*)").strip('"')
    (tmp_path / "family.lisp").write_text(RULES.format(package=f":{package.lower()}"))
    monkeypatch.chdir(tmp_path)
    lisp(f'(load "{tmp_path}/family.lisp")')
    assert lisp.warnings == []

    def show(query):
        shown = lisp.session.evaluate_text(f"(with-output-to-string (*error-output*) (all '{query}))")[0]
        return re.sub(r"`The value\s+(\S+)\s+is not of type\s+(\S+)'", r"`The value \1 is not of type \2'", str(shown))

    return show


def test_a_goal_that_nobody_defined_in_a_rule(printed):
    told = re.sub(r"\?V-\d+", "?V", printed("(ancestor ?x ann)"))  # the number counts on, and with it the width of the line
    assert (
        re.sub(r"^WARNING:\s+", "WARNING: ", told)
        == """\
WARNING: Trying to prove goal (ANCESTR ?V ANN) with undefined functor ANCESTR.
  at family.lisp:9:9
  It is a goal of clause 2 of family.
  Nobody defines ancestr; did you mean ancestor?
"""
    )


def test_a_goal_that_nobody_defined_in_a_query(printed):
    assert (
        printed("(parnt ?x ?y)")
        == """\
WARNING: Trying to prove goal (PARNT ?X ?Y) with undefined functor PARNT.
  Nobody defines parnt; did you mean parent?
"""
    )


def test_a_goal_whose_name_is_that_of_another_package(printed):
    assert (
        printed("(cpl:not (parent ?x ?y))")
        == """\
WARNING:
   Trying to prove goal (NOT
                         (PARENT ?X
                          ?Y)) with undefined functor CRAM-LANGUAGE:NOT.
  Nobody defines cram-language:not; there is cl:not, another symbol of that name: write it so, or import it.
"""
    )


@pytest.mark.parametrize(
    "query, text",
    [
        (
            "(oddp 3)",
            "Trying to prove goal (ODDP 3) with undefined functor ODDP.\n"
            "  Oddp is a Lisp function: (lisp-fun oddp ...) is a goal that calls it, (lisp-pred oddp ...) asks whether it is true.\n",
        ),
        (
            "(and (== ?f true) (?f))",
            "Trying to prove goal (?F) with undefined functor ?F.\n"
            "  ?f is not a functor; (call ?goal) proves a goal that is the value of a variable.\n",
        ),
        ("nil", "Trying to prove goal NIL with undefined functor NIL.\n  Nil is not a goal.\n"),
        ("(and nil)", "Trying to prove goal NIL with undefined functor NIL.\n  Nil is not a goal.\n"),
        (
            "(5 6)",
            "Trying to prove goal (5 6) with undefined functor 5.\n"
            "  5 is not a functor; (call ?goal) proves a goal that is the value of a variable.\n",
        ),
        (
            "((parent) tom)",
            "Trying to prove goal ((PARENT) TOM) with undefined functor (PARENT).\n"
            "  (parent) is not a functor; (call ?goal) proves a goal that is the value of a variable.\n",
        ),
        (
            '("parent" tom)',
            'Trying to prove goal (parent TOM) with undefined functor "parent".\n'
            '  "parent" is not a functor; (call ?goal) proves a goal that is the value of a variable.\n',
        ),
    ],
)
def test_what_is_no_functor(printed, query, text):
    assert printed(query).lower() == f"WARNING: {text}".lower()


def test_each_place_is_warned_of_once_in_a_proof_however_often_it_comes_there(printed, lisp):
    assert printed("(and (member ?x (1 2 3)) (or (oldr ?x) (twice ?x)))").count("WARNING") == 2  # the query's and the rule's
    assert printed("(findall ?x (and (member ?x (1 2 3)) (findall ?y (oldr ?y) ?_)) ?_)").count("WARNING") == 1
    assert lisp("(all '(oldr 1)) (all '(oldr 1))") == "NIL" and len(lisp.warnings) == 2


def test_arithmetic_with_a_variable_that_has_no_value(printed):
    assert (
        printed("(older ?a ?b)")
        == """\
WARNING:
   An error occurred while executing the lisp function `+': `The value ?A is not of type NUMBER'
  at family.lisp:11:5
  It is called by clause 1 of family.
  ?age has no value.
"""
    )
    assert (
        printed("(and (parent tom ?x) (lisp-fun + ?n 1 ?m))")
        == """\
WARNING:
   An error occurred while executing the lisp function `+': `The value ?N is not of type NUMBER'
  ?n has no value.
"""
    )


def test_a_comparison_with_a_variable_that_has_no_value(printed):
    assert (
        printed("(once (young ?a))")
        == 2
        * """\
WARNING:
   An error occurred while executing the lisp predicate `<': `The value ?A is not of type REAL'
  at family.lisp:14:5
  It is called by clause 1 of family.
  ?age has no value.
"""
    )
    assert (
        printed("(< ?x 3)")
        == """\
WARNING:
   An error occurred while executing the lisp predicate `<': `The value ?X is not of type REAL'
  ?x has no value.
"""
    )


def test_a_lisp_function_that_is_not_there(printed):
    text = re.sub(r"PROLOG-LAW-\d+", "LAW", printed("(spelled (1 2 3))"))
    assert " ".join(text.split()) == " ".join(
        """\
WARNING: An error occurred while executing the lisp function `LENGHT': `The function LAW::LENGHT is undefined.'
  at family.lisp:17:5
  It is called by clause 1 of family.
  Did you mean LENGTH?""".split()
    )


@pytest.mark.parametrize(
    "query, text, hint",
    [
        ("(call 5)", "The value\n  5\nis not of type\n  LIST", None),
        ('(and "string")', 'The value\n  "string"\nis not of type\n  LIST', None),
        ("(and (== ?g a) (call ?g))", "The value\n  A\nis not of type\n  LIST", None),
        ("(call ?g)", "The value\n  ?G\nis not of type\n  LIST", None),
        ("(bound)", "invalid number of arguments: 0", "A goal with the functor bound has 1 argument."),
        ("(not (fail) (fail))", "invalid number of arguments: 2", "A goal with the functor not has 1 argument."),
        ("(-> (true))", "invalid number of arguments: 1", "A goal with the functor -> has 2 to 3 arguments."),
        ("(take 1)", "invalid number of arguments: 1", "A goal with the functor take has 3 arguments."),
        ("(cut 1)", "invalid number of arguments: 1", "A goal with the functor cut has no arguments."),
        (
            "(uneven 1)",
            "invalid number of arguments: 2",
            "in clause 1 of family at family.lisp:18:3\nA goal with the functor bound has 1 argument.",
        ),
    ],
)
def test_what_is_an_error(printed, lisp, query, text, hint):
    with pytest.raises(BaseException) as problem:
        lisp.session.evaluate_text(f"(all '{query})")
    condition = condition_of(problem.value)
    locate(condition, problem.value)
    assert str(condition) == text
    assert hint_for(condition) == hint
    assert printed("(parent tom ?x)") == ""


def test_the_rules_stay_as_they_were(printed, lisp):
    for query in ("(ancestor ?x ann)", "(older ?a ?b)", "(parnt ?x ?y)"):
        printed(query)
    assert lisp("(all '(ancestor tom ?x))") == "(((?X . BOB)))"


def defining(lisp, form):
    """What evaluating ``form`` prints as warnings, the place at the prompt left out."""
    shown = lisp.session.evaluate_text(f"(with-output-to-string (*error-output*) {form})")[0]
    return re.sub(r"\n  at <.*", "", str(shown)).replace("STYLE-WARNING:\n  ", "STYLE-WARNING:")


def test_a_group_that_extends_a_misspelled_predicate(lisp):
    assert (
        defining(lisp, "(def-fact-group own (matchng-process-module) (<- (matchng-process-module ?d nav)))")
        == """\
STYLE-WARNING: Fact group OWN extends MATCHNG-PROCESS-MODULE, which no other group defines.
  Did you mean cpm:matching-process-module?
"""
    )


def test_a_group_with_clauses_of_a_symbol_of_the_wrong_package(lisp):
    assert (
        defining(lisp, "(def-fact-group own () (<- (motion-grounding ?d (drive 1))))")
        == """\
STYLE-WARNING: Fact group OWN has clauses of MOTION-GROUNDING, which no other group defines.
  Did you mean desig:motion-grounding?
"""
    )


def test_a_group_may_list_what_nobody_has_defined_yet(lisp):
    assert defining(lisp, "(def-fact-group own (reachable) (<- (reachable kitchen)) (<- (near kitchen)))") == ""


ASKING = """(in-package {package})
(def-fact-group places ()
  (<- (place ?x) (member ?x (1 2)) (settng ?x))
  (<- (way ?x) (member ?x (1 2)) (settng ?x) (other-settng ?x)))
(defun setting-of (x) (prolog `(settng ,x)))
(defun plan () (dotimes (i 20) (prolog '(place ?x)) (prolog `(way ,i)) (setting-of i)))
(defun other-plan () (dotimes (i 20) (prolog '(place 1)) (prolog '(other-settng 2))))
"""


@pytest.fixture
def asking(lisp, tmp_path):
    """``asking(text)``: how often a text warns of the undefined functors that the rules and functions of a file ask for."""
    package = lisp("(package-name *package*)").strip('"')
    path = tmp_path / "asking.lisp"
    path.write_text(ASKING.format(package=f":{package.lower()}"))
    lisp(f'(load "{path}")')

    def count(text):
        lisp.warnings.clear()
        lisp(text.replace("FILE", f'"{path}"'))
        return [sum(f"functor {name}." in warning for warning in lisp.warnings) for name in ("SETTNG", "OTHER-SETTNG")]

    return count


def test_a_plan_that_asks_rules_and_functions_again_and_again_warns_once_of_each_functor(asking):
    assert asking("(plan)") == [1, 0]
    assert asking("(progn (other-plan) (other-plan))") == [1, 1]


def test_the_next_form_of_the_user_warns_again(asking):
    assert [asking("(plan)"), asking("(plan)")] == [[1, 0], [1, 0]]


def test_a_functor_that_was_defined_meanwhile_is_warned_of_again(asking):
    text = "(progn (plan) (def-fact-group later () (<- (settng 1))) (plan) (def-fact-group later ()) (plan))"
    assert asking(text) == [2, 1]
