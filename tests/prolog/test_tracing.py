"""``(trace-prolog functor...)``: the four ports of goals on ``*trace-output*``, and no trace of it when nothing is traced."""

import itertools

import pytest
import textbook
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import SOAK
from prolog_text import HERE, ask, first, group, read, show
from test_against_reference import canonical, goals_over, programs
from test_explain import explained_solutions

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import Error, handler_case
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.streams.basic_streams import StringOutputStream as StringOutput
from cramhy_runtime.languages.commonlisp.streams.stream_functions import get_output_stream_string as written
from cramhy_runtime.languages.commonlisp.streams.streams import TRACE_OUTPUT
from cramhy_runtime.prolog.engine import database, fact_groups as facts
from cramhy_runtime.prolog import query, tracing
from cramhy_runtime.prolog.engine.machine import Machine
from cramhy_runtime.utilities import patterns
from cramhy_runtime.utilities.lazy_lists import elements, force_ll, lazy_cdr

boot()
PACKAGE = sym("*PACKAGE*")

FAMILY = (
    "((parent abe homer))",
    "((parent homer bart))",
    "((parent homer lisa))",
    "((grand ?x ?z) (parent ?x ?y) (parent ?y ?z))",
    "((eldest ?x ?y) (parent ?x ?y) (cut))",
    "((count-to 0) (cut))",
    "((count-to ?n) (> ?n 0) (lisp-fun 1- ?n ?m) (count-to ?m))",
)


@pytest.fixture(autouse=True)
def nothing_traced_afterwards():
    group("family", *FAMILY)
    yield
    tracing.untrace_prolog()


def traced(functors, goal, work=None):
    """What is shown while the goal is proved, all its solutions."""
    output, outer = StringOutput(), (TRACE_OUTPUT.value, PACKAGE.value)
    TRACE_OUTPUT.value, PACKAGE.value = output, HERE  # for other tasks, too
    try:
        tracing.trace_prolog(read(f"({functors})"))
        if work is not None:
            work()
        else:
            force_ll(query.prolog(read(goal)))
    finally:
        tracing.untrace_prolog()
        TRACE_OUTPUT.value, PACKAGE.value = outer
    return "\n" + written(output)


# ------------------------------------------------------------------------------------------------------------------- the ports


def test_the_four_ports_with_depth_bindings_and_the_clause_of_a_solution():
    assert (
        traced("grand parent", "(grand ?who lisa)")
        == """
  0: CALL (GRAND ?WHO LISA)
    1: CALL (PARENT ?WHO ?Y)
    1: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY
    1: CALL (PARENT HOMER LISA)
    1: EXIT (PARENT HOMER LISA)   by clause 3 of FAMILY
  0: EXIT (GRAND ABE LISA)   by clause 4 of FAMILY
  0: REDO (GRAND ABE LISA)
    1: REDO (PARENT ABE HOMER)
    1: EXIT (PARENT HOMER BART)   by clause 2 of FAMILY
    1: CALL (PARENT BART LISA)
    1: FAIL (PARENT BART LISA)
    1: REDO (PARENT HOMER BART)
    1: EXIT (PARENT HOMER LISA)   by clause 3 of FAMILY
    1: CALL (PARENT LISA LISA)
    1: FAIL (PARENT LISA LISA)
  0: FAIL (GRAND ?WHO LISA)
""".replace("clause 4", "clause 1")
    )


def test_only_what_is_named_is_shown():
    assert (
        traced("grand", "(grand abe bart)")
        == """
  0: CALL (GRAND ABE BART)
  0: EXIT (GRAND ABE BART)   by clause 1 of FAMILY
"""
    )


def test_a_goal_whose_alternatives_are_cut_away_is_not_asked_again():
    assert (
        traced("eldest parent", "(eldest homer ?who)")
        == """
  0: CALL (ELDEST HOMER ?WHO)
    1: CALL (PARENT HOMER ?WHO)
    1: EXIT (PARENT HOMER BART)   by clause 2 of FAMILY
  0: EXIT (ELDEST HOMER BART)   by clause 1 of FAMILY
"""
    )


def test_calls_that_are_loops_and_goals_that_are_code_in_place_are_shown_too():
    assert ask("(count-to 2)") == "(NIL)"  # compiled before
    assert (
        traced("count-to > lisp-fun", "(count-to 1)")
        == """
  0: CALL (COUNT-TO 1)
    1: CALL (> 1 0)
    1: EXIT (> 1 0)
    1: CALL (LISP-FUN 1- 1 ?M)
    1: EXIT (LISP-FUN 1- 1 0)
    1: CALL (COUNT-TO 0)
    1: EXIT (COUNT-TO 0)   by clause 1 of FAMILY
  0: EXIT (COUNT-TO 1)   by clause 2 of FAMILY
"""
    )


