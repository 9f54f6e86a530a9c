"""Functions that are generic in CRAM, on its branch master or devel, and plain functions of Python here: users define methods on them."""

from __future__ import annotations

import pytest

GENERIC = {
    "CPL-IMPL": "child-tasks composite-failures envelop-error execute fail name parent-task task-constraints value pulse",
    "CPL": "parameters",
    "CPM": "caller cancel input",
    "CUT": "pool-value new-pool-value delete-pool-value (setf pool-value)",
    "EXE": "try-reference-designator",
    "LOCATION-COSTMAP": "2d-value-map-lookup cost-functions costmap-samples gen-costmap-sample-point generator-function generator-name"
    " get-cost-map get-map-value grid-height grid-width height origin-x origin-y register-cost-function register-height-generator"
    " register-orientation-generator resolution width",
}
NAMES = [
    f"(setf {package}::{name[6:]}" if name.startswith("(setf") else f"{package}::{name}"
    for package, names in GENERIC.items()
    for name in names.replace("(setf ", "(setf_").split()
]


@pytest.mark.soak
def test_each_of_them_is_a_generic_function(values):
    pytest.importorskip("mujoco", reason="the costmaps need the extra robot")
    names = " ".join(NAMES)
    values('(asdf:load-system "cram-location-costmap")')
    assert values(f"(remove-if (lambda (name) (typep (fdefinition name) 'generic-function)) '({names}))") == "NIL"


def test_a_method_on_fail_hears_of_each_failure(values):
    text = """(let (seen)
      (defmethod cpl:fail :before (&rest arguments) (push (first arguments) seen))
      (cpl:top-level (cpl:with-failure-handling ((cpl:plan-failure (f) (declare (ignore f)) (return))) (cpl:fail 'cpl:plan-failure)))
      seen)"""
    assert values(text) == "(CRAM-LANGUAGE-IMPLEMENTATION:PLAN-FAILURE)"


def test_a_method_on_fail_hears_of_failures_that_cramhy_signals_itself(values):
    text = """(let (seen)
      (defmethod cpl:fail :before (&rest arguments) (push (type-of (first arguments)) seen))
      (defmethod exe:try-reference-designator :after ((designator t) &optional (text "")) (push text seen))
      (defmethod exe:try-reference-designator :before ((designator t) &optional (text "")) (push (if (string= text "") :action text) seen))
      (cpl:top-level (cpl:with-failure-handling ((cpl:plan-failure (f) (declare (ignore f)) (return)))
        (exe:perform (desig:an action (type no-such-thing)))))
      (reverse seen))"""
    assert values(text) == "(:ACTION CRAM-EXECUTIVE:DESIGNATOR-REFERENCE-FAILURE)"


def test_a_method_on_a_reader_of_the_plan_language_is_for_classes_of_ones_own(values):
    text = """(defclass robot () ((called :initarg :called :reader cpl-impl:name)))
      (list (cpl-impl:name (make-instance 'robot :called "Armin")) (cpl-impl:name (cpl:make-fluent :name :f)))"""
    assert values(text) == '("Armin" :F)'
