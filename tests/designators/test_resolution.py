"""Resolving designators: designators.md section 13, invariants 13 to 35 and 46 to 52."""

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime import designators as desig
from cramhy_runtime.designators import equating, locations
from cramhy_runtime.languages.commonlisp.faces.designators import language_support
from cramhy_runtime.designators.classes import DesignatorError
from cramhy_runtime.lisp_core.conditions import Error, handler_bind, invoke_restart
from cramhy_runtime.lisp_core.data import lisp_list, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import find_package, keyword, make_package, sym
from cramhy_runtime.languages.commonlisp.streams.basic_streams import StringOutputStream
from cramhy_runtime.languages.commonlisp.streams.streams import TRACE_OUTPUT
from cramhy_runtime.prolog.explanations import explanations
from cramhy_runtime.prolog import query, tracing
from cramhy_runtime.utilities.lazy_lists import from_iterator

from .support import facts, lisp, make, python, user

DRIVING = [
    [["desig::motion-grounding", "?desig", ["drive", "?speed"]],
     ["desig::desig-prop", "?desig", [":type", ":driving"]], ["desig::desig-prop", "?desig", [":speed", "?speed"]]],
    [["desig::motion-grounding", "?desig", ["move", "?goal"]],
     ["desig::desig-prop", "?desig", [":type", ":moving"]], ["desig::desig-prop", "?desig", [":goal", "?goal"]]],
]  # fmt: skip


@pytest.fixture
def driving():
    with facts("driving", ["desig::motion-grounding"], *DRIVING):
        yield


def error_of(designator):
    with pytest.raises(DesignatorError) as problem:
        desig.reference(designator)
    return problem.value


def test_a_motion_is_ground_by_prolog_once_and_for_all(driving):
    motion = make("motion", [":type", ":driving"], [":speed", 5])
    assert (motion.effective, motion.timestamp) == (None, None)
    kernel.sleep(3)
    solution = desig.reference(motion)
    assert python(solution) == ["DRIVE", 5]
    assert (motion.effective, motion.timestamp) == (True, 3.0)
    kernel.sleep(3)
    assert desig.reference(motion) is solution and motion.timestamp == 3.0


@pytest.mark.parametrize(
    "kind, text",
    [
        ("motion", "Cannot resolve motion designator #<A MOTION\n    (TYPE FLYING)>."),
        ("action", "Cannot resolve action designator #<A ACTION\n    (TYPE FLYING)>."),
        ("location", "Unable to resolve designator `#<A LOCATION\n    (TYPE FLYING)>'"),
        ("object", "Designator `#<A OBJECT\n    (TYPE FLYING)>' does not reference an object."),
        ("human", "Designator `#<A HUMAN\n    (TYPE FLYING)>' does not reference an human."),
    ],
)
def test_what_cannot_be_resolved_says_so(kind, text):
    designator = make(kind, [":type", ":flying"])
    assert error_of(designator).report() == text
    assert designator.effective is None and designator.timestamp is None


HERE = find_package("HINTS") or make_package("HINTS", use=["CRAM-PROLOG", "CRAM-DESIGNATORS"])


def hint_of(designator):
    """The hint of the error, in a package where the names of Prolog and of designators need no prefix."""
    with binding(sym("*PACKAGE*"), HERE):
        return error_of(designator).hint.replace("cram-user::", "")


def test_the_hint_tells_the_nearest_clause_and_what_it_misses(driving):
    assert (
        hint_of(make("motion", [":type", ":driving"]))
        == """\
Of 2 clauses this one came furthest, clause 1 of driving:
  (motion-grounding ?desig (drive ?speed))
  holds  (desig-prop ?desig (:type :driving))
  FAILS  (desig-prop ?desig (:speed ?speed))
           There is no property :speed.
  with ?desig = #<a motion (type driving)>
(explain) tries it again and tells all of it."""
    )


