"""closer-mop, as cramhy contains it for those who have not the real one: its packages export what the real ones do (closer-mop 1.0)."""

import pytest

MISSING = """
(let ((missing '()))
  (asdf:load-system :closer-mop)
  (do-external-symbols (symbol {here} missing)
    (unless (eq :external (nth-value 1 (find-symbol (symbol-name symbol) {there})))
      (push symbol missing))))
"""


@pytest.mark.parametrize("here", [":closer-mop", ":common-lisp"])
def test_closer_common_lisp_exports_all_of(values, here):
    assert values(MISSING.format(here=here, there=":closer-common-lisp")) == "NIL"


@pytest.mark.parametrize("form", ["(c2cl:subclassp 'fixnum 'integer)", "(c2cl:classp (find-class 'fixnum))"])
def test_its_own_functions_are_in_closer_common_lisp(values, form):
    assert values(f'(progn (asdf:load-system :closer-mop) (eval (read-from-string "{form}")))') == "T"
