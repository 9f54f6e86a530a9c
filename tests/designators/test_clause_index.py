"""Clauses that are looked up by the properties they ask for answer as if they were tried one after the other."""

from hypothesis import given, settings
from hypothesis import strategies as st
from systems import SOAK

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.designators import classes
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.packages import intern, keyword, sym
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group, remove_fact_group
from cramhy_runtime.prolog.query import ask
from cramhy_runtime.prolog.terms.terms import Var

from .support import lisp as data

boot()
GROUNDING, PROP = sym("DESIG::MOTION-GROUNDING"), sym("DESIG::DESIG-PROP")
D, V = intern("?D", "CRAM-USER"), intern("?V", "CRAM-USER")

values = st.sampled_from([":driving", ":moving", 1, "?x", "?y", "'text"])
pairs = st.tuples(st.sampled_from([":type", ":speed", ":angle"]), values)
goals = st.lists(st.one_of(pairs, st.just("cut"), st.just("true")), max_size=4)
clauses = st.lists(st.tuples(goals, st.booleans()), max_size=5)
descriptions = st.lists(
    st.tuples(st.sampled_from([":type", ":speed", ":angle", ":goal"]), st.sampled_from([":driving", ":moving", 1, 2, "'text", None])),
    max_size=4,
)


def goal(designator, item):
    if item in ("cut", "true"):
        return lisp_list(sym(f"CRAM-PROLOG::{item.upper()}"))
    return lisp_list(PROP, designator, data(list(item)))


def group_of(functor, made):
    def head(number, dotted):
        answer = lisp_list(number, data("?x"), data("?y"))
        return Cons(functor, Cons(D, V)) if dotted and number == 2 else lisp_list(functor, D, answer)

    return lisp_list(*(lisp_list(head(number, dotted), *(goal(D, item) for item in items)) for number, (items, dotted) in enumerate(made)))


def shown(value):
    """An answer; a variable that has no value is one like any other."""
    return str(
        [item if not hasattr(item, "package") or item.package is not None else "_" for item in value] if isinstance(value, Cons) else "_"
    )


@pytest.mark.soak
@settings(max_examples=150 if SOAK else 50, deadline=None)
@given(clauses, descriptions)
def test_the_index_changes_no_answer(made, described):
    kernel.start(clock="virtual", backend="greenlet")
    motion = classes.make_designator(keyword("MOTION"), data([list(pair) for pair in described]))
    plain = intern("PLAIN-GROUNDING", "CRAM-USER")
    group, other = intern("INDEXED", "CRAM-USER"), intern("NOT-INDEXED", "CRAM-USER")
    try:
        define_fact_group(group, lisp_list(GROUNDING), group_of(GROUNDING, made))
        define_fact_group(other, None, group_of(plain, made))
        found = [shown(value) for (value,) in ask(GROUNDING, motion, Var())]
        expected = [shown(value) for (value,) in ask(plain, motion, Var())] if made else []
        assert found == expected
    finally:
        remove_fact_group(group)
        remove_fact_group(other)
        kernel.stop()


def test_a_clause_may_ground_another_designator_with_the_same_predicate(lisp):
    lisp("""(def-fact-group going (motion-grounding)
              (<- (motion-grounding ?d ?what) (desig-prop ?d (:type :going)) (desig-prop ?d (:by ?e)) (motion-grounding ?e ?what))
              (<- (motion-grounding ?d (drive ?s)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:speed ?s))))""")
    assert lisp("(reference (a motion (type going) (by (a motion (type going) (by (a motion (type driving) (speed 3)))))))") == "(DRIVE 3)"


def test_clauses_for_desig_prop_itself_are_heard(lisp):
    lisp("""(def-fact-group driving (motion-grounding)
              (<- (motion-grounding ?d (drive ?s)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:speed ?s))))
            (defun drive () (handler-case (reference (a motion (type driving))) (designator-error () :none)))""")
    assert lisp("(drive)") == ":NONE"
    lisp("(def-fact-group habits (desig-prop) (<- (desig-prop ?d (:speed 7)) (not (equal ?d nil))))")
    assert lisp("(list (drive) (answers `(desig-prop ,(a motion (speed 1)) (:speed ?v))))") == "((DRIVE 7) (((?V . 1)) ((?V . 7))))"


def test_two_properties_of_one_key_give_all_answers(lisp):
    lisp("""(def-fact-group driving (motion-grounding)
              (<- (motion-grounding ?d (drive ?s)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:speed ?s)))
              (<- (motion-grounding ?d (fly ?s)) (desig-prop ?d (:type :flying)) (desig-prop ?d (:speed ?s))))""")
    assert lisp("(solutions (a motion (type driving) (speed 1) (speed 2)))") == "((DRIVE 1) (DRIVE 2))"
    assert lisp("(solutions (a motion (type flying) (type driving) (speed 1)))") == "((DRIVE 1) (FLY 1))"


def test_a_redefined_group_is_used_at_once(lisp):
    lisp("(def-fact-group d (motion-grounding) (<- (motion-grounding ?d (one)) (desig-prop ?d (:type :driving))))")
    assert lisp("(reference (a motion (type driving)))") == "(ONE)"
    lisp("(def-fact-group d (motion-grounding) (<- (motion-grounding ?d (two)) (desig-prop ?d (:type :driving))))")
    assert lisp("(reference (a motion (type driving)))") == "(TWO)"


@pytest.mark.parametrize("description", ["5", "'(:type :driving)", "'((:type) (:speed 1 2))", '\'(("type" :driving) (5 5))', "#'car"])
def test_a_description_may_be_anything(lisp, description):
    lisp(
        "(def-fact-group d (motion-grounding) (<- (motion-grounding ?d (one)) (desig-prop ?d (:type :driving))) "
        "(<- (motion-grounding ?d (two))))"
    )
    assert lisp(f"(reference (make-designator :motion {description}))") == "(TWO)"
