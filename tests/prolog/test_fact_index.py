"""Facts are found by index, and the answers are those of going through all facts: the same ones in the same order.

Random facts hold atoms of all kinds and lists in lists, many with the same first symbol. Random goals know some of it: an atom, a list, a
list with variables inside, the same variable twice. The facts one by one, unified with the goal, say what the answers are.
"""

from __future__ import annotations

import random

import pytest
from prolog_text import ask, group, read, show

from cramhy_runtime.lisp_core.conditions import StorageCondition
from cramhy_runtime.lisp_core.data import Cons, LispString, list_from
from cramhy_runtime.prolog import query
from cramhy_runtime.prolog.compiler.compiler import compile_clauses
from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog.engine import relations
from cramhy_runtime.prolog.engine.database import find_predicate, functors
from cramhy_runtime.utilities.lazy_lists import force_ll

FACT, SAME = read("fact"), read("==")
VARIABLES = [read(name) for name in ("?x", "?y", "?_")]
OBJECTS = [type("Thing", (), {"__repr__": lambda self: "#<thing>"})() for _ in range(2)]
ATOMS = [read(text) for text in 'a b nil t 1 2 1.0 2.0d0 -0.0 0.0 :k "s" 1/2 #\\c'.split()] + [LispString("s"), *OBJECTS]
HEADS = [read("pose"), read("pose"), read("pose"), read("at"), 1, list_from([read("pose"), 1])]


def term(rng, depth, variables):
    chance = rng.random()
    if chance < variables:
        return rng.choice(VARIABLES)
    if depth == 0 or chance < 0.4:
        return rng.choice(ATOMS[: rng.choice((4, len(ATOMS)))])
    items = [rng.choice(HEADS)] + [term(rng, depth - 1, variables) for _ in range(rng.randint(0, 3))]
    return list_from(items, rng.choice(ATOMS) if rng.random() < 0.1 else None)


def arguments(rng, arity, variables):
    return list_from([term(rng, 2, variables) for _ in range(arity)])


def less_known(rng, value):
    """A part of ``value``, the rest of it variables: a goal that is likely to match."""
    if rng.random() < 0.2:
        return rng.choice(VARIABLES)
    if value.__class__ is not Cons:
        return value
    return Cons(less_known(rng, value.car), less_known(rng, value.cdr))


def all_of(goal):
    return show(force_ll(query.prolog(goal)))


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("seed", range(12))
def test_answers_are_those_of_going_through_all_facts(seed):
    rng = random.Random(seed)
    arity = rng.choice((1, 2, 2, 3, 5))
    rows = [arguments(rng, arity, 0) for _ in range(rng.choice((3, 40, 150)))]
    facts.define_fact_group(read("all-facts"), None, [Cons(Cons(FACT, row)) for row in rows])
    kept = [clause.head.cdr for clause in functors[FACT].clauses]
    matched = 0
    for _ in range(40):
        likely = rng.random() < 0.7
        known = list_from([less_known(rng, value) for value in rng.choice(rows)]) if likely else arguments(rng, arity, 0.3)
        goal = Cons(FACT, known)
        answers = [answer for row in kept for answer in force_ll(query.prolog(list_from([SAME, known, row]))) or ()]
        matched += bool(answers)
        for _ in range(2):  # the second time a join may answer
            assert all_of(goal) == show(list_from(answers)), show(goal)
        bound = list_from([read("and"), list_from([SAME, read("?whole"), known]), Cons(FACT, known)])
        assert len(answers) == sum(1 for _ in force_ll(query.prolog(bound)) or ())
    assert matched > 5


def poses(count):
    group("poses", *(f"((seen (pose p{i} (at {i} {i % 7})) {i}))" for i in range(count)))


def rows_tried(goal, monkeypatch):
    """How many rows the answers to ``goal`` are looked for among."""
    from cramhy_runtime.prolog.engine import relations

    tried = []
    for name in ("_unify_rows", "_unify_one"):
        original = getattr(relations, name)

        def counted(m, k, rows, terms, i, original=original):
            if i == 0:
                tried.append(len(rows))
            return original(m, k, rows, terms, i)

        monkeypatch.setattr(relations, name, counted)
    ask(goal)
    return tried


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "goal, most",
    [
        ("(seen (pose p77 (at 77 0)) ?n)", 1),
        ("(seen (pose p77 ?where) ?n)", 1),
        ("(seen (pose ?who (at 77 ?y)) ?n)", 1),
        ("(seen (pose ?who (at ?x 3)) ?n)", 60),
        ("(seen (pose ?who . ?rest) 77)", 1),
        ("(seen (pose p77 nowhere) ?n)", 0),
        ("(seen (pose p77) ?n)", 0),
        ("(and (== ?p (pose p77 ?w)) (seen ?p ?n))", 1),
    ],
)
def test_few_rows_are_tried(goal, most, monkeypatch):
    poses(400)
    assert sum(rows_tried(goal, monkeypatch)) <= most


def test_answers_come_in_the_order_of_the_facts():
    poses(50)
    assert [answer[read("?n")] for answer in query.solve(read("(seen (pose ?_ (at ?_ 3)) ?n)"))] == [3, 10, 17, 24, 31, 38, 45]