def test_the_hint_names_a_property_that_is_misspelled(driving):
    assert (
        hint_of(make("motion", [":type", ":driving"], [":sped", 3]))
        == """\
Of 2 clauses this one came furthest, clause 1 of driving:
  (motion-grounding ?desig (drive ?speed))
  holds  (desig-prop ?desig (:type :driving))
  FAILS  (desig-prop ?desig (:speed ?speed))
           There is no property :speed, but :sped; is that misspelled?
  with ?desig = #<a motion (type driving) (sped 3)>
(explain) tries it again and tells all of it."""
    )


def test_the_hint_names_a_type_that_is_misspelled_and_the_others_that_there_are(driving):
    assert (
        hint_of(make("motion", [":type", ":mvoing"], [":goal", 1]))
        == """\
Of 2 clauses this one came furthest, clause 2 of driving:
  (motion-grounding ?desig (move ?goal))
  FAILS  (desig-prop ?desig (:type :moving))
           :type is :mvoing, not :moving; is that misspelled?
    -    (desig-prop ?desig (:goal ?goal))
  with ?desig = #<a motion (type mvoing) (goal 1)>
As far came:
  clause 1: :type is :mvoing, not :driving
(explain) tries it again and tells all of it."""
    )


def test_the_hint_says_that_a_property_has_one_value(driving):
    assert hint_of(make("motion", [":type", ":moving"], [":goal", 5, 5, 0])).splitlines()[4:5] == [
        "           :goal has 3 values, and a property has one: (:goal (5 5 0))."
    ]
    assert hint_of(make("motion", [":type", ":moving"], [":goal"])).splitlines()[4:5] == ["           :goal is without a value."]


def test_the_hint_calls_nothing_a_second_time():
    calls = []
    user("SPEED-OF").function = lambda name: calls.append(name)
    with facts(
        "driving",
        ["desig::motion-grounding"],
        [
            ["desig::motion-grounding", "?desig", ["drive", "?speed"]],
            ["desig::desig-prop", "?desig", [":how", "?how"]],
            ["prolog::lisp-fun", "speed-of", "?how", "?speed"],
            ["prolog::bound", "?speed"],
            ["prolog::==", "?speed", "fast"],
        ],
    ):
        designator = make("motion", [":how", ":slowly"])
        hint = hint_of(designator)
        assert len(calls) == 1
        assert (
            hint
            == """\
There is one clause, clause 1 of driving:
  (motion-grounding ?desig (drive ?speed))
  holds  (desig-prop ?desig (:how ?how))
  STOPS  (lisp-fun speed-of ?how ?speed)
           What it calls was not called again here.
    -    (bound ?speed)
    -    (== ?speed fast)
  with ?desig = #<a motion (how slowly)>, ?how = :slowly
(explain) tries it again and tells all of it."""
        )
        assert explanations.explain(designator).reason == "nil is not cram-user::fast"
    assert len(calls) == 2


def test_the_hint_says_when_there_is_a_solution_by_now():
    designator = make("action", [":type", ":drawing"])
    problem = error_of(designator)
    with facts("drawing", ["desig::action-grounding"], [["desig::action-grounding", "?desig", ["draw"]]]):
        assert problem.hint == "There is a solution now. This designator was tried before there was, and keeps to that: make a new one."


def test_the_hint_can_be_read_when_the_kernel_has_stopped(driving):
    problem = error_of(make("motion", [":type", ":driving"]))
    kernel.stop()
    assert "There is no property :speed." in problem.hint