def test_what_a_lisp_call_returned_is_told_when_the_goal_fails(warnings_given):
    assert (
        traced("lisp-fun lisp-pred", "(or (lisp-fun + 1 2 4) (lisp-pred evenp 3) (lisp-fun car 1 ?x))")
        == """
  0: CALL (LISP-FUN + 1 2 4)
  0: FAIL (LISP-FUN + 1 2 4)   (+ 1 2) returned 3, which is not 4
  0: CALL (LISP-PRED EVENP 3)
  0: FAIL (LISP-PRED EVENP 3)   (evenp 3) returned nil
  0: CALL (LISP-FUN CAR 1 ?X)
  0: FAIL (LISP-FUN CAR 1 ?X)   (car 1) signalled an error: The value 1 is not of type LIST when binding LIST
"""
    )


def test_constructs_of_control_are_shown_when_they_are_named():
    group("kinds", "((kind ?x ?k) (-> (parent ?x ?_) (== ?k parent) (== ?k child)))", "((lonely ?x) (not (parent ?x ?_)))")
    goal = "(and (kind bart ?k) (lonely bart) (once (parent ?p bart)) (findall ?c (parent ?p ?c) ?l) (cut))"
    assert (
        traced("-> not and cut once findall", goal)
        == """
  0: CALL (AND (KIND BART ?K) (LONELY BART) (ONCE (PARENT ?P BART)) (FINDALL ?C (PARENT ?P ?C) ?L) (CUT))
    1: CALL (-> (PARENT BART ?_) (== ?K PARENT) (== ?K CHILD))
    1: EXIT (-> (PARENT BART ?_) (== CHILD PARENT) (== CHILD CHILD))
    1: CALL (NOT (PARENT BART ?_))
    1: EXIT (NOT (PARENT BART ?_))
    1: CALL (ONCE (PARENT ?P BART))
    1: EXIT (ONCE (PARENT HOMER BART))
    1: CALL (FINDALL ?C (PARENT HOMER ?C) ?L)
    1: EXIT (FINDALL ?C (PARENT HOMER ?C) (BART ...))
    1: CALL (CUT)
    1: EXIT (CUT)
  0: EXIT (AND (KIND BART CHILD) (LONELY BART) (ONCE (PARENT HOMER BART)) (FINDALL ?C (PARENT HOMER ?C) (BART ...)) (CUT))
"""
    )


def test_a_goal_that_nobody_has_defined_is_shown(warnings_given):
    assert (
        traced("parnet", "(parnet abe ?x)")
        == """
  0: CALL (PARNET ABE ?X)
  0: FAIL (PARNET ABE ?X)
"""
    )
    assert warnings_given[0] == "Nobody has defined PARNET yet; its goals will be shown all the same. Did you mean parent?"


def test_two_variables_of_one_name_are_told_apart():
    group("same", "((outer ?x) (inner ?x ?y) (inner ?y ?x))", "((inner ?y ?x))")
    assert (
        traced("inner", "(outer ?y)")
        == """
  0: CALL (INNER ?Y ?Y-2)
  0: EXIT (INNER ?Y ?Y-2)   by clause 1 of SAME
  0: CALL (INNER ?Y ?Y-2)
  0: EXIT (INNER ?Y ?Y-2)   by clause 1 of SAME
"""
    )


def test_long_goals_are_cut_short():
    numbers = " ".join(map(str, range(1000)))
    assert (
        traced("length", f"(length ({numbers}) ?n)")
        == """
  0: CALL (LENGTH (0 1 2 3 4 5 6 7 8 9 10 11 ...) ?N)
  0: EXIT (LENGTH (0 1 2 3 4 5 6 7 8 9 10 11 ...) 1000)
"""
    )


# ------------------------------------------------------------------------------------------- later, elsewhere, and by other ways


def test_solutions_that_are_asked_for_later_are_shown_then():
    output = StringOutput()
    with binding(TRACE_OUTPUT, output, PACKAGE, HERE):
        tracing.trace_prolog(read("(parent)"))
        answers = first("(parent homer ?who)")
        output.write("-- later\n")
        lazy_cdr(answers)
        tracing.untrace_prolog()
        output.write("-- untraced\n")
        lazy_cdr(lazy_cdr(answers))
    assert (
        "\n" + written(output)
        == """
  0: CALL (PARENT HOMER ?WHO)
  0: EXIT (PARENT HOMER BART)   by clause 2 of FAMILY
-- later
  0: REDO (PARENT HOMER BART)
  0: EXIT (PARENT HOMER LISA)   by clause 3 of FAMILY
-- untraced
"""
    )


