"""Classes, generic functions and conditions as Python code of the runtime uses them."""

import pytest

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.languages.commonlisp.objects import class_definition, classes, instances, slots
from cramhy_runtime.lisp_core.dispatch import generic_functions as generic
from cramhy_runtime.languages.commonlisp.objects.builtin_classes import lisp_mro
from cramhy_runtime.languages.commonlisp.objects.classes import class_name, find_class
from cramhy_runtime.languages.commonlisp.objects.instances import make_instance
from cramhy_runtime.lisp_core.dispatch.generic_errors import NoApplicableMethodError, NoPrimaryMethodError
from cramhy_runtime.lisp_core.packages import find_package, keyword, make_package, sym

boot()
HOME = find_package("CLOS-TESTS") or make_package("CLOS-TESTS", use=("COMMON-LISP",))
X, Y, NAME = keyword("X"), keyword("Y"), keyword("NAME")


def here(name):
    return HOME.intern(name)


def slot(name, *initargs, initform=None, **options):
    return class_definition.slot_spec(here(name), initargs=lisp_list(*initargs), initform=initform, **options)


def define(name, superclasses=(), slots=(), **options):
    return class_definition.define_class(here(name), list(superclasses), list(slots), **options)


# ------------------------------------------------------------------------------------------------------------------- classes


def test_a_slot_is_an_attribute():
    define("TURTLE", slots=[slot("X", X, initform=lambda: 1), slot("PEN-COLOUR")])
    turtle = make_instance(here("TURTLE"), X, 5)
    assert turtle.x == 5
    turtle.pen_colour = "red"
    assert slots.slot_value(turtle, here("PEN-COLOUR")) == "red"
    assert make_instance(here("TURTLE"), x=7).x == 7


def test_an_unbound_slot_is_an_error_with_restarts_and_no_attribute_error():
    define("EMPTY-ONE", slots=[slot("X")])
    with pytest.raises(conditions.UnboundSlot) as problem:
        make_instance(here("EMPTY-ONE")).x  # noqa: B018
    assert [restart.name.name for restart in problem.value.restarts][:2] == ["USE-VALUE", "STORE-VALUE"]


def test_an_invalid_initarg_names_the_class():
    define("STRICT", slots=[slot("X", X)])
    with pytest.raises(instances.InitargError) as problem:
        make_instance(here("STRICT"), keyword("BAD"), 1)
    assert str(problem.value) == (
        "Invalid initialization argument:\n  :BAD\nin call for class #<STANDARD-CLASS CLOS-TESTS::STRICT>.\n"
        "See also:\n  The ANSI Standard, Section 7.1.2"
    )


def test_a_class_that_does_not_exist_is_an_error_of_the_class_that_sbcl_signals():
    with pytest.raises(classes.ClassNotFoundError) as problem:
        make_instance(here("NOWHERE"))
    assert str(problem.value) == "There is no class named CLOS-TESTS::NOWHERE."
    assert find_class(here("NOWHERE"), None) is None


def test_a_class_defined_again_is_the_same_object_and_keeps_its_instances():
    first = define("GROWING", slots=[slot("X", X, initform=lambda: 1)])
    old = make_instance(first, X, 5)
    second = define("GROWING", slots=[slot("X", X), slot("Y", initform=lambda: 2)])
    assert second is first
    assert (old.x, old.y) == (5, 2)


def test_slots_of_two_packages_with_one_name_are_two_slots():
    other = find_package("CLOS-TESTS-2") or make_package("CLOS-TESTS-2")
    define("DOUBLE-NAME", slots=[slot("X", X), class_definition.slot_spec(other.intern("X"), initargs=lisp_list(Y))])
    both = make_instance(here("DOUBLE-NAME"), X, 1, Y, 2)
    assert slots.slot_value(both, here("X")) == 1
    assert slots.slot_value(both, other.intern("X")) == 2
    assert both.x == 1 and both.x_ == 2


def test_the_precedence_list_is_that_of_clos():
    # The example of ANSI 4.3.5.2, for which Python's own order is another one.
    for name, supers in (
        ("FOOD", ()),
        ("SPICE", ("FOOD",)),
        ("FRUIT", ("FOOD",)),
        ("CINNAMON", ("SPICE",)),
        ("APPLE", ("FRUIT",)),
        ("PIE", ("APPLE", "CINNAMON")),
    ):
        define(name, [here(parent) for parent in supers])
    names = [class_name(cls).name for cls in find_class(here("PIE")).__mro__[:6]]
    assert names == ["PIE", "APPLE", "FRUIT", "CINNAMON", "SPICE", "FOOD"]