def test_the_groundings_of_a_designator_can_be_traced(driving):
    output = StringOutputStream()
    with binding(TRACE_OUTPUT, output, sym("*PACKAGE*"), HERE), tracing.tracing("DESIG::MOTION-GROUNDING", "DESIG::DESIG-PROP"):
        desig.reference(make("motion", [":type", ":moving"], [":goal", 2]))
    assert (
        output.take().replace("CRAM-USER::", "")
        == """\
  0: CALL (MOTION-GROUNDING #<A MOTION (TYPE MOVING) (GOAL 2)> ?_)
    1: CALL (DESIG-PROP #<A MOTION (TYPE MOVING) (GOAL 2)> (:TYPE :DRIVING))
    1: FAIL (DESIG-PROP #<A MOTION (TYPE MOVING) (GOAL 2)> (:TYPE :DRIVING))   :type is :moving, not :driving
    1: CALL (DESIG-PROP #<A MOTION (TYPE MOVING) (GOAL 2)> (:TYPE :MOVING))
    1: EXIT (DESIG-PROP #<A MOTION (TYPE MOVING) (GOAL 2)> (:TYPE :MOVING))
    1: CALL (DESIG-PROP #<A MOTION (TYPE MOVING) (GOAL 2)> (:GOAL ?GOAL))
    1: EXIT (DESIG-PROP #<A MOTION (TYPE MOVING) (GOAL 2)> (:GOAL 2))
  0: EXIT (MOTION-GROUNDING #<A MOTION (TYPE MOVING) (GOAL 2)> (MOVE 2))   by clause 2 of DRIVING
"""
    )


def traced(designator):
    output = StringOutputStream()
    with binding(TRACE_OUTPUT, output, sym("*PACKAGE*"), HERE), tracing.tracing("DESIG::MOTION-GROUNDING"):
        error_of(designator)
    return output.take().splitlines()[-1]


def test_the_trace_says_that_there_are_no_clauses_only_where_there_are_none():
    flying = "  0: FAIL (MOTION-GROUNDING #<A MOTION (TYPE FLYING)> ?_)"
    assert traced(make("motion", [":type", ":flying"])) == f"{flying}   there are no clauses for it"
    with facts("driving", ["desig::motion-grounding"], *DRIVING):
        assert traced(make("motion", [":type", ":flying"])) == flying


def test_explain_without_a_goal_takes_the_designator_of_the_last_error(driving):
    designator = make("motion", [":type", ":flying"])
    hint_of(designator)
    assert explanations.to_explain == [designator]


def test_the_hint_without_any_clause_says_what_to_define():
    assert error_of(make("motion", [":type", ":driving"])).hint == (
        "There is no clause of motion-grounding that could resolve it. Define one in a fact group that lists desig:motion-grounding, "
        "and load the file."
    )


def test_an_object_stands_for_what_perception_put_into_its_data():
    thing = make("object")
    thing.data = "the cup"
    assert desig.reference(thing) == "the cup"


def test_an_action_without_solution_stays_without_and_a_new_one_resolves():
    old = make("action", [":type", ":drawing"])
    error_of(old)
    with facts("drawing", ["desig::action-grounding"], [["desig::action-grounding", "?desig", ["draw"]]]):
        error_of(old)
        assert python(desig.reference(make("action", [":type", ":drawing"]))) == ["DRAW"]


def test_the_solutions_of_an_action_come_in_clause_order():
    with facts(
        "drawing",
        ["desig::action-grounding"],
        [["desig::action-grounding", "?d", ["draw", 1]]],
        [["desig::action-grounding", "?d", ["draw", 2]]],
    ):
        action = make("action", [":type", ":drawing"])
        assert python(desig.reference(action)) == ["DRAW", 1]
        second = desig.next_solution(action)
        assert python(desig.reference(second)) == ["DRAW", 2] and desig.desig_equal(action, second)
        assert desig.next_solution(second) is None
        fresh = make("action", [":type", ":drawing"])
        assert python(from_all(equating.designator_solutions(fresh))) == [["DRAW", 1], ["DRAW", 2]]


def from_all(lazy):
    from cramhy_runtime.utilities.lazy_lists import force_ll

    return force_ll(lazy)


def test_two_tasks_that_need_one_designator_resolve_it_once():
    runs = []

    def generator(designator):
        runs.append(designator)
        cpl.sleep(1)
        return lisp_list(["pose"])

    with generators(generator):
        place = make("location", [":name", ":here"])
        found = []
        cpl.top_level(lambda: cpl.par(lambda: found.append(desig.reference(place)), lambda: found.append(desig.reference(place))))
    assert len(runs) == 1 and found[0] is found[1]


# ----------------------------------------------------------------------------------------------------------------- locations


