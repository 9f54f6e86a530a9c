"""Tracing of fluents: projection-and-events.md C2, C3."""

import pytest

FLUENTS = """
(defvar *pose* (make-fluent :name 'pose :value 0))
(def-top-level-cram-function drive () (setf (value *pose*) 1) (sleep 2) (setf (value *pose*) 2) (sleep 3) (setf (value *pose*) 3) :there)
(defun changes (name) (cet:episode-knowledge-fluent-changes name cet:*last-episode-knowledge*))
(defun durations (name) (cet:episode-knowledge-fluent-durations name cet:*last-episode-knowledge*))
(defun names () (cet:episode-knowledge-traced-fluent-names cet:*last-episode-knowledge*))
"""


@pytest.fixture
def fluents(lisp):
    lisp(FLUENTS)
    return lisp


@pytest.mark.law("projection-and-events", 22)
def test_tracing_is_off_at_first_and_lists_changes_in_order_when_on(fluents):
    assert fluents("(list (cet:fluent-tracing-enabled) (progn (drive) (names)))") == "(NIL NIL)"
    fluents("(setf (value *pose*) 0)")
    assert fluents("(list (cet:enable-fluent-tracing) (cet:fluent-tracing-enabled))") == "(T T)"
    fluents("(drive)")
    assert fluents("(changes 'pose)") == "((0 . 5.0d0) (1 . 5.0001d0) (2 . 7.0d0) (3 . 10.0d0))"
    assert fluents("(list (cet:disable-fluent-tracing) (cet:fluent-tracing-enabled) (progn (drive) (names)))") == "(NIL NIL NIL)"


@pytest.mark.law("projection-and-events", 23)
def test_durations_partition_the_time_and_the_last_ends_at_the_max_time(fluents):
    fluents("(cet:enable-fluent-tracing) (drive)")
    assert fluents("(durations 'pose)").replace("CRAM-EXECUTION-TRACE:", "") == (
        "((0 THROUGHOUT 0.0d0 1.0d-4) (1 THROUGHOUT 1.0d-4 2.0d0) (2 THROUGHOUT 2.0d0 5.0d0) (3 THROUGHOUT 5.0d0 5.1d0))"
    )
    assert fluents("(cet:episode-knowledge-max-time cet:*last-episode-knowledge*)") == "5.1d0"


def test_nothing_changes_in_a_fluent_by_its_being_traced(fluents):
    fluents("(cet:enable-fluent-tracing) (drive)")
    assert fluents("(list (cut:current-timestamp) (get-update-callback *pose* 'trace))") == "(5.0d0 NIL)"


@pytest.mark.law("projection-and-events", 22)
def test_many_changes_at_one_moment_have_increasing_times_within_the_millisecond(fluents):
    fluents("(cet:enable-fluent-tracing) (top-level (dotimes (i 50) (setf (value *pose*) (list i))))")
    assert (
        fluents("""(let ((times (mapcar #'cdr (changes 'pose))))
                        (list (length times) (apply #'< times) (< (car (last times)) 0.001d0)))""")
        == "(51 T T)"
    )


def test_a_pulse_is_recorded_though_the_value_is_the_same(fluents):
    fluents("(cet:enable-fluent-tracing) (top-level (sleep 1) (pulse *pose*))")
    assert fluents("(changes 'pose)") == "((0 . 0.0d0) (0 . 1.0d0))"


def test_fluents_that_a_plan_makes_are_traced_from_their_making_in_that_plan_only(fluents):
    fluents("""(cet:enable-fluent-tracing)
               (top-level (sleep 1) (let ((fluent (make-fluent :name 'gripper :value :open))) (sleep 1) (setf (value fluent) :shut)))
               (note (changes 'gripper)) (drive) (note (member 'gripper (names)))""")
    assert fluents("(notes)") == "(((:OPEN . 1.0d0) (:SHUT . 2.0d0)) NIL)"


def test_a_global_fluent_made_later_is_traced_too_also_by_the_plan_that_runs(fluents):
    fluents("""(cet:enable-fluent-tracing)
               (defvar *bumper* (make-fluent :name 'bumper)) (drive) (note (changes 'bumper))""")
    assert fluents("(notes)") == "(((NIL . 0.0d0)))"