def test_a_query_that_a_lisp_function_makes_is_deeper():
    read("ask-inside").function = lambda who: query.holds(read("(parent abe homer)"))
    group("asking", "((asking ?x) (lisp-pred ask-inside ?x) (parent ?x ?_))")
    assert (
        traced("asking parent", "(asking homer)")
        == """
  0: CALL (ASKING HOMER)
    1: CALL (PARENT ABE HOMER)
    1: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY
    1: CALL (PARENT HOMER ?_)
    1: EXIT (PARENT HOMER BART)   by clause 2 of FAMILY
  0: EXIT (ASKING HOMER)   by clause 1 of ASKING
  0: REDO (ASKING HOMER)
    1: REDO (PARENT HOMER BART)
    1: EXIT (PARENT HOMER LISA)   by clause 3 of FAMILY
  0: EXIT (ASKING HOMER)   by clause 1 of ASKING
"""
    )


def test_an_error_that_nobody_handles_is_told():
    group("breaking", "((breaking ?x) (not))")

    def work():
        with pytest.raises(Error):
            query.prolog(read("(breaking abe)"))

    assert (
        traced("breaking", None, work)
        == """
  0: CALL (BREAKING ABE)
  0: LEFT (BREAKING ABE)   invalid number of arguments: 0
"""
    )


def test_goals_that_are_left_say_so():
    group("breaking", "((breaking ?x) (deeper ?x))", "((deeper ?x) (parent ?x ?y) (not))")

    def work():
        handler_case([(Error, lambda problem: None)], lambda: query.prolog(read("(breaking abe)")))
        query.prolog(read("(parent abe ?x)"))

    assert (
        traced("breaking deeper parent", None, work)
        == """
  0: CALL (BREAKING ABE)
    1: CALL (DEEPER ABE)
      2: CALL (PARENT ABE ?Y)
      2: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY
    1: LEFT (DEEPER ABE)   invalid number of arguments: 0
  0: LEFT (BREAKING ABE)   invalid number of arguments: 0
  0: CALL (PARENT ABE ?X)
  0: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY
"""
    )


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_several_tasks_have_goals_of_their_own(backend):
    kernel.start(clock="virtual", backend=backend)
    read("wait").function = lambda: kernel.sleep(1) or True
    group("waiting", "((waiting ?x) (lisp-pred wait) (parent ?x ?y))")

    def work():
        tasks = [kernel.spawn(query.holds, read(f"(waiting {who})"), name=who) for who in ("abe", "bart")]
        query.holds(read("(waiting homer)"))
        for task in tasks:
            task.join()

    assert (
        traced("waiting parent", None, work)
        == """
  0: CALL (WAITING HOMER)
abe:   0: CALL (WAITING ABE)
bart:   0: CALL (WAITING BART)
    1: CALL (PARENT HOMER ?Y)
    1: EXIT (PARENT HOMER BART)   by clause 2 of FAMILY
  0: EXIT (WAITING HOMER)   by clause 1 of WAITING
abe:     1: CALL (PARENT ABE ?Y)
abe:     1: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY
abe:   0: EXIT (WAITING ABE)   by clause 1 of WAITING
bart:     1: CALL (PARENT BART ?Y)
bart:     1: FAIL (PARENT BART ?Y)
bart:   0: FAIL (WAITING BART)
"""
    )


def test_a_task_that_is_ended_leaves_its_goals():
    read("wait").function = lambda: kernel.sleep(100) or True
    group("waiting", "((waiting ?x) (lisp-pred wait))")

    def work():
        task = kernel.spawn(query.holds, read("(waiting abe)"), name="waiter")
        kernel.sleep(1)
        task.cancel()
        kernel.sleep(1)

    assert traced("waiting", None, work).splitlines()[1:] == [
        "waiter:   0: CALL (WAITING ABE)",
        "waiter:   0: LEFT (WAITING ABE)   its task was ended",
    ]


# -------------------------------------------------------------------------------------------------------------- the same answers


@pytest.mark.parametrize(
    "goal",
    [
        "(grand ?x ?y)",
        "(eldest ?x ?y)",
        "(count-to 5)",
        "(and (parent ?x ?y) (-> (eldest ?y ?z) (true) (== ?z none)))",
        "(findall (?x ?y) (parent ?x ?y) ?l)",
        "(forall (parent ?x ?y) (not (parent ?y ?x)))",
        "(or (parent lisa ?x) (cut) (true))",
        "(and (parent ?x ?y) (filter-bindings (?y)))",
        "(and (== ?g (parent ?x lisa)) (call ?g))",
        "(*-> (parent homer ?x) (== ?y ?x) (fail))",
    ],
)
def test_what_is_traced_answers_as_ever(goal):
    def all_answers():
        answers = query.prolog(read(goal))
        lists = [
            [(pair.car, show(force_ll(pair.cdr)) if hasattr(pair.cdr, "car") else pair.cdr) for pair in answer or ()]
            for answer in force_ll(answers) or ()
        ]
        return lists

    expected = all_answers()
    output = StringOutput()
    with binding(TRACE_OUTPUT, output):
        for functors in ("(:all)", "(and or not -> *-> cut true fail once call findall forall filter-bindings == > lisp-fun parent)"):
            tracing.trace_prolog(read(functors))
            assert all_answers() == expected
            tracing.untrace_prolog()
    assert "CALL" in written(output) and all_answers() == expected


