"""Making, printing, reading and equating designators: designators.md section 13, invariants 1 to 12 and 36 to 45."""

import pytest

from cramhy_runtime import designators as desig
from cramhy_runtime.designators import classes, equating
from cramhy_runtime.languages.commonlisp.faces.designators import syntax
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import keyword, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string

from .support import lisp, make, python, user


def form(*pairs):
    return syntax.description_form(lisp(list(pairs)))


def test_constants_become_keywords_and_stay_otherwise():
    assert python(form(["type", "driving"], ["speed", 5], ["name", "'x"])) == ["QUOTE", [["TYPE", "DRIVING"], ["SPEED", 5], ["NAME", "x"]]]


def test_a_variable_is_evaluated_where_the_form_stands():
    assert python(form(["speed", "?speed"], ["goal", ["?x", 1, "left"]])) == [
        "LIST",
        ["LIST", "SPEED", "?SPEED"],
        ["LIST", "GOAL", ["LIST", "?X", 1, "LEFT"]],
    ]


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "text, shown",
    [
        ("(goal *ld*)", "(:GOAL 5)"),
        ("(goal +ld+)", "(:GOAL 7)"),
        ("(goal (*ld* 1 +ld+ ?x))", "(:GOAL (5 1 7 3))"),
        ("(*key* 1)", "(:COLOUR 1)"),  # keys obey the same rules
        ("(goal *symbol*)", "(:GOAL :HELLO)"),
        ("(goal *list*)", "(:GOAL (HELLO 1))"),
        ("(goal *nothing*)", "(:GOAL NIL)"),
        ("(when *ld* (on 1))", "(:ON 1)"),
        ("(when *nothing* (on 1))", None),
        ("(at (a location (x *ld*)))", "(:AT\n #<A LOCATION\n    (X 5)>)"),
        ("(sign *)", "(:SIGN :*)"),
        ("(sign (+ * ** ++ ***))", "(:SIGN (:+ :* :** :++ :***))"),
        ("(sign *half)", "(:SIGN :*HALF)"),
    ],
)
def test_a_global_variable_is_evaluated_when_the_designator_is_made(session, text, shown):
    session.evaluate_text("""(in-package :cl-user) (defvar *ld*) (defconstant +ld+ 7) (defvar *key* :colour) (defvar *symbol* 'hello)
        (defvar *list* '(hello 1)) (defvar *nothing* nil) (declaim (special *ld*))""")
    (found,) = session.evaluate_text(f"""(flet ((make (?x) (declare (ignorable ?x)) (desig:a motion (type driving) {text})))
        (let ((*ld* 5)) (prin1-to-string (second (desig:properties (make 3))))))""")
    assert str(found) == (shown or "NIL")


def test_a_nested_designator_is_a_form_whatever_package_its_operator_is_from():
    (entry,) = form(["at", ["a", "location", ["name", 1]]]).cdr
    assert entry.cdr.cdr.car.car is sym("DESIG::A")


def test_when_decides_at_run_time_and_what_is_left_out_vanishes_only_at_the_top():
    found = form(["when", "?v", ["key", "?v"]], None, ["off", None])
    assert python(found)[0] == "PRESENT"
    assert python(found)[1][1] == ["WHEN", "?V", ["LIST", "KEY", "?V"]]
    assert python(syntax.present(lisp([None, [":a", None]]))) == [["A", None]]


def test_all_takes_the_plural_and_sets_the_quantifier():
    expanded = syntax.expand(lisp(["desig::all", "objects", ["type", "cup"]]))
    assert python(expanded) == ["MAKE-ALL-DESIGNATOR", "OBJECT", ["QUOTE", [["TYPE", "CUP"]]]]
    assert classes.make_all_designator(keyword("OBJECT")).quantifier is keyword("ALL")


def test_a_dotted_list_is_an_error():
    from cramhy_runtime.lisp_core.data import Cons

    with pytest.raises(Error) as problem:
        syntax.description_form(lisp_list(Cons(user("A-KEY"), 5)))
    assert "dotted list" in problem.value.format_control


def test_an_unknown_type_is_an_error():
    with pytest.raises(Error) as problem:
        desig.make_designator(keyword("PLACE"), None)
    assert problem.value.report() == "Designator type `PLACE' undefined"


def test_a_designator_is_printed_over_several_lines():
    inner = make("location", [":name", "'x"])
    outer = desig.make_designator(keyword("OBJECT"), lisp_list(lisp([":type", ":bottle"]), lisp_list(keyword("AT"), inner)))
    assert prin1_to_string(outer) == '#<A OBJECT\n    (TYPE BOTTLE)\n    (AT #<A LOCATION\n    (NAME "x")>)>'
    assert princ_to_string(outer) == "#<A OBJECT\n    (TYPE BOTTLE)\n    (AT #<A LOCATION\n    (NAME x)>)>"
    assert prin1_to_string(make("motion")) == "#<A MOTION>"
    assert prin1_to_string(make("motion", [":l", [1, [2, ":three"]]], [":none", None])) == (
        "#<A MOTION\n    (L (1 (2 :THREE)))\n    (NONE NIL)>"
    )


