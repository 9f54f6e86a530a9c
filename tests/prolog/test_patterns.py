"""Matching, bindings and unification on Lisp data. Source: prolog.md sections 2 and 3, cpl.md 13.2."""

import pytest
from prolog_text import error_text, read, show

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.utilities import patterns as p


@pytest.mark.parametrize(
    "pattern, data, bindings",
    [
        ("(?x b ?y)", "(a b c)", "((?Y . C) (?X . A))"),
        ("(?x . ?r)", "(1 2 3)", "((?R 2 3) (?X . 1))"),
        ("(?p ?p)", "((1) (1))", "((?P 1))"),
        ("(?p ?p)", "(nil z)", None),
        ("(?a)", "x", None),
        ("(a b)", "(a b c)", None),
        ("(p !?m q)", "(p 1 2 q)", "((?M 1 2))"),
        ("(p !?m q)", "(p q)", "((?M))"),
        ("(!?m ?last)", "(1 2 3)", "((?LAST . 3) (?M 1 2))"),
        ("(!?m ?m)", "(1 2 (1 2))", "((?M 1 2))"),
        ("(p !?m)", "(p 1 . 2)", None),
        ("(?_ ?_)", "(1 2)", "NIL"),
        ('("a b")', '("a b")', None),
        ("(1)", "(1.0)", None),
    ],
)
def test_pat_match(pattern, data, bindings):
    found, matched = p.pat_match(read(pattern), read(data))
    assert (show(found) if matched else None) == bindings
    assert p.pat_match_p(read(pattern), read(data)) == matched


def test_pat_match_takes_keywords_in_place_of_bindings():
    equal = lambda a, b: True if p.equal(a, b) else None  # noqa: E731
    assert p.pat_match_p(read('("a" ?x)'), read('("a" 1)'), read(":test"), equal)
    assert p.pat_match_p(read("(?x)"), read("(1)"), read("((?x . 2))")) is None


@pytest.mark.parametrize(
    "pattern, data, text",
    [("(a)", "(?x)", "Found variable ?X on right hand side of pattern match."), ("!?m", "(1)", "Segvar !?M must be car of a cons-cell.")],
)
def test_pat_match_errors(pattern, data, text):
    assert error_text(lambda: p.pat_match(read(pattern), read(data))) == text


@pytest.mark.parametrize(
    "left, right, bindings",
    [
        ("?x", "?y", "((?X . ?Y))"),
        ("(?u ?v ?u)", "((?v) k (k))", "((?V . K) (?U ?V))"),
        ("(a)", "(a b)", None),
        ("1", "1.0", None),
        ("(?x . ?y)", "(1)", "((?Y) (?X . 1))"),
        ("?_", "(1 ?z)", "NIL"),
    ],
)
def test_unify(left, right, bindings):
    found, unified = p.unify(read(left), read(right))
    assert (show(found) if unified else None) == bindings


def test_segment_variables_in_unify(warnings_given):
    assert show(p.unify(read("(!?a 3)"), read("(1 2 3)"))[0]) == "((?A 1 2))"
    assert warnings_given == ["Using segvars in unify... This is not implementet properly at the moment."]
    assert error_text(lambda: p.unify(read("(a . !?x)"), read("(a b)"))) == (
        "Found segvar that is not in car of a cons-cell while unifying !?X and (B)"
    )


def test_bindings():
    assert show(p.add_bdg(read("?x"), 1, None)[0]) == "((?X . 1))"
    assert p.add_bdg(read("?x"), 2, read("((?x . 1))")) == (None, None)
    assert p.add_bdg(read("?_"), 2, None) == (None, True)
    bindings = read("((?x . (1 ?y)) (?y . 2))")
    assert show(p.var_value(read("?x"), bindings)) == "(1 2)"
    assert show(p.var_value(read("(?x)"), bindings)) == "(?X)"
    assert show(p.substitute_vars(read("(?x . ?y)"), bindings)) == "((1 2) . 2)"
    assert p.is_bound(read("?z"), bindings) is None and p.is_bound(read("(?z)"), bindings)
    assert p.is_ground(read("(?x)"), bindings) and p.is_ground(read("?z"), bindings) is None


def test_variables():
    assert [p.is_var(read(text)) for text in ("?x", "?", ":?x", "x?", '"?x"', "nil")] == [True, True, True, None, None, None]
    assert show(p.vars_in(read("(?x (?y ?x) . ?z)"))) == "(?Z ?Y ?X)"
    assert p.var_name(read("!?foo")) is read("?foo")
    assert error_text(lambda: p.var_name(read("foo"))) == "No variable."
    assert p.is_genvar(p.gen_var()) and p.is_genvar(read("?x")) is None
    assert error_text(lambda: p.gen_var("x")) and error_text(lambda: p.is_genvar(read("x")))


def test_renaming():
    renamed = p.rename_vars(read("(?x (?_ ?x) a)"))
    first = renamed.car
    assert first.package is None and first.name.startswith("?X-") and renamed.cdr.car.cdr.car is first
    assert renamed.cdr.car.car is p.ANONYMOUS
    assert p.rename_vars(read("?x"), gensym_var_names=None).name == "?X"


def test_comparing_patterns_and_bindings():
    assert p.patterns_eq(read("(a ?x (b))"), read("(a ?y (b))")) and p.patterns_eq(read("(a)"), read("(b)")) is None
    assert p.bindings_equal(read("((?x . 1))"), read("((?y . 2) (?x . 1))"))
    assert p.bindings_equal(read("((?x . 1) (?y . 2))"), read("((?x . 1))")) is None


def test_binding_macros_support():
    bindings = read("((?x . 1))")
    assert p.with_vars_bound([read("?x"), read("?z")], bindings, lambda *values: values) == (1, read("?z"))
    assert error_text(lambda: p.with_vars_strictly_bound([read("?z")], bindings, lambda z: z)) == "Couldn't resolve variable ?Z."
    assert p.with_pat_vars_bound(read("(?a b)"), read("(1 b)"), lambda value: value(read("?a"))) == 1
    assert error_text(lambda: p.with_pat_vars_bound(read("(a)"), read("(b)"), lambda value: 1)) == (
        "Pattern (A) does not match (B) in with-pat-vars-bound."
    )
    assert isinstance(p.fresh_name("?x"), Symbol)