@pytest.mark.law("projection-and-events", 25)
def test_the_statuses_of_tasks_are_traced_from_their_making(fluents):
    fluents("""(cet:enable-fluent-tracing)
               (top-level (with-tags (sleep 1) (:tag grasp (sleep 2))))
               (let ((tag (cet:episode-knowledge-task-tree cet:*last-episode-knowledge*)))
                 (dolist (change (changes (cpl-impl:name (task-tree-node-status-fluent tag)))) (note change)))""")
    assert fluents("(notes)") == "((:CREATED . 0.0d0) (:RUNNING . 1.0d0) (:SUCCEEDED . 3.0d0))"


def test_a_fluent_may_be_kept_out(fluents):
    fluents("""(defvar *secret* (make-fluent :name 'secret :value 1 :allow-tracing nil))
               (cet:enable-fluent-tracing)
               (defvar *other* (make-fluent :name 'other :value 1 :allow-tracing nil))
               (top-level (setf (value *secret*) 2 (value *other*) 2))""")
    assert fluents("(remove-if-not (lambda (name) (member name '(pose secret other))) (names))") == "(POSE)"


def test_a_limit_of_frequency_records_so_many_changes_a_second_and_the_last_one(fluents):
    fluents("""(defvar *laser* (make-fluent :name 'laser :value 0 :max-tracing-freq 2))
               (cet:enable-fluent-tracing)
               (top-level (dotimes (i 10) (sleep 0.125) (setf (value *laser*) (1+ i))))""")
    assert fluents("(changes 'laser)") == "((0 . 0.0d0) (4 . 0.5d0) (8 . 1.0d0) (10 . 1.25d0))"


def test_fluents_of_one_name_are_merged_and_strings_are_names(fluents):
    fluents("""(cet:enable-fluent-tracing)
               (top-level (let ((a (make-fluent :name 'arm :value 1)) (b (make-fluent :name 'arm :value 2))
                                (c (make-fluent :name "leg" :value 3)))
                            (sleep 1) (setf (value b) 3 (value a) 4 (value c) 5)))""")
    assert fluents("(mapcar #'car (changes 'arm))") == "(1 2 3 4)"
    assert fluents('(changes "leg")') == "((3 . 0.0d0) (5 . 1.0d0))"


def test_unnamed_fluents_are_told_apart(fluents):
    fluents(
        """(cet:enable-fluent-tracing)
               (top-level (let ((a (make-fluent :value 1)) (b (make-fluent :value 2))) (setf (value a) 3 (value b) 4)
                            (note (mapcar #'car (changes-of a)) (mapcar #'car (changes-of b)))))
            """.replace("(changes-of a)", "(cet:episode-knowledge-fluent-changes (cpl-impl:name a))").replace(
            "(changes-of b)", "(cet:episode-knowledge-fluent-changes (cpl-impl:name b))"
        )
    )
    assert fluents("(notes)") == "(((1 3) (2 4)))"


def test_values_are_copied_one_level_deep_and_by_methods_of_the_users(fluents):
    fluents("""(cet:enable-fluent-tracing)
               (defclass box () ((things :initarg :things :accessor things)))
               (defmethod cet:durable-copy ((box box)) (make-instance 'box :things (things box)))
               (top-level (let ((things (list 1 2)) (box (make-instance 'box :things 1)))
                            (setf (value *pose*) things) (setf (first things) 100) (pulse *pose*)
                            (setf (value *pose*) box) (setf (things box) 2) (pulse *pose*)))""")
    assert fluents("(mapcar (lambda (change) (if (typep (car change) 'box) (things (car change)) (car change))) (changes 'pose))") == (
        "(0 (1 2) (100 2) 1 2)"
    )
    assert fluents("(list (cet:durable-copy '(1 . 2)) (cet:durable-copy nil) (cet:durable-copy 7))") == "((1 . 2) NIL 7)"


def test_tracing_may_be_switched_on_and_off_within_a_plan(fluents):
    fluents("""(top-level (setf (value *pose*) 1) (sleep 1) (cet:enable-fluent-tracing) (sleep 1) (setf (value *pose*) 2) (sleep 1)
                          (cet:disable-fluent-tracing) (setf (value *pose*) 3))""")
    assert fluents("(changes 'pose)") == "((1 . 1.0d0) (2 . 2.0d0))"


def test_the_trace_of_a_plan_that_failed_ends_with_it(fluents):
    assert fluents.error('(progn (cet:enable-fluent-tracing) (top-level (setf (value *pose*) 7) (fail "lost")))') == "lost"
    fluents("(setf (value *pose*) 8)")
    assert fluents("(changes 'pose)") == "((0 . 0.0d0) (7 . 1.0d-4))"