def test_a_class_may_come_before_its_superclass_but_not_its_instances():
    child = define("EARLY-CHILD", [here("LATE-PARENT")])
    with pytest.raises(conditions.SimpleError, match="forward referenced class"):
        make_instance(child)
    define("LATE-PARENT", slots=[slot("X", X, initform=lambda: 3)])
    assert make_instance(child).x == 3


class Vehicle:
    """A class of the runtime: plain Python."""

    lisp_name = "CLOS-TESTS::VEHICLE"
    initargs = {"WHEELS": "wheels", "OWNER": "owner"}

    def __init__(self, wheels=4):
        self.wheels = wheels
        self.log = []

    def describe(self):
        return f"{self.wheels} wheels"


def test_users_can_inherit_from_a_class_of_the_runtime():
    define("TRUCK", [here("VEHICLE")], [slot("LOAD", keyword("LOAD"), initform=lambda: 10), slot("DESCRIBE", initform=lambda: "heavy")])
    truck = make_instance(here("TRUCK"), keyword("WHEELS"), 6, keyword("OWNER"), "Ann")
    assert isinstance(truck, Vehicle)
    assert (truck.wheels, truck.owner, truck.load, truck.log) == (6, "Ann", 10, [])
    assert truck.describe() == "6 wheels", "a slot does not hide a method"
    assert slots.slot_value(truck, here("DESCRIBE")) == "heavy"
    assert slots.slot_value(truck, here("WHEELS")) == 6


def test_instances_of_runtime_classes_are_made_from_lisp_too():
    assert make_instance(here("VEHICLE"), keyword("WHEELS"), 3).wheels == 3
    with pytest.raises(instances.InitargError):
        make_instance(here("VEHICLE"), keyword("WINGS"), 3)


def test_a_shared_slot_is_one_for_all_instances():
    define("COUNTED", slots=[slot("COUNT", initform=lambda: 0, allocation=keyword("CLASS"))])
    first, second = make_instance(here("COUNTED")), make_instance(here("COUNTED"))
    first.count = 5
    assert second.count == 5


# --------------------------------------------------------------------------------------------------------- generic functions


def test_a_room_defines_generic_functions_with_a_decorator():
    greet = generic.generic("CLOS-TESTS::GREET", "(who &optional how)")

    @greet.method(str)
    def _(who, how="hello"):
        return f"{how} {who}"

    @greet.method(sym("INTEGER"))
    def _(who, how=None):
        return f"number {who}"

    @greet.method(str, qualifier="around", uses_next=True)
    def _(following, who, how="hello"):
        return following() + "!"

    assert greet("Ann") == "hello Ann!"
    assert here("GREET").function(3) == "number 3"
    assert greet("Ann", "bye") == "bye Ann!"


def test_no_applicable_method_is_told_with_function_and_arguments():
    lonely = generic.generic("CLOS-TESTS::LONELY", "(object)")
    with pytest.raises(NoApplicableMethodError) as problem:
        lonely(None)
    assert str(problem.value) == (
        "There is no applicable method for the generic function\n"
        "  #<STANDARD-GENERIC-FUNCTION CLOS-TESTS::LONELY (0)>\nwhen called with arguments\n  (NIL).\n"
        "See also:\nThe ANSI Standard, Section 7.6.6"
    )
    assert [restart.name.name for restart in problem.value.restarts][:1] == ["RETRY"]


def test_no_primary_method_is_told_too():
    before = generic.generic("CLOS-TESTS::ONLY-BEFORE", "(object)")
    before.method(None, qualifier="before")(lambda obj: None)
    with pytest.raises(NoPrimaryMethodError) as problem:
        before(1)
    assert str(problem.value).startswith(
        "There is no primary method for the generic function\n  #<STANDARD-GENERIC-FUNCTION CLOS-TESTS::ONLY-BEFORE (1)>\n"
    )
    assert str(problem.value).endswith("Section 7.6.6.2")


def test_retrying_a_call_finds_the_method_that_was_added_meanwhile():
    late = generic.generic("CLOS-TESTS::LATE", "(object)")

    def add_and_retry(condition):
        late.method(None)(lambda obj: "found")
        conditions.invoke_restart(sym("RETRY"))

    assert conditions.handler_bind([(NoApplicableMethodError, add_and_retry)], lambda: late(1)) == "found"


