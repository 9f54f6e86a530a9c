"""Process modules of projections: projection-and-events.md A1, A4."""

import pytest

MODULES = """
(cpm:def-process-module real-arm (designator) (note :real) (sleep 1) :real)
(cpm:def-process-module imagined-arm (designator) (note :imagined) (sleep 1) :imagined)
(define-projection-environment imagined :process-module-definitions ((arm imagined-arm))
  :startup (note :startup (not (null (cpm:get-running-process-module 'arm)))))
(defun use (name) (cpm:pm-execute name (desig:a motion (type lifting))))
(defun running () (not (null (cpm:get-running-process-module 'arm))))
"""


@pytest.fixture
def modules(lisp):
    lisp(MODULES)
    return lisp


@pytest.mark.law("projection-and-events", 8)
def test_the_process_modules_run_during_startup_and_body_and_end_with_it(modules):
    modules("(with-projection-environment imagined (note :body (running)) (top-level (use 'arm)))")
    assert modules("(list (notes) (running))") == "(((:STARTUP T) (:BODY T) :IMAGINED) NIL)"


def test_the_projections_module_takes_the_place_of_the_real_one_of_that_name(modules):
    modules("""(cpm:with-process-modules-running ((arm real-arm) (other real-arm))
                 (with-projection-environment imagined (top-level (use 'arm) (use 'other)))
                 (top-level (use 'arm)))""")
    assert modules("(notes)") == "((:STARTUP T) :IMAGINED :REAL :REAL)"


def test_projections_side_by_side_each_have_their_own_modules(modules):
    modules("""(top-level (par (with-projection-environment imagined (use 'arm))
                               (with-projection-environment imagined (use 'arm))))""")
    assert modules("(list (notes) (cut:current-timestamp))") == "(((:STARTUP T) (:STARTUP T) :IMAGINED :IMAGINED) 1.0d0)"


def test_modules_see_the_environments_variables_and_of_special_projection_variables_the_outer_values(modules):
    modules("""(defvar *world* :real) (defvar *belief* :outer)
               (define-special-projection-variable *belief* :inner)
               (cpm:def-process-module eye (designator) (note *world* *belief* *projection-environment*))
               (define-projection-environment seen :special-variable-initializers ((*world* :imagined)) :process-module-definitions (eye))
               (with-projection-environment seen (note *belief*) (top-level (use 'eye)))""")
    assert modules("(notes)") == "(:INNER (:IMAGINED :OUTER SEEN))"


def test_modules_end_when_the_projection_is_evaporated(modules):
    modules("""(top-level (pursue (sleep 1) (with-projection-environment imagined (sleep 100))))
               (note (running))
               (with-projection-environment imagined (note (running)))""")
    assert modules("(notes)") == "((:STARTUP T) NIL (:STARTUP T) T)"


def test_a_module_that_does_not_exist_is_told_of_before_startup(modules):
    modules("(define-projection-environment wrong :process-module-definitions (leg) :startup (note :startup) :shutdown (note :shutdown))")
    assert modules.error("(with-projection-environment wrong (note :body))").startswith("Unknown process module: LEG")
    assert modules("(notes)") == "NIL"


def test_perform_in_a_projection_moves_no_robot(modules):
    modules("""(prolog:def-fact-group arms (desig:motion-grounding cpm:matching-process-module cpm:available-process-module)
                 (prolog:<- (desig:motion-grounding ?m (lift)) (desig:desig-prop ?m (:type :lifting)))
                 (prolog:<- (cpm:matching-process-module ?m real-arm) (desig:desig-prop ?m (:type :lifting)))
                 (prolog:<- (cpm:matching-process-module ?m arm) (desig:desig-prop ?m (:type :lifting)))
                 (prolog:<- (cpm:available-process-module real-arm) (prolog:symbol-value *projection-environment* nil))
                 (prolog:<- (cpm:available-process-module arm) (prolog:symbol-value *projection-environment* imagined)))
               (defun lift () (exe:perform (desig:a motion (type lifting))))
               (cpm:with-process-modules-running (real-arm)
                 (note (top-level (lift)))
                 (with-projection-environment imagined (note (top-level (lift)))))""")
    assert modules("(notes)") == "(:REAL :REAL (:STARTUP T) :IMAGINED :IMAGINED)"
