"""Productions against a join of a page, with handlers that change the facts themselves, and with many facts."""

import itertools
import random

import pytest
from prolog_text import error_text, read, show

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.equality import eql, equalp
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.prolog.builtins import productions, rete
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable

ASSERT, RETRACT = keyword("ASSERT"), keyword("RETRACT")


@pytest.fixture(autouse=True)
def empty_memory():
    rete.clear_alpha_network()
    productions.clear_productions()
    yield
    rete.clear_alpha_network()
    productions.clear_productions()


def production(name, patterns, handler):
    productions.register_production(read(name), read(patterns))
    productions.register_production_handler(read(name), handler)


def naive_matches(patterns, facts):
    """The values of the variables of each match, one for each combination of assertions; ``facts`` and patterns are Python lists."""
    found = []
    for chosen in itertools.product(facts, repeat=len(patterns)):
        values = {}
        if all(
            len(pattern) == len(fact)
            and all(
                item is ANONYMOUS or (values.setdefault(item, value) == value if variable(item) else item is value or item == value)
                for item, value in zip(pattern, fact)
            )
            for pattern, fact in zip(patterns, chosen)
        ):
            found.append(tuple(sorted((item.name, str(value)) for item, value in values.items())))
    return sorted(found)


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("seed", range(40))
def test_matches_are_those_of_a_plain_join_whatever_comes_and_goes(seed):
    rng = random.Random(seed)
    constants = [read(name) for name in "a b c".split()]
    names = [read(name) for name in "?x ?y ?z".split()] + [ANONYMOUS]
    held = {}
    wanted = {}
    for number in range(3):
        patterns = [[rng.choice(constants + names) for _ in range(rng.choice((2, 2, 3)))] for _ in range(rng.randint(1, 3))]

        def handler(operation, *arguments, number=number):
            values = tuple(sorted((name.name, str(value)) for name, value in zip(arguments[::2], arguments[1::2])))
            held[number].append(values) if operation is ASSERT else held[number].remove(values)

        held[number], wanted[number] = [], patterns
        name = read(f"p{number}")
        productions.register_production(name, list_from([list_from(pattern) for pattern in patterns]))
        if number:
            productions.register_production_handler(name, handler)
        else:
            late = name, handler
    facts = []
    for step in range(40):
        if step == 15:
            productions.register_production_handler(*late)
        if facts and rng.random() < 0.4:
            fact = facts.pop(rng.randrange(len(facts)))
            rete.rete_retract(list_from(fact))
        else:
            facts.append([rng.choice(constants) for _ in range(rng.choice((2, 2, 3)))])
            rete.rete_assert(list_from(facts[-1]))
        if step % 8 == 7:
            for number, patterns in wanted.items():
                if number or step > 15:
                    assert sorted(held[number]) == naive_matches(patterns, facts)
    for fact in facts:
        rete.rete_retract(list_from(fact))
    assert all(not matches for matches in held.values()) and rete.alpha_network_size() == 1


def test_productions_that_differ_in_the_names_of_variables_share_their_facts():
    for name, patterns in (("p1", "((on ?a ?b) (on ?b ?c))"), ("p2", "((on ?x ?y))"), ("p3", "((on ?y ?y))")):
        production(name, patterns, lambda *arguments: None)
    assert len(productions._network.stores) == 2
    productions.remove_production(read("p1"))
    productions.remove_production(read("p2"))
    assert len(productions._network.stores) == 1
    productions.remove_production(read("p3"))
    assert not productions._network.stores


def test_every_handler_hears_of_a_match_before_it_hears_that_it_is_gone_or_not_at_all():
    heard = []

    def retracting(operation, *arguments):
        heard.append(("newest", operation.name))
        if operation is ASSERT:
            rete.rete_retract(read("(at 1)"))

    production("p", "((at ?x))", lambda operation, *arguments: heard.append(("oldest", operation.name)))
    productions.register_production_handler(read("p"), retracting)
    rete.rete_assert(read("(at 1)"))
    assert heard == [("newest", "ASSERT"), ("newest", "RETRACT")]


def test_an_error_in_a_handler_reaches_who_asserts_when_the_others_have_been_told():
    heard = []
    production("p", "((at ?x))", lambda *arguments: error("No such place."))
    production("q", "((at ?y))", lambda operation, *arguments: heard.append(operation.name))
    assert error_text(lambda: rete.rete_assert(read("(at 1)"))) == "No such place."
    assert error_text(lambda: rete.rete_retract(read("(at 1)"))) == "No such place."
    assert heard == ["ASSERT", "RETRACT"] and rete.rete_holds(read("(at 1)")) is None


def test_a_fact_that_a_body_has_retracted_itself_does_not_keep_the_others():
    facts = [lambda: read("(a 1)"), lambda: read("(b 1)")]
    assert (
        error_text(lambda: rete.with_facts_asserted(facts, lambda: rete.rete_retract(read("(a 1)"))))
        == "wme-memory already empty. Cannot retract."
    )
    assert rete.alpha_network_size() == 1


@pytest.mark.parametrize("fact", ["5", '"fact"', "(a . b)"])
def test_a_fact_is_a_proper_list(fact):
    assert "is not of type\n  LIST" in error_text(lambda: rete.rete_assert(read(fact)))
    assert rete.alpha_network_size() == 1


def test_a_circular_fact_is_refused():
    fact = read("(a b)")
    fact.cdr.cdr = fact
    assert (
        error_text(lambda: rete.rete_assert(fact)) == "The list that starts with PROLOG-TESTS-HERE::A is circular: a fact is a proper list."
    )


def test_a_pattern_may_end_in_a_variable():
    heard = []
    production("p", "((at ?x . ?rest))", lambda operation, *arguments: heard.append(" ".join(show(item) for item in arguments)))
    for fact in ("(at 1)", "(at 2 3 4)", "(on 1)", "(at)"):
        rete.rete_assert(read(fact))
    assert heard == [":?X 1 :?REST NIL", ":?X 2 :?REST (3 4)"]


def test_a_test_of_ones_own():
    rete.rete_assert(list_from([read("name"), "rob"]))
    pattern = list_from([read("name"), "".join(["R", "ob"])])
    assert rete.rete_holds(pattern) is None
    assert rete.rete_holds(pattern, eql) is None
    assert show(rete.rete_holds(pattern, equalp)).startswith("(NIL")


@pytest.mark.soak
def test_a_join_of_three_patterns_over_ten_thousand_facts():
    """A chain of 5,000 links and as many labels: each new fact is joined with its neighbours only, not with all facts."""
    found = []
    next_, label, green = read("next"), read("label"), read("green")
    production("p", "((next ?a ?b) (next ?b ?c) (label ?b green))", lambda operation, *arguments: found.append(arguments))
    looked_at = 0

    class Counting(productions.Store):
        def having(self, columns, key):
            nonlocal looked_at
            rows = super().having(columns, key)
            looked_at += len(rows)
            return rows

    for store in productions._network.stores.values():
        store.__class__ = Counting
    for i in range(5000):
        rete.rete_assert(list_from([next_, i, i + 1]))
        rete.rete_assert(list_from([label, i, green]))
    assert len(found) == 4999 and looked_at < 50_000
    rete.rete_retract(list_from([next_, 2500, 2501]))
    assert len(found) == 4999 + 2
    assert show(rete.rete_holds(read("(next 2499 ?x)"))).startswith("(((?X . 2500))")
