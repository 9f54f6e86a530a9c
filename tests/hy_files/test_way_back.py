"""``(in-hy)`` leads back also behind a form of Lisp that can only be read when the forms before it have run."""

from __future__ import annotations

import pytest

LISP = """(in-package :cl-user)
(py:import math)
(defvar *r* (math:sqrt 16))
{}
(in-hy)
(setv answer {})"""


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "more",
    ["", ";; (in-hy)", '(defvar *s* "\n(in-hy)\n")', "#| \n(in-hy)\n|#", "(defvar *t* '(a\n(in-hy)\n))"],
    ids=["nothing", "comment", "string", "block comment", "data"],
)
def test_hy_goes_on_behind_a_form_that_is_read_late(load, more):
    assert load(LISP.format(more, "(+ 1 1)")).answer == 2


def test_lisp_may_come_again(load):
    module = load(
        LISP.format("", "3") + "\n(in-package :cl-user)\n(defvar *u* (+ *r* 1))\n(in-hy)\n(setv more (. (lisp cl-user::*u*) value))"
    )
    assert (module.answer, module.more) == (3, 5.0)


def test_a_wrong_form_is_told_when_its_turn_comes(load):
    with pytest.raises(Exception, match="NOWHERE"):
        load(LISP.format("(nowhere:nothing)", "3"))
