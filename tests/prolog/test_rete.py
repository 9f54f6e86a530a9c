"""Facts that come and go, and productions. Source: prolog.md section 12."""

import re

import pytest
from prolog_text import ask, error_text, read, show

from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.prolog.builtins import productions, rete
from cramhy_runtime.utilities.lazy_lists import force_ll


@pytest.fixture(autouse=True)
def empty_memory():
    rete.clear_alpha_network()
    productions.clear_productions()
    yield
    rete.clear_alpha_network()
    productions.clear_productions()


def events(production, *patterns):
    """Register a production and a handler; returns the list of what the handler is told."""
    seen = []
    productions.register_production(read(production), read("(" + " ".join(patterns) + ")"))
    productions.register_production_handler(
        read(production), lambda operation, *arguments: seen.append(" ".join(show(item) for item in (operation, *arguments)))
    )
    return seen


def test_facts_hold_newest_first():
    for fact in ("(on a b)", "(on b c)", "(color a red)"):
        rete.rete_assert(read(fact))
    assert show(force_ll(rete.rete_holds(read("(on ?x ?y)")))) == "(((?Y . C) (?X . B)) ((?Y . B) (?X . A)))"
    assert show(rete.rete_holds(read("(on a b)"))) == "(NIL)"
    assert rete.rete_holds(read("(on a c)")) is None
    assert show(force_ll(rete.rete_holds(read("(color . ?r)")))) == "(((?R A RED)))"


def test_asserting_twice_counts_twice():
    rete.rete_assert(read("(x 1)"))
    rete.rete_assert(read("(x 1)"))
    rete.rete_retract(read("(x 1)"))
    assert rete.rete_holds(read("(x 1)")) is not None
    rete.rete_retract(read("(x 1)"))
    assert rete.rete_holds(read("(x 1)")) is None
    assert error_text(lambda: rete.rete_retract(read("(x 1)"))) == "wme-memory already empty. Cannot retract."


def test_the_node_of_a_fact_prints_as_a_thing_of_lisp():
    assert re.fullmatch(r"#<CRAM-PROLOG::ALPHA-NODE \{[0-9A-F]+\}>", show(rete.rete_assert(read("(x 1)"))))


def test_bad_facts():
    assert error_text(lambda: rete.rete_assert(None)) and error_text(lambda: rete.rete_assert(read("(a ?_)")))


def test_texts_and_lists_match_by_content_and_lists_may_have_variables():
    rete.rete_assert(read('(name "rob" (a "b" (1 2.0)))'))
    assert rete.rete_holds(read('(name "bob" ?l)')) is None
    assert show(rete.rete_holds(read('(name "rob" (a "b" (1 2.0)))'))) == "(NIL)"
    assert show(force_ll(rete.rete_holds(read("(name ?n (a . ?rest))")))) == '(((?REST "b" (1 2.0)) (?N . "rob")))'
    assert show(force_ll(rete.rete_holds(read('(name ?n (?a "b" (1 ?y)))')))) == '(((?Y . 2.0) (?A . A) (?N . "rob")))'
    for other in ('(name "rob" (a "b" (1 2)))', '(name "rob" (a "b"))', '(name "rob" (?x ?x ?y))', '(name "rob" a)', "(name ?x (a ?x ?y))"):
        assert rete.rete_holds(read(other)) is None
    rete.rete_retract(read('(name "rob" (a "b" (1 2.0)))'))
    assert rete.rete_holds(read("(name ?x ?y)")) is None and rete.alpha_network_size() == 1


def test_a_list_that_is_circular_is_the_same_as_itself_only():
    ring, other = read("(a)"), read("(a)")
    ring.cdr, other.cdr = ring, other
    rete.rete_assert(lisp_list(read("ring"), ring))
    assert error_text(lambda: rete.rete_retract(lisp_list(read("ring"), other))) == "wme-memory already empty. Cannot retract."
    rete.rete_retract(lisp_list(read("ring"), ring))
    assert rete.alpha_network_size() == 1