def test_forall_behind_a_cut_works_while_the_goals_that_it_is_made_of_are_traced():
    group("forall", "((tidy ?x) (cut) (forall (parent ?x ?y) (parent ?x ?y)) (== ?x homer))")
    with binding(TRACE_OUTPUT, StringOutput()), tracing.tracing(*map(read, ("cut", "not"))):
        assert query.holds(read("(tidy homer)"))


@given(programs, goals_over(["P1", "P2", "P3"]), st.lists(st.integers(0, 20), max_size=4))
@settings(max_examples=100 if SOAK else 40, deadline=None)
def test_random_programs_answer_as_ever_when_they_are_traced(program, goal, cuts):
    kernel.start(clock="virtual")
    clauses = [clause for part in program for clause in part]
    for number in cuts:  # some clauses begin with a cut
        at = number % len(clauses)
        clauses[at] = Cons(clauses[at].car, Cons(list_from([read("cut")]), clauses[at].cdr))
    name = read("random-program")
    facts.remove_fact_group(name)
    facts.define_fact_group(name, None, clauses)
    variables = patterns.variables_of(goal)

    def some_answers():
        answers = itertools.islice(elements(query.prolog(goal)), 40)
        return [canonical([patterns.var_value(symbol, table) for symbol in variables]) for table in answers]

    try:
        explained_solutions(goal)
        expected = some_answers()
        with binding(TRACE_OUTPUT, StringOutput()), tracing.tracing(), tracing.tracing(*map(read, ("and", "or", "not", "->", "cut"))):
            assert some_answers() == expected
        assert some_answers() == expected
    except textbook.Cyclic:
        pass
    finally:
        facts.remove_fact_group(name)


# ------------------------------------------------------------------------------------------------------------------- on and off


def test_trace_prolog_tells_what_is_new_and_without_names_what_there_is():
    assert show(tracing.trace_prolog(read("(parent grand)"))) == "(PARENT GRAND)"
    assert show(tracing.trace_prolog(read("(>)"))) == "(>)"
    assert show(tracing.trace_prolog()) == "(PARENT GRAND >)"
    assert tracing.untrace_prolog(read("(grand)")) is True
    assert show(tracing.trace_prolog()) == "(PARENT >)"
    assert show(tracing.trace_prolog(read("(:all)"))) == "(:ALL)"
    assert show(tracing.trace_prolog()) == "(:ALL PARENT >)"
    assert tracing.untrace_prolog() is True
    assert tracing.trace_prolog() is None


def test_when_nothing_is_traced_any_more_the_code_is_the_one_that_it_was():
    next_solution = Machine.next_solution
    assert ask("(count-to 3)") == "(NIL)"
    names = database.find_predicate(read("count-to"), 1).call.__code__.co_names
    traced("count-to", "(count-to 3)")
    assert ask("(count-to 3)") == "(NIL)"
    assert database.find_predicate(read("count-to"), 1).call.__code__.co_names == names
    assert Machine.next_solution is next_solution and not tracing._proofs_of_tasks


def test_untracing_what_is_not_traced_warns(warnings_given):
    with binding(PACKAGE, HERE):
        tracing.untrace_prolog(read("(parent)"))
    assert warnings_given == ["PARENT is not traced."]


def test_what_is_no_functor_is_refused_and_nothing_is_traced():
    with binding(PACKAGE, HERE):
        text = handler_case([(Error, lambda problem: str(problem))], lambda: tracing.trace_prolog(read("(parent ?x)")))
    assert text == "TRACE-PROLOG takes the functors of goals, and :ALL: ?X is none."
    assert tracing.trace_prolog() is None


def test_a_group_that_is_defined_again_stays_traced():
    def work():
        with binding(sym("*ERROR-OUTPUT*"), StringOutput()):
            group("family", "((parent ned rod))")
        query.prolog(read("(parent ned ?x)"))

    assert (
        traced("parent", None, work)
        == """
  0: CALL (PARENT NED ?X)
  0: EXIT (PARENT NED ROD)   by clause 1 of FAMILY
"""
    )


def test_a_context_manager_for_python():
    output = StringOutput()
    with binding(TRACE_OUTPUT, output, PACKAGE, HERE):
        with tracing.tracing(read("parent")):
            query.holds(read("(parent abe homer)"))
        query.holds(read("(parent abe homer)"))
    assert written(output) == "  0: CALL (PARENT ABE HOMER)\n  0: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY\n"