def test_in_a_list_it_begins_a_line():
    assert prin1_to_string(lisp_list(1, make("motion", [":type", ":driving"]), 2)) == "(1\n #<A MOTION\n    (TYPE DRIVING)>\n 2)"


def test_printing_can_leave_the_description_out():
    with binding(sym("DESIG::*DESIGNATOR-PPRINT-DESCRIPTION*"), None):
        assert prin1_to_string(make("motion", [":type", ":driving"])) == "#<>"


def test_properties_are_found_by_key_in_order():
    motion = make("motion", [":a", 1], [":b", 2], [":a", 3])
    assert desig.desig_prop_value(motion, keyword("A")) == 1
    assert python(desig.desig_prop_values(motion, keyword("A"))) == [1, 3]
    assert desig.desig_prop_value(motion, keyword("NOPE")) is None and desig.desig_prop_value(None, keyword("A")) is None


def test_merging_puts_the_old_keys_in_front_reversed():
    old = make("motion", [":a", 1], [":b", 2], [":c", 3])
    copy = classes.copy_designator(old, new_description=lisp([[":b", 9], [":d", 4]]))
    assert python(copy.description) == [["C", 3], ["A", 1], ["B", 9], ["D", 4]]
    assert python(old.description) == [["A", 1], ["B", 2], ["C", 3]]


def test_updating_properties():
    new, old = lisp([[":a", 9], [":n", 1]]), lisp([[":b", 2], [":a", 1], [":a", 3]])
    assert python(classes.update_designator_properties(new, old)) == [["N", 1], ["A", 9], ["B", 2]]


def test_an_effective_designator_has_data_and_is_equated_to_nothing():
    made = classes.make_effective_designator(make("object", [":a", 1]), data_object="data", timestamp=7.0)
    assert (made.data, made.timestamp, made.effective, made.parent) == ("data", 7.0, True, None)
    assert python(made.description) == [["A", 1]]


def test_equating_makes_a_chain():
    first, second, third = make("object"), make("object"), make("object")
    assert desig.equate(first, second) is second
    desig.equate(first, third)
    assert desig.current_desig(first) is third and desig.first_desig(third) is first
    assert desig.desig_equal(first, third) is True and desig.desig_equal(first, 5) is None
    assert first.object_id is third.object_id
    assert desig.current_desig(None) is None
    with pytest.raises(Error) as problem:
        desig.equate(first, first)
    assert problem.value.format_control == "Cannot equate designators that are already equal."


def test_equating_two_chains_puts_the_successors_ancestors_first():
    a1, a2, b1, b2, b3 = (make("object", [":name", name]) for name in (":a1", ":a2", ":b1", ":b2", ":b3"))
    desig.equate(a1, a2)
    desig.equate(b1, b2)
    desig.equate(b2, b3)
    desig.equate(a1, b2)
    assert equating.chain(a1) == [b1, a1, a2, b2, b3]
    assert list(equating.get_equal_designators(a2)) == [b1, a1, b3, b2]


def test_callbacks_of_all_members_are_called_with_the_successor():
    told = []
    first, second, third = make("object"), make("object"), make("object")
    equating.register_equate_callback(first, lambda successor: told.append(("first", successor)))
    desig.equate(first, second)
    equating.with_equate_callback(second, lambda successor: told.append(("second", successor)), lambda: desig.equate(second, third))
    desig.equate(first, make("object"))
    assert [name for name, _ in told] == ["first", "first", "second", "first"]
    assert told[1][1] is third


def test_the_newest_effective_designator():
    first, second = make("object"), make("object")
    desig.equate(first, second)
    assert equating.newest_effective_designator(second) is None
    first.effective = True
    assert equating.newest_effective_designator(second) is first


def test_the_living_designators_are_found_in_the_order_of_their_making(lisp):
    """A run must not depend on the addresses of its objects."""
    assert (
        lisp("""(let* ((made (loop for n below 200 collect (make-designator :motion `((:ordered ,n)))))
                               (number (lambda (d) (ignore-errors (desig-prop-value d :ordered))))
                               (numbers (lambda (found) (remove nil (mapcar number found)))))
                          (setf made (remove-if (lambda (d) (evenp (desig-prop-value d :ordered))) made))
                          (let ((expected (loop for n from 1 below 200 by 2 collect n)))
                            (list (equal expected (remove-if #'evenp (funcall numbers (get-all-designators))))
                                  (equal expected (remove-if #'evenp (funcall numbers (mapcar (lambda (bdgs) (cdr (first bdgs)))
                                                                   (cut:force-ll (prolog:prolog '(designator ?d))))))))))""")
        == "(T T)"
    )
