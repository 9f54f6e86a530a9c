"""Keywords of Hy and Lisp are equal both ways, with equal hashes; who compares a keyword with the text of its name is told."""

import warnings

import hy
import pytest

import cramhy  # noqa: F401  teaches Hy's keywords
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
