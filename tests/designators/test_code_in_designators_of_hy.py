"""Code of Hy in a designator or a fact, which is data, is refused when the file is compiled."""

import types

import hy
import pytest
from hy.errors import HySyntaxError

from cramhy_runtime.languages.hy.malformed import MalformedForm  # which it is once a session has attended to Hy


def compiled(text):
    module = types.ModuleType("code_in_designators")
    hy.eval(hy.read_many("(require cramhy *)\n" + text), module=module, locals=module.__dict__)
    return module


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("code", "kind", "value"),
    [
        ('f"room-{n}"', "f-string", None),
        ('{"tries" n}', "dict", None),
        ('#{"left"}', "set", None),
        ('b"ab"', "bytes", None),
        ("~n", "~ without a backquote", "n"),
        ("~(+ n 1)", "~ without a backquote", "(+ n 1)"),
        ("?pose.x", "attribute", None),
        ("pose.x", "attribute", None),
    ],
)
@pytest.mark.parametrize(
    "form", ["(a motion (type driving) (goal {}))", "(an action (of (a location (at {}))))", "(all object (sizes [1 {}]))"]
)
def test_code_in_a_designator_is_refused(form, code, kind, value):
    with pytest.raises((HySyntaxError, MalformedForm)) as told:
        compiled(f"(setv n 3)\n(defn it [] {form.replace('{}', code)})")
    assert (
        f"{code} is not evaluated in a designator ({kind}): only ?variables are. "
        f"Write (let [?value {value or code}] ...) around it, and ?value in its place."
    ) in str(told.value)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("code", "text"),
    [
        ("~n", "~n is evaluated in a template only, behind a backquote: `(a ~b)"),
        ("?pose.x", "?pose.x is no Lisp data: attributes are not evaluated in it; give the value a variable first"),
        ("#{1 2}", "sets are no Lisp data; write a list, a name, a keyword, a string or a number"),
        ("{1 2}", "dicts are no Lisp data; write a list, a name, a keyword, a string or a number"),
        ('f"{n}"', "f-strings are no Lisp data; write a list, a name, a keyword, a string or a number"),
        ('b"a"', "bytes are no Lisp data; write a list, a name, a keyword, a string or a number"),
    ],
)
@pytest.mark.parametrize("form", ["(def-fact-group rooms [] (<- (room {})))", "(defn it [] (prolog '(room {})))"])
def test_code_in_a_fact_or_a_quoted_goal_is_refused(form, code, text):
    with pytest.raises((HySyntaxError, MalformedForm)) as told:
        compiled(form.replace("{}", code))
    assert text in str(told.value)


def test_variables_lists_and_templates_are_as_before():
    module = compiled(
        "(setv ?n 4 places [1 2])\n"
        "(setv d (a motion (type driving) (goal #(1 ?n))))\n"
        "(setv found (len (force-ll (prolog `(member ?x ~places)))))\n"
        "(setv goal (desig-prop-value d :goal))"
    )
    assert module.found == 2 and module.goal == [1, 4]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("form", "one", "other"),
    [
        ("(a motion (x ?A) (y ?a))", "?A", "?a"),
        ("(an object (type cup) (Type spoon))", "type", "Type"),
        ("(prolog '(and (member ?A (1 2)) (member ?a (2 3))))", "?A", "?a"),
        ("(prolog `(member ?x (Cup ~n [cup])))", "Cup", "cup"),
        ("(def-fact-group cases [] (<- (pair ?A ?a) (member ?A (1))))", "?A", "?a"),
        ("(rete-assert '(on Cup cup))", "Cup", "cup"),
    ],
)
def test_names_in_data_that_differ_by_case_only_are_refused(form, one, other):
    with pytest.raises((HySyntaxError, MalformedForm)) as told:
        compiled(f"(setv n 3)\n(defn it [?A ?a] {form})")
    assert f"{one} and {other} differ by case only, and to Lisp they are one name; give one of them another name" in str(told.value)


def test_names_in_two_clauses_and_in_code_may_differ_by_case():
    assert compiled("(def-fact-group cases [] (<- (pair ?A) (member ?A (1))) (<- (pair ?a) (member ?a (2))))")
    assert compiled("(setv X 1 x 2 found (prolog `(member ?y (~X ~x))))").found is not None