def test_a_goal_sees_the_facts_that_were_there_when_it_was_entered():
    """The logical update view: whoever goes through facts goes through those; a goal that is entered later sees the new ones."""
    poses(30)
    seen = query.solve(read("(and (seen (pose ?who (at ?x 3)) ?n) (seen (pose ?_ (at ?_ 3)) ?m))"))
    found = [next(seen)]
    group("poses", "((seen (pose q (at 9 3)) 99))")
    found += seen
    pairs = [(answer[read("?n")], answer[read("?m")]) for answer in found]
    olds = [3, 10, 17, 24]
    assert pairs == [(3, m) for m in olds] + [(n, 99) for n in olds[1:]]
    assert ask("(seen ?where ?n)") == "(((?WHERE POSE Q (AT 9 3)) (?N . 99)))"


@pytest.mark.soak
def test_facts_of_other_arities_and_rules_are_found_beside_them():
    group("mixed", *(f"((thing (part p{i})))" for i in range(20)), "((thing a b))", "((thing))")
    assert ask("(thing (part p7))") == "(NIL)" and ask("(thing a ?x)") == "(((?X . B)))" and ask("(thing)") == "(NIL)"
    group("mixed", *(f"((thing (part p{i})))" for i in range(20)), "((thing (part ?x)) (== ?x q))", "((thing . ?all))")
    assert ask("(thing (part q))") == "(NIL NIL)" and ask("(thing (part p3))") == "(NIL NIL)" and ask("(thing 1 2)") == "(NIL)"
    group("mixed", *(f"((thing (part p{i})))" for i in range(20)), "((thing (part ?x)))")
    assert ask("(thing (part ?x))").count("PART") == 0 and ask("(thing (part p3))") == "(NIL NIL)"


@pytest.mark.parametrize("endless", ["(pose . ?p)", "(pose ?p)", "(pose 1 ?p . ?p)", "(?p . ?p)"])
def test_terms_without_end_are_looked_up_and_not_found(endless):
    poses(30)
    goal = f"(and (== ?p {endless}) (seen ?p ?n))"
    assert ask(goal) == "NIL"


def test_a_term_without_end_that_matches_is_an_error_and_no_hang():
    group("loose", *(f"((loose (pose {i} {i})))" for i in range(30)))
    with pytest.raises(StorageCondition):
        ask("(and (== ?p (pose . ?p)) (or (loose ?p) (true)))")


def test_long_lists_that_begin_alike_are_told_apart():
    start = " ".join(map(str, range(100)))
    group("long", *(f"((long (l {start} {i}) {i}))" for i in range(20)))
    assert ask(f"(long (l {start} 7) ?n)") == "(((?N . 7)))"


def test_a_list_that_is_computed_on_demand_is_computed_no_further_than_needed():
    poses(30)
    asked = []
    read("one-more").function = lambda n: asked.append(n) or n
    group("numbers", "((number ?n) (member ?k (1 2 3 4)) (lisp-fun one-more ?k ?n))")
    assert ask("(and (findall ?n (number ?n) ?l) (seen (pose . ?l) ?m))") == "NIL"
    assert asked == [1] or asked == [1, 2, 3, 4]


def test_atoms_that_are_compared_by_their_contents_are_found():
    rows = [list_from([list_from([read("name"), LispString("a") if i % 2 else "a", i])]) for i in range(20)]
    facts.define_fact_group(read("texts"), None, [Cons(Cons(FACT, row)) for row in rows])
    assert [answer[read("?i")] for answer in query.solve(read('(fact (name "a" ?i))'))] == [*range(20)]


@pytest.mark.parametrize("seed", range(6))
def test_who_asks_first_gets_the_answers_of_the_table(seed, monkeypatch):
    """Where facts are many, the first goal of its kind looks through the columns, and the second one makes a table."""
    monkeypatch.setattr(relations, "_MANY", 0)
    rng = random.Random(seed)
    atoms = [read(text) for text in ("a", "b", "nil", ":k", "1", "2", '"s"', "t", "1.0")]
    arity = rng.choice((1, 2, 3, 4))
    rows = [list_from([rng.choice(atoms) for _ in range(arity)]) for _ in range(60)]
    facts.define_fact_group(read("all-facts"), None, [Cons(Cons(FACT, row)) for row in rows])
    for mask in range(2**arity):
        known = [rng.choice(atoms) if mask >> i & 1 else read(f"?v{i}") for i in range(arity)]
        goal = Cons(FACT, list_from(known))
        first, second = all_of(goal), all_of(goal)
        answers = [answer for row in rows for answer in force_ll(query.prolog(list_from([SAME, list_from(known), row]))) or ()]
        assert first == second == show(list_from(answers))


def test_facts_are_a_relation_whichever_way_they_are_read():
    """Most facts are read column by column, and others one by one. Both find that they are a table."""
    group("plain", *(f"((plain p{i} (at {i}) {i}))" for i in range(3)))
    found = compile_clauses(find_predicate(read("plain"), 3), functors[read("plain")].clauses)[1]
    assert found.arity == 3 and found.count == 3 and not found.exact
    group("plain", '((plain p0 #\\c "s"))', "((plain p1))")
    found = compile_clauses(find_predicate(read("plain"), 3), functors[read("plain")].clauses)[1]
    assert found.arity == 3 and found.count == 1
