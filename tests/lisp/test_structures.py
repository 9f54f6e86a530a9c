"""Structures as Python sees them, and what ``defstruct`` may be told."""

import pytest

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import SimpleProgramError, TypeError_
from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction, lisp_list
from cramhy_runtime.lisp_core.equality import equalp
from cramhy_runtime.languages.commonlisp.objects import structures
from cramhy_runtime.languages.commonlisp.objects.classes import class_name, find_class
from cramhy_runtime.lisp_core.packages import find_package, keyword, make_package, sym

boot()
HOME = find_package("STRUCTURE-TESTS") or make_package("STRUCTURE-TESTS", use=("COMMON-LISP",))


@pytest.fixture(autouse=True)
def in_our_package():
    old, structures.PACKAGE.value = structures.PACKAGE.value, HOME
    yield
    structures.PACKAGE.value = old


def here(name):
    return HOME.intern(name)


@pytest.fixture
def motion():
    """(defstruct motion (speed 5) angle)"""
    structures.define_structure(
        here("MOTION"), [structures.structure_slot(here("SPEED"), initform=lambda: 5), structures.structure_slot(here("ANGLE"))]
    )
    return find_class(here("MOTION"))


def test_slots_are_attributes_and_the_class_can_be_called_with_keywords(motion):
    obj = motion(angle=2)
    assert (obj.speed, obj.angle) == (5, 2)
    with pytest.raises(AttributeError):
        obj.sped = 1


def test_constructor_accessors_setters_copier_and_predicate_are_functions_of_their_symbols(motion):
    obj = here("MAKE-MOTION").function(keyword("SPEED"), 7)
    assert here("MOTION-SPEED").function(obj) == 7
    assert here("MOTION-SPEED").setf_function(8, obj) == 8
    copy = here("COPY-MOTION").function(obj)
    assert copy is not obj and copy.speed == 8
    assert here("MOTION-P").function(obj) is True and here("MOTION-P").function(5) is None


def test_an_accessor_refuses_what_is_no_such_structure(motion):
    with pytest.raises(TypeError_) as problem:
        here("MOTION-SPEED").function(5)
    assert problem.value.datum == 5 and problem.value.expected_type is here("MOTION")


def test_an_unknown_keyword_is_an_error(motion):
    with pytest.raises(SimpleProgramError) as problem:
        here("MAKE-MOTION").function(keyword("SPED"), 1)
    assert str(problem.value) == "Unknown &KEY argument: :SPED"


def test_a_slot_with_a_type_refuses_other_values():
    structures.define_structure(here("TYPED"), [structures.structure_slot(here("COUNT"), initform=lambda: 0, type=sym("FIXNUM"))])
    with pytest.raises(TypeError_) as problem:
        here("MAKE-TYPED").function(keyword("COUNT"), "many")
    assert str(problem.value) == 'The value\n  "many"\nis not of type\n  FIXNUM\nwhen setting slot COUNT of structure TYPED'


def test_slots_of_gives_names_and_values_in_order(motion):
    assert structures.slots_of(motion(angle=1)) == [(here("SPEED"), 5), (here("ANGLE"), 1)]
    assert class_name(motion) is here("MOTION")


def test_equal_structures_are_equalp(motion):
    assert equalp(motion(angle=1), motion(angle=1)) is True
    assert equalp(motion(angle=1), motion(angle=2)) is None


def test_initforms_are_computed_for_each_object():
    counter = iter(range(10))
    structures.define_structure(here("NUMBERED"), [structures.structure_slot(here("N"), initform=lambda: next(counter))])
    make = here("MAKE-NUMBERED").function
    assert (make().n, make().n) == (0, 1)


def test_an_included_structure_gives_slots_accessors_and_type(motion):
    structures.define_structure(
        here("TURN"),
        [structures.structure_slot(here("RADIUS"))],
        include=here("MOTION"),
        include_slots=[structures.structure_slot(here("SPEED"), initform=lambda: 1)],
    )
    turn = find_class(here("TURN"))(radius=3)
    assert (turn.speed, turn.angle, turn.radius) == (1, None, 3)
    assert isinstance(turn, motion)
    assert here("MOTION-SPEED").function(turn) == here("TURN-SPEED").function(turn) == 1