class generators:  # noqa: N801  (reads as a statement)
    """``with generators(f, g):`` register them with the priorities 1, 2, ... and the validators given by keyword."""

    def __init__(self, *functions, validators=()):
        self.functions, self.validators = functions, validators

    def __enter__(self):
        self.names = []
        for registry, functions in ((locations.generators, self.functions), (locations.validators, self.validators)):
            for priority, function in enumerate(functions, 1):
                name = user(f"TEST-{id(registry)}-{priority}")
                name.function = function
                registry.register(priority, name)
                self.names.append((registry, name))
        return [name for _, name in self.names]

    def __exit__(self, *problem):
        for registry, name in self.names:
            registry.delete(name)


def giving(*values):
    return lambda designator: list_from(values)


def place():
    return make("location", [":name", ":here"])


def all_references(designator):
    found = []
    while designator is not None:
        found.append(desig.reference(designator))
        designator = desig.next_solution(designator)
    return found


def answering(function):
    return lambda designator, solution: keyword(function(solution))


def test_one_generator_gives_its_value_and_no_other():
    with generators(giving("a")):
        location = place()
        assert desig.reference(location) == "a" and desig.next_solution(location) is None


def test_generators_give_their_values_in_the_order_of_priority_and_the_same_objects_again():
    with generators(giving("a"), giving("b")):
        location = place()
        assert all_references(location) == ["a", "b"]
        assert desig.next_solution(location) is desig.next_solution(location)


def test_a_generator_registered_later_does_not_change_a_designator():
    location = place()
    with generators(giving("a")):
        desig.reference(location)
        with generators(giving("a"), giving("b")):
            assert desig.next_solution(location) is None


def test_validators_restrict_to_what_all_of_them_accept():
    def only(*allowed):
        return answering(lambda solution: "ACCEPT" if solution in allowed else "REJECT")

    with generators(giving(1, 2, 3, 4), validators=[only(1, 2, 3), only(2, 3, 4)]):
        assert all_references(place()) == [2, 3]
    with generators(giving(1, 2), validators=[only(1), only(2)]):
        error_of(place())


@pytest.mark.parametrize(
    "verdicts, valid",
    [
        (["UNKNOWN"], True), (["MAYBE-REJECT"], False), (["MAYBE-REJECT", "ACCEPT"], True), (["ACCEPT", "MAYBE-REJECT"], True),
        (["ACCEPT", "REJECT"], False), (["T-IS-NO-VERDICT"], False), ([], True),
    ],
)  # fmt: skip
def test_verdicts(verdicts, valid):
    with generators(giving(1), validators=[answering(lambda _, verdict=verdict: verdict) for verdict in verdicts]):
        assert bool(locations.validate_location_designator_solution(place(), 1)) is valid


def test_so_many_candidates_are_drawn_and_then_the_search_ends():
    drawn = []

    def endless(designator):
        def candidates():
            while True:
                drawn.append(1)
                yield len(drawn)

        return from_iterator(candidates())

    with generators(endless, validators=[answering(lambda _: "REJECT")]):
        error_of(place())
        assert len(drawn) == 31
        drawn.clear()
        with binding(sym("DESIG::*LOCATION-GENERATOR-MAX-RETRIES*"), 3):
            error_of(place())
        assert len(drawn) == 4


def test_accepting_the_first_candidate_takes_one_step_of_the_generator():
    drawn = []

    def endless(designator):
        return from_iterator(iter(lambda: drawn.append(1) or len(drawn), 0))

    with generators(endless):
        location = place()
        assert desig.reference(location) == 1 and len(drawn) == 1
        desig.next_solution(location)
        assert len(drawn) == 2


def test_the_counter_starts_anew_after_an_accepted_candidate():
    with generators(giving(*range(80)), validators=[answering(lambda x: "ACCEPT" if x % 25 == 0 else "REJECT")]):
        assert all_references(place()) == [0, 25, 50, 75]


def test_a_restart_decides_on_a_candidate_whose_validator_fails():
    def broken(designator, solution):
        from cramhy_runtime.lisp_core.conditions import error

        error("broken")

    with generators(giving(1), validators=[broken]):

        def accept(condition):
            invoke_restart(sym("DESIG::ACCEPT-SOLUTION"))

        assert handler_bind([(Error, accept)], lambda: desig.reference(place())) == 1