def test_productions_join_by_content_and_look_into_lists():
    seen = events("placed", "(pose ?what (?x 2))", "(name ?what ?name)")
    rete.rete_assert(read('(name "cup" ("big" cup))'))
    rete.rete_assert(read('(pose "cup" (1 3))'))
    rete.rete_assert(read('(pose "cup" (1 2))'))
    rete.rete_retract(read('(name "cup" ("big" cup))'))
    assert seen == [f':{operation} :?WHAT "cup" :?X 1 :?NAME ("big" CUP)' for operation in ("ASSERT", "RETRACT")]


def test_a_join():
    for fact in ("(on a b)", "(on b c)", "(on c d)"):
        rete.rete_assert(read(fact))
    assert show(force_ll(rete.rete_prove(read("((on ?x ?y) (on ?y d))")))) == "(((?Y . C) (?X . B)))"
    assert show(rete.rete_prove(None, read("((?x . 1))"))) == "(((?X . 1)))"
    assert ask("(and (rete-holds (on ?x ?y)) (== ?y c))") == "(((?X . B) (?Y . C)))"


def test_productions_fire_when_facts_come_and_go():
    seen = events("stacked", "(on ?a ?b)", "(on ?b ?c)")
    rete.with_facts_asserted([lambda: read("(on a b)"), lambda: read("(on b c)")], lambda: None)
    assert seen == [":ASSERT :?A A :?B B :?C C", ":RETRACT :?A A :?B B :?C C"]


def test_the_same_variable_must_have_the_same_value():
    seen = events("twins", "(?op ?a ?a)")
    rete.rete_assert(read("(x 1 1)"))
    rete.rete_assert(read("(x 1 2)"))
    assert seen == [":ASSERT :?OP X :?A 1"]


def test_the_first_handler_gets_the_matches_that_exist():
    rete.rete_assert(read("(p 1)"))
    seen = events("all", "(p ?x)")
    late = []
    productions.register_production_handler(read("all"), lambda *arguments: late.append(arguments))
    assert seen == [":ASSERT :?X 1"] and late == []
    productions.remove_production(read("all"))
    rete.rete_assert(read("(p 2)"))
    assert len(seen) == 1


def test_a_fact_that_matches_two_patterns_is_joined_with_itself_once():
    seen = events("loop", "(on ?a ?b)", "(on ?b ?a)")
    rete.rete_assert(read("(on x x)"))
    assert seen == [":ASSERT :?A X :?B X"]


def test_productions_for_the_time_of_a_body():
    seen = []
    productions.with_productions(
        [(read("tmp"), read("((q ?x))"))],
        lambda: productions.with_production_handlers(
            [(read("tmp"), lambda operation, *arguments: seen.append(show(operation)))],
            lambda: rete.with_facts_asserted([lambda: read("(q 1)")], lambda: None),
        ),
    )
    assert seen == [":ASSERT", ":RETRACT"]
    rete.rete_assert(read("(q 2)"))
    assert len(seen) == 2
    assert error_text(lambda: productions.register_production_handler(read("tmp"), print)) == "Production `TMP' unknown."


def test_the_network_counts_its_nodes():
    assert rete.alpha_network_size() == 1
    rete.rete_assert(read("(a b)"))
    assert rete.alpha_network_size() == 3


def test_clearing_retracts():
    seen = events("all", "(p ?x)")
    rete.rete_assert(read("(p 1)"))
    rete.clear_alpha_network()
    rete.rete_assert(read("(p 2)"))
    assert seen == [":ASSERT :?X 1", ":RETRACT :?X 1"]


def test_redefining_a_production_warns(warnings_given):
    productions.register_production(read("p"), read("((a ?x))"))
    production = productions.register_production(read("p"), read("((b ?x))"))
    assert warnings_given and warnings_given[0].startswith("Redefining production `")
    assert show(production).startswith("#S(CRAM-PROLOG::PRODUCTION-DEFINITION :NAME P :VAR-BINDINGS (?X) :BODY ((B ?X))")