def test_a_traced_fluent_tells_name_value_and_time(fluents):
    fluents("(defvar *record* (make-instance 'cet:traced-fluent :name 'pose :traced-value 5 :timestamp 2.0d0))")
    assert fluents("(list (cet:name *record*) (cet:traced-value *record*) (cet:timestamp *record*))") == "(POSE 5 2.0d0)"


@pytest.mark.parametrize("query", ["changes", "durations"])
def test_an_unknown_fluent_is_a_warning_with_the_nearest_name(fluents, query):
    fluents("(cet:enable-fluent-tracing) (top-level (sleep 1)) (cet:disable-fluent-tracing)")
    asked = "(cet:with-last-episode-knowledge (warnings-of (note (cet:episode-knowledge-fluent-{} '{}))))"
    assert fluents(asked.format(query, "poes")) == '("No fluent named POES was traced in this episode. Did you mean POSE?")'
    assert fluents(asked.format(query, "laser-scanner")).startswith(
        '("No fluent named LASER-SCANNER was traced in this episode. Traced were '
    )  # fluents of other tests may live still
    assert fluents("(notes)") == "(NIL NIL)"


def test_the_warning_tells_of_tracing_that_is_off(fluents):
    fluents("(drive)")
    assert fluents("(cet:with-last-episode-knowledge (warnings-of (cet:episode-knowledge-fluent-changes 'pose)))") == (
        '("No fluent named POSE was traced in this episode. Nothing was traced: call (enable-fluent-tracing) before the plan.")'
    )


# ------------------------------------------------------------------------------------------------------------ auto tracing


def files(folder):
    return sorted(path.name for path in folder.glob("traces/*"))


@pytest.mark.law("projection-and-events", 27)
def test_auto_tracing_writes_a_file_for_each_plan_with_time_and_name(fluents, tmp_path):
    assert fluents('(cet:setup-auto-tracing "traces" :ensure-directory t)') == "T"
    assert fluents("(list (cet:auto-tracing-enabled) (cet:fluent-tracing-enabled))") == "(T T)"
    fluents("(drive) (top-level (setf (value *pose*) 1)) (top-level 2)")
    assert files(tmp_path) == ["20101218161114-DRIVE.ek", "20101218161114-NIL-1.ek", "20101218161114-NIL.ek"]
    assert fluents("""(cet:with-offline-episode-knowledge "traces/20101218161114-DRIVE.ek"
                        (list (cet:episode-knowledge-fluent-changes 'pose)
                              (task-tree-node-result (cet:episode-knowledge-task-tree))))""") == (
        "(((0 . 0.0d0) (1 . 1.0d-4) (2 . 2.0d0) (3 . 5.0d0)) :THERE)"
    )
    assert fluents("(list (cet:disable-auto-tracing) (cet:auto-tracing-enabled))") == "(NIL NIL)"
    fluents("(drive)")
    assert len(files(tmp_path)) == 3


@pytest.mark.law("projection-and-events", 27)
def test_names_of_files_have_no_strange_characters_and_failed_plans_are_saved(fluents, tmp_path):
    fluents('(cet:setup-auto-tracing "traces/" :ensure-directory t) (def-top-level-cram-function |Go /home!| () (fail "no"))')
    fluents.error("(|Go /home!|)")
    assert files(tmp_path) == ["20101218161109-Go__home_.ek"]


def test_a_directory_that_is_not_there(fluents, tmp_path):
    assert fluents.error('(cet:set-auto-tracing-directory "nowhere/")') == (
        'Pathspec #P"nowhere/" does not designate a valid path for auto tracing.'
    )
    assert fluents.error("(cet:enable-auto-tracing)") == (
        "The value NIL is not of type PATHNAME (Auto tracing needs a directory: call (set-auto-tracing-directory path) before, or "
        "(setup-auto-tracing path).)"
    )


def test_a_plan_does_not_suffer_from_a_directory_that_vanished(fluents, tmp_path):
    fluents('(cet:setup-auto-tracing "traces" :ensure-directory t)')
    (tmp_path / "traces").rmdir()
    (warning,) = [fluents("(first (warnings-of (note (drive))))")]
    assert warning.startswith('"The episode of the plan could not be saved in ') and fluents("(notes)") == "(:THERE)"