def test_reloading_the_same_definition_keeps_the_class_and_another_one_replaces_it(motion):
    again = [structures.structure_slot(here("SPEED")), structures.structure_slot(here("ANGLE"))]
    structures.define_structure(here("MOTION"), again)
    assert find_class(here("MOTION")) is motion
    structures.define_structure(here("MOTION"), [structures.structure_slot(here("OTHER"))])
    assert find_class(here("MOTION")) is not motion
    structures.define_structure(here("MOTION"), again)


def test_a_read_only_slot_has_no_setter():
    structures.define_structure(here("FROZEN"), [structures.structure_slot(here("X"), read_only=True)])
    assert here("FROZEN-X").setf_function is None


def test_names_of_functions_can_be_chosen_or_left_out():
    structures.define_structure(
        here("PLAIN"),
        [structures.structure_slot(here("VALUE-OF"))],
        conc_name=None,
        constructors=[here("NEW-PLAIN")],
        copier=None,
        predicate=here("IS-PLAIN"),
    )
    assert here("VALUE-OF").function(here("NEW-PLAIN").function(keyword("VALUE-OF"), 3)) == 3
    assert isinstance(here("COPY-PLAIN").function, UndefinedFunction)
    assert here("IS-PLAIN").function(1) is None


def test_a_constructor_by_position_falls_back_to_the_initforms_of_the_slots():
    a, b, c = Symbol("A"), here("B"), Symbol("C")
    structures.define_structure(here("BASE"), [structures.structure_slot(b, initform=lambda: 9)])
    written = lisp_list(a, sym("&OPTIONAL"), b, sym("&AUX"), c)
    lambda_list, variables, empty = structures.boa_lambda_list(written, {}, here("BASE"))
    assert list(variables) == [a, b, c] and list(empty) == [c]
    name, default = list(lambda_list)[2]
    assert name is b and default.car is sym("CRAMHY::SLOT-DEFAULT") and [quoted.cdr.car for quoted in default.cdr] == [here("BASE"), b]
    assert structures.slot_default(here("BASE"), b) == 9 and structures.slot_default(here("BASE"), a) is None


def test_slots_with_names_that_are_alike_in_python_do_not_meet():
    structures.define_structure(
        here("ALIKE"),
        [structures.structure_slot(here("A-B")), structures.structure_slot(here("A_B")), structures.structure_slot(here("CLASS"))],
    )
    alike = here("MAKE-ALIKE").function(keyword("A-B"), 1, keyword("A_B"), 2, keyword("CLASS"), 3)
    assert (here("ALIKE-A-B").function(alike), here("ALIKE-A_B").function(alike), here("ALIKE-CLASS").function(alike)) == (1, 2, 3)


def test_the_type_of_a_slot_may_be_defined_later(session):
    session.package = "CL-USER"
    session.evaluate_text("(defstruct early (next nil :type (or null later-type)))")
    assert session.evaluate_text("(early-next (make-early))") == [None]
    with pytest.raises(Exception, match="unknown type specifier: LATER-TYPE"):
        session.evaluate_text("(make-early :next 3)")
    session.evaluate_text("(defstruct later-type)")
    assert session.evaluate_text("(later-type-p (early-next (make-early :next (make-later-type))))") == [True]


def test_slots_whose_names_no_python_name_could_have(session):
    session.package = "CL-USER"
    session.evaluate_text("(defstruct odd 100k-size *b %a |d e| + class ² |1|)")
    names = "(odd-100k-size odd-*b odd-%a |ODD-d e| odd-+ odd-class odd-² odd-1)"
    session.evaluate_text("(defparameter *odd* (make-odd :100k-size 1 :*b 2 :%a 3 :|d e| 4 :+ 5 :class 6 :² 7 :|1| 8))")
    assert session.evaluate_text(f"(equal (mapcar (lambda (name) (funcall name *odd*)) '{names}) '(1 2 3 4 5 6 7 8))") == [True]