def test_a_method_for_nil_is_not_one_for_false_objects_of_lisp():
    kind = generic.generic("CLOS-TESTS::KIND", "(object)")
    kind.method(sym("NULL"))(lambda obj: "nil")
    kind.method(sym("SYMBOL"))(lambda obj: "symbol")
    kind.method(sym("NUMBER"))(lambda obj: "number")
    assert (kind(None), kind(True), kind(0), kind(here("A"))) == ("nil", "symbol", "number", "symbol")


def test_eql_methods_tell_one_from_one_point_zero_and_from_t():
    exact = generic.generic("CLOS-TESTS::EXACT", "(object)")
    exact.method(None)(lambda obj: "other")
    exact.method(lisp_list(sym("EQL"), 1))(lambda obj: "one")
    assert (exact(1), exact(1.0), exact(True), exact(2)) == ("one", "other", "other", "other")


def test_the_cache_forgets_when_a_method_is_added_and_when_a_class_changes():
    base, other = define("BASE-A"), define("BASE-B")
    child = define("CHILD-A", [here("BASE-A")])
    which = generic.generic("CLOS-TESTS::WHICH", "(object)")
    which.method(base)(lambda obj: "a")
    which.method(other)(lambda obj: "b")
    instance = make_instance(child)
    assert which(instance) == "a"
    define("CHILD-A", [here("BASE-B")])
    assert which(instance) == "b"
    which.method(child)(lambda obj: "child")
    assert which(instance) == "child"


def test_a_wrong_number_of_arguments_is_the_program_error_of_sbcl():
    two = generic.generic("CLOS-TESTS::TWO", "(a b)")
    two.method(int, None)(lambda a, b: a)
    for arguments in ((), (1,), (1, 2, 3)):
        with pytest.raises(conditions.SimpleProgramError) as problem:
            two(*arguments)
        assert str(problem.value) == f"invalid number of arguments: {len(arguments)}"


def test_hooks_run_all_methods_and_give_the_list_of_results():
    hook = generic.generic("CLOS-TESTS::ON-EVENT", "(what)", combination="CLOS-TESTS::HOOKS")
    assert hook(1) is None
    hook.method(sym("INTEGER"), qualifier="logger")(lambda what: "logged")
    hook.method(None, qualifier="viewer")(lambda what: "shown")
    assert list(hook(1)) == ["logged", "shown"]
    assert isinstance(hook("a"), Cons) and list(hook("a")) == ["shown"]


def test_a_method_that_does_not_fit_is_refused():
    fixed = generic.generic("CLOS-TESTS::FIXED", "(a)")
    with pytest.raises(conditions.SimpleProgramError, match="the method has more required arguments than the generic function"):
        generic.add_method(fixed, (), [int, int], lambda a, b: a, lambda_list="(a b)")


# ---------------------------------------------------------------------------------------------------------------- conditions


def test_a_condition_is_an_exception_with_slots_and_a_report():
    class_definition.define_condition(
        here("LOST"),
        [sym("ERROR")],
        [slot("PLACE", keyword("PLACE"), initform=lambda: "home")],
        report=lambda condition, stream: stream.write(f"lost at {condition.place}"),
    )
    cls = find_class(here("LOST"))
    lost = make_instance(cls, keyword("PLACE"), "sea")
    assert isinstance(lost, Exception) and str(lost) == "lost at sea"
    with pytest.raises(cls):
        conditions.error(here("LOST"))


def test_slots_of_conditions_do_not_hide_what_exceptions_need():
    names = ("ARGS", "REPORT", "CONTEXT")
    class_definition.define_condition(here("ODD"), [sym("SIMPLE-ERROR")], [slot(name, keyword(name)) for name in names])
    odd = make_instance(
        find_class(here("ODD")), keyword("ARGS"), 1, keyword("REPORT"), 2, keyword("CONTEXT"), 3, keyword("FORMAT-CONTROL"), "odd"
    )
    assert str(odd) == "odd" and odd.args == ()
    assert [slots.slot_value(odd, here(name)) for name in names] == [1, 2, 3]


def test_conditions_come_before_what_they_inherit_from():
    assert [cls.__name__ for cls in lisp_mro(conditions.DivisionByZero)][:3] == ["DivisionByZero", "ArithmeticError_", "Error"]
