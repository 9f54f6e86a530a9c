"""Keywords of Hy and Lisp are equal both ways, with equal hashes; who compares a keyword with the text of its name is told."""

import importlib
import types
import warnings

import hy
import pytest

import cramhy  # noqa: F401  teaches Hy's keywords
from cramhy_runtime.designators.python_grounding import _verdict
from cramhy_runtime.prolog import kw


def of_hy(name):
    return hy.models.Keyword(name)


@pytest.mark.parametrize(("name", "lisp"), [("driving", kw.driving), ("max-speed", kw.max_speed), ("Driving", kw.driving)])
def test_a_keyword_of_hy_is_equal_to_that_of_lisp_and_found_by_it(name, lisp):
    assert of_hy(name) == lisp and lisp == of_hy(name) and not of_hy(name) != lisp and not lisp != of_hy(name)
    assert hash(of_hy(name)) == hash(lisp)
    assert {of_hy(name): 1}[lisp] == {lisp: 1}[of_hy(name)] == 1 and lisp in {of_hy(name)} and lisp in [of_hy(name)]


def test_other_keywords_stay_different():
    assert of_hy("flying") != kw.driving and kw.driving != of_hy("flying") and of_hy("a") != of_hy("A") and of_hy("a") == of_hy("a")
    assert kw.driving not in {of_hy("flying"): 1} and of_hy("a") != "a" and kw.driving != kw.flying and kw.driving is not None


@pytest.mark.parametrize("text", ["MAX-SPEED", "max_speed", ":max-speed"])
def test_a_keyword_beside_the_text_of_its_name_is_told(text):
    with pytest.warns(RuntimeWarning) as told:
        assert not kw.max_speed == text
    assert str(told[0].message) == (
        f"A keyword is no string: :MAX-SPEED == {text!r} is false. Write kw.max_speed, from cramhy_runtime.prolog, or :max-speed in Hy."
    )
    assert told[0].filename == __file__


def test_a_keyword_beside_another_text_is_not_told():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert kw.driving != "flying" and "x" != kw.driving and kw.driving != 3


def compiled(text):
    module = types.ModuleType("keywords_of_hy")
    ready = """(require cramhy *)
(import cramhy_runtime.prolog [P V kw findall fact-group] cramhy_runtime.designators [Motion property-values])
(setv k ':table ?k k)"""
    hy.eval(hy.read_many(f"{ready}\n{text}"), module=module, locals=module.__dict__)
    return module


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "made",
    [
        "(desig-prop-value (a motion (type ?k)) :type)",
        "(. (a motion (type ?k)) type)",
        "(desig-prop-value (a motion (sides [left ?k])) :sides)",
        "(. (Motion :type k) type)",
        "(get (Motion :type k) :type)",
        "(get (property-values (Motion :type k) ':type) 0)",
        "(. (make-fluent :value k) value)",
        "(do (setv f (make-fluent :value 1)) (setv f.value k) f.value)",
        "(var-value '?x (get (prolog `(== ?x ~k)) 0))",
        "(get (findall V.x (P.member V.x [k])) 0)",
        '(do (with [g (fact-group "places")] (.fact g (P.at 1 k))) (get (findall V.x (P.at 1 V.x)) 0))',
        "(do (rete-assert `(at cup ~k)) (var-value '?x (get (rete-holds '(at cup ?x)) 0)))",
        "(do (defn kind [] k) (def-fact-group kinds [] (<- (kind ?k) (lisp-fun kind ?k))) (var-value '?x (get (prolog '(kind ?x)) 0)))",
    ],
)
def test_where_lisp_gets_a_keyword_of_hy_it_is_lisps(made):
    found = compiled(f"(setv it {made} same (= it :table) also (= it kw.table))")
    it = found.it[-1] if "sides" in made else found.it
    assert it is kw.table and (found.same is found.also is True or "sides" in made)


def test_lisp_compares_what_hy_has_put_into_a_fluent():
    text = """(setv seen [] door (make-fluent :value ':open))
(top-level (par (do (wait-for (eql door ':closed)) (.append seen "closed")) (do (sleep 1) (setv door.value ':closed))))"""
    assert compiled(text).seen == ["closed"]


MATCH = """(require cramhy *)
(setv d (a motion (type driving) (arm left-arm) (max-speed :as_is)))
(setv found [
  (match (desig-prop-value d :type) :flying 1 :driving 2 _ 3)
  (match (desig-prop-value d :arm) (| :right-arm :left-arm) "arm" _ "no")
  (match [(desig-prop-value d :type) 1] [:driving n] n _ None)
  (match {"type" (desig-prop-value d :type)} {"type" :driving} True _ False)
  (match ':driving :driving 1 _ 2)
  (match ':max_speed :max-speed 1 :max_speed 2)
  (match "driving" :driving 1 _ 2)
  (match (desig-prop-value d :type) :driving :as it it)])
"""


def test_match_finds_keywords_of_lisp(tmp_path, monkeypatch):
    (tmp_path / "keywords_in_match.hy").write_text(MATCH)
    monkeypatch.syspath_prepend(tmp_path)
    found = importlib.import_module("keywords_in_match").found
    assert found == [2, "arm", 1, True, 1, 2, 2, kw.driving]


def test_a_validator_may_answer_with_a_keyword_of_hy_and_a_text_is_refused_without_a_warning():
    assert _verdict(of_hy("accept")) is kw.accept
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(TypeError, match="not 'accept'"):
            _verdict("accept")