def test_disabled_generators_are_skipped_and_still_listed():
    with generators(giving("a"), giving("b")) as names:
        locations.disable_location_generator_function(names[0])
        assert desig.reference(place()) == "b"
        assert names[0].function in list(locations.list_location_generators())
        locations.enable_location_generator_function(names[0])
        assert desig.reference(place()) == "a"


def test_registering_again_changes_the_priority_and_adds_no_second_entry():
    with generators(giving("a"), giving("b")) as names:
        locations.register_location_generator(9, names[0])
        assert all_references(place()) == ["b", "a"]


def test_filters_hold_in_their_extent_and_all_of_them():
    with generators(giving(1, 2, 3, 4, 6)):

        def even():
            return locations.with_designator_solution_filter(
                lambda x: x % 2 == 0, lambda: locations.with_designator_solution_filter(lambda x: x > 2, lambda: desig.reference(place()))
            )

        assert even() == 4
        assert desig.reference(place()) == 1


def test_a_location_ground_by_prolog_drops_the_samples_of_other_generators():
    with (
        facts("places", ["desig::location-grounding"], [["desig::location-grounding", "?d", "'kitchen"]]),
        generators(giving("somewhere", "kitchen")),
    ):
        assert all_references(place()) == ["kitchen", "kitchen"]


def test_a_location_without_solution_resolves_after_a_clause_was_added():
    location = place()
    error_of(location)
    with facts("places", ["desig::location-grounding"], [["desig::location-grounding", "?d", "'kitchen"]]):
        assert desig.reference(location) == "kitchen"


# ---------------------------------------------------------------------------------------------------------------- predicates


def test_desig_prop_gives_all_values_in_order_and_fails_for_a_wrong_one():
    motion = make("motion", [":a", 1], [":b", 2], [":a", 3])
    goal = lisp_list(sym("DESIG::DESIG-PROP"), motion, lisp([":a", "?v"]))
    assert [solution[user("?V")] for solution in query.solve(goal)] == [1, 3]
    assert not query.holds(lisp_list(sym("DESIG::DESIG-PROP"), motion, lisp([":a", 2])))
    assert not query.holds(lisp(["desig::desig-prop", "?unbound", [":a", "?v"]]))


def test_type_tests_and_slots_as_predicates():
    location = place()
    assert query.holds(lisp_list(sym("DESIG::LOC-DESIG?"), location))
    assert not query.holds(lisp_list(sym("DESIG::MOTION-DESIG?"), location))
    assert query.first(lisp_list(sym("DESIG::DESIG-CLASS"), location, user("?C")), user("?C")) is keyword("LOCATION")
    assert not query.holds(lisp_list(sym("DESIG::EFFECTIVE-DESIGNATOR"), location))


# ------------------------------------------------------------------------------------------------------------ language support


def test_a_task_that_waits_for_the_equate_fluent_wakes_up():
    first, second = place(), place()

    def waiting():
        return language_support.with_equate_fluent(first, user("EQUATED"), lambda fluent: cpl.wait_for(cpl.pulsed(fluent)))

    assert cpl.top_level(lambda: cpl.par(waiting, lambda: (cpl.sleep(1), desig.equate(first, second)))) is True


def test_with_designators_is_a_node_of_the_task_tree_and_create_functions_come_first():
    special = place()
    function = language_support.register_designator_create_function(
        lambda name, type_, properties: special if type_ is keyword("LOCATION") else None
    )
    try:

        def body():
            return (
                language_support.create_designator(user("HERE"), keyword("LOCATION"), None),
                language_support.create_designator(user("GO"), keyword("MOTION"), None),
            )

        made, other = cpl.top_level(lambda: language_support.with_designators(body))
    finally:
        language_support._create_functions.remove(function)
    assert made is special and isinstance(other, desig.MotionDesignator)
    with pytest.raises(Error):
        language_support.with_designators(lambda: 1)
