"""Saving and loading episodes: projection-and-events.md C1. A file of somebody else's is text, and runs no code."""

import json

import pytest
from systems import SOAK

from cramhy_runtime.languages.commonlisp.faces.episodes.values_on_file import BadFile, Reader, Writer
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

PLANS = """
(defvar *pose* (make-fluent :name 'pose :value 0))
(declare-goal reach (where)) (def-goal (reach ?where) (sleep 1) (setf (value *pose*) (list ?where 1.5d0 1.5 "text" #\\a 1/2)) ?where)
(def-cram-function drop (thing) (sleep 2) (fail "~a dropped" thing))
(def-top-level-cram-function fetch () (reach 'shelf) (with-failure-handling ((plan-failure (f) (declare (ignore f)) (return 1)))
                                                       (drop 'cup)))
(cet:enable-fluent-tracing)
(fetch)
(defun told (&optional (episode cet:*episode-knowledge*))
  (list (cet:episode-knowledge-zero-time episode) (cet:episode-knowledge-max-time episode)
        (cet:episode-knowledge-fluent-changes 'pose episode)
        (mapcar (lambda (node) (list (task-tree-node-path node) (value (task-tree-node-status-fluent node))
                                     (if (typep (task-tree-node-result node) 'condition)
                                         (princ-to-string (task-tree-node-result node)) (task-tree-node-result node))
                                     (task-tree-node-parameters node)
                                     (mapcar #'car (cet:episode-knowledge-fluent-changes
                                                     (cpl-impl:name (task-tree-node-status-fluent node)) episode))))
                (cet:episode-knowledge-task-list episode))
        (mapcar #'goal-task-tree-node-goal (cet:episode-knowledge-goal-task-list episode))))
"""


@pytest.fixture
def saved(lisp):
    lisp(PLANS)
    lisp('(cet:save-last-episode-knowledge "fetch.ek")')
    return lisp


@pytest.mark.law("projection-and-events", 26)
def test_an_episode_that_was_saved_and_loaded_tells_the_same(saved):
    before = saved("(told cet:*last-episode-knowledge*)")
    assert '(SHELF 1.5d0 1.5 "text" #\\a 1/2)' in before and '"CUP dropped"' in before and "(REACH SHELF)" in before
    assert saved('(cet:with-offline-episode-knowledge "fetch.ek" (told))') == before
    assert saved('(cet:load-episode-knowledge "fetch.ek")') == "#<CRAM-EXECUTION-TRACE:OFFLINE-EPISODE-KNOWLEDGE FETCH {}>"


@pytest.mark.law("projection-and-events", 26)
def test_a_loaded_episode_can_be_saved_again(saved):
    saved('(cet:save-episode-knowledge "again.ek" (cet:load-episode-knowledge "fetch.ek"))')
    assert saved('(cet:with-offline-episode-knowledge "again.ek" (told))') == saved("(told cet:*last-episode-knowledge*)")


def test_the_current_episode_is_saved_also_to_streams(saved):
    assert (
        saved("""(cet:with-last-episode-knowledge
                      (let ((text (with-output-to-string (stream) (cet:save-episode-knowledge stream))))
                        (with-input-from-string (stream text) (equal (told) (told (cet:load-episode-knowledge stream))))))""")
        == "T"
    )


def test_a_file_that_is_there_is_not_overwritten_unless_asked_for(saved, tmp_path):
    assert "already exists" in saved.error('(cet:save-last-episode-knowledge "fetch.ek")')
    assert "already exists" in saved.error('(cet:save-episode-knowledge "fetch.ek" cet:*last-episode-knowledge*)')
    saved("(top-level 1)")
    saved('(cet:save-last-episode-knowledge "fetch.ek" :if-exists :supersede)')
    assert saved('(cet:load-episode-knowledge #P"fetch.ek")').endswith("NIL {}>")
    saved('(top-level (cet:save-episode-knowledge "fetch.ek" :if-exists :supersede))')
    assert saved('(warnings-of (cet:with-offline-episode-knowledge #P"fetch.ek" (cet:episode-knowledge-zero-time)))') == "NIL"
    assert saved.error('(cet:save-last-episode-knowledge "x.ek" :if-exist :supersede)') == "unknown &KEY argument: :IF-EXIST"


def test_what_cannot_be_saved_leaves_the_old_file_as_it_was(saved, tmp_path):
    old = (tmp_path / "fetch.ek").read_text()
    saved("""(defclass box () ())
             (cet:defstore-episode-knowledge-backend (box box stream) (error "no way"))
             (top-level (setf (value *pose*) (make-instance 'box)))""")
    assert saved.error('(cet:save-last-episode-knowledge "fetch.ek" :if-exists :supersede)') == "no way"
    assert (tmp_path / "fetch.ek").read_text() == old


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "text",
    [
        "nil",
        "t",
        ":key",
        "'car",
        "'here",
        "'|Go home|",
        "'(1 2 . 3)",
        "'(nil (nil))",
        "1.5",
        "1.5d0",
        "-0.0",
        "(expt 10 30)",
        "1/3",
        "#c(1 2)",
        "#c(1.0d0 2)",
        '"a\\"b"',
        "#\\Space",
        "#(1 #(2) a)",
        "''x",
        "(/ 11.0 3)",
        "(* 2 (atan 1d0))",
        "(list 1e38 -1e38)",
        "(make-array 3 :initial-element 1 :adjustable t)",
    ],
)
def test_values_come_back_as_they_were(lisp, text):
    (value,) = lisp.session.evaluate_text(text)
    again = Reader().read(json.loads(json.dumps(Writer().write(value))))
    assert prin1_to_string(again) == prin1_to_string(value) and type(again).__name__ in (type(value).__name__, "list")


def read_again(lisp, text, shown):
    """What ``shown`` prints of the variable ``*it*``, the value of ``text`` after it was written and read."""
    (value,) = lisp.session.evaluate_text(text)
    lisp("(defvar *it* nil)")
    lisp.session.package.intern("*IT*").value = Reader().read(json.loads(json.dumps(Writer().write(value))))
    return lisp(shown)


def test_objects_come_back_with_their_slots_and_are_not_initialised(lisp):
    lisp("""(defclass box () ((size :initarg :size :accessor size) (lid :initarg :lid)))
            (defmethod initialize-instance :after ((box box) &key) (note :initialised))
            (defstruct cup (full t) owner)
            (define-condition leak (error) ((what :initarg :what :reader what))
              (:report (lambda (c s) (format s "~a leaks" (what c)))))""")
    assert read_again(lisp, "(make-instance 'box :size 3)", "(list (size *it*) (slot-boundp *it* 'lid) (notes))") == (
        "(3 NIL (:INITIALISED))"
    )
    assert read_again(lisp, "(make-cup :owner 'me)", "*it*") == "#S(CUP :FULL T :OWNER ME)"
    assert read_again(lisp, "(make-condition 'leak :what 'cup)", '(format nil "~a ~a" *it* (typep *it* \'leak))') == '"CUP leaks T"'
    assert (
        read_again(lisp, "(make-condition 'simple-error :format-control \"a ~a\" :format-arguments '(b))", "(princ-to-string *it*)")
        == '"a B"'
    )
    assert read_again(lisp, '(make-condition \'simple-plan-failure :format-control "c")', "(princ-to-string *it*)") == '"c"'
    assert (
        read_again(
            lisp,
            "(cl-transforms:make-pose (cl-transforms:make-3d-vector 1 2 3) (cl-transforms:make-identity-rotation))",
            "(cl-transforms:y (cl-transforms:origin *it*))",
        )
        == "2.0d0"
    )
    assert read_again(lisp, "(desig:a motion (type driving) (speed 5))", "(desig:desig-prop-value *it* :speed)") == "5"
    assert read_again(lisp, '(roslisp:make-msg "turtlesim/Pose" :x 1.5)', "(turtlesim-msg:x *it*)") == "1.5"


def test_tables_functions_lazy_lists_and_circles(lisp):
    assert read_again(lisp, '(let ((h (make-hash-table :test \'equal))) (setf (gethash "a" h) 1) h)', '(gethash "a" *it*)') == "1 ; T"
    assert read_again(lisp, "#'car", "*it*") == "#'CAR"
    lazy = "(let ((all (cut:lazy-list ((i 0)) (cut:cont i (1+ i))))) (cut:lazy-elt all 2) all)"
    assert read_again(lisp, lazy, "*it*") == "(0 1 2)"
    assert read_again(lisp, "(let ((l (list 1 2))) (setf (cdr (last l)) l) l)", "*it*") == "(1 2 . #<the list goes round>)"
    assert read_again(lisp, "(let ((v (vector 1 nil))) (setf (aref v 1) v) v)", "(eq *it* (aref *it* 1))") == "T"
    assert (
        read_again(
            lisp, "(let ((s (gensym))) (list s s (gensym)))", "(list (eq (first *it*) (second *it*)) (eq (first *it*) (third *it*)))"
        )
        == "(T NIL)"
    )
    assert read_again(lisp, "(let ((l nil)) (dotimes (i 5000) (setf l (list l))) l)", "(listp *it*)") == "T"


def test_what_is_no_data_is_written_as_it_prints(lisp):
    assert read_again(lisp, "(make-fluent :name 'pose :value 1)", "*it*") == "#<FLUENT POSE [1]>"
    assert read_again(lisp, "*standard-output*", "(stringp (princ-to-string *it*))") == "T"


def test_users_say_how_objects_are_written_and_read(saved):
    saved("""(defclass box () ((size :initarg :size :reader size)))
             (cet:defstore-episode-knowledge-backend (box box stream) (prin1 (list :box (size box)) stream))
             (cet:defrestore-episode-knowledge-backend (box stream) (make-instance 'box :size (second (read stream))))
             (top-level (setf (value *pose*) (make-instance 'box :size 7)))
             (cet:save-last-episode-knowledge "box.ek")""")
    size = '(size (car (second (cet:with-offline-episode-knowledge "box.ek" (cet:episode-knowledge-fluent-changes \'pose)))))'
    assert saved(size) == "7"


def test_a_backend_reads_no_code(saved, tmp_path):
    saved("""(defclass box () ())
             (cet:defstore-episode-knowledge-backend (box box stream) (write-string "#.(note :hacked)" stream))
             (cet:defrestore-episode-knowledge-backend (box stream) (read stream))
             (top-level (setf (value *pose*) (make-instance 'box)))
             (cet:save-last-episode-knowledge "box.ek")""")
    assert "*READ-EVAL*" in saved.error('(cet:load-episode-knowledge "box.ek")')
    assert saved("(notes)") == "NIL"


# ------------------------------------------------------------------------------------------------------------- broken files


def change(tmp_path, number, line):
    """Replace a line of the file, counted from 1."""
    lines = (tmp_path / "fetch.ek").read_text().splitlines()
    lines[number - 1] = line(lines[number - 1]) if callable(line) else line
    (tmp_path / "fetch.ek").write_text("\n".join(lines) + "\n")


REFUSED = "fetch.ek is not a file of an episode that could be loaded: line {}: {}."


def test_a_file_that_was_cut_off_anywhere_is_an_error(saved, tmp_path):
    text = (tmp_path / "fetch.ek").read_text()
    for length in (0, 1, 30, 100, len(text) // 2, len(text) - 14, len(text) - 3):
        (tmp_path / "fetch.ek").write_text(text[:length])
        assert saved.error('(cet:load-episode-knowledge "fetch.ek")').startswith(REFUSED.partition("{}")[0])
    end = text.rindex("\n", 0, -1) + 1
    (tmp_path / "fetch.ek").write_text(text[:end])
    assert saved.error('(cet:load-episode-knowledge "fetch.ek")') == (
        REFUSED.format(text.count("\n") - 1, "its end is missing: it was cut off")
    )


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "text, line, why",
    [
        ("hello\n", 1, "it does not begin with the head of an episode"),
        ('{"a":1}\n', 1, "it does not begin with the head of an episode"),
        ("", 1, "it does not begin with the head of an episode"),
        ("[1]\n", 1, "it is not part of an episode"),
        ('{"cramhy":"episode","version":7}\n', 1, "it is of version 7, and this cramhy reads version 1"),
        ('{"a":' + "[" * 100000, 1, "it is nested too deep"),
    ],
    ids=["text", "json", "empty", "list", "version", "deep"],
)
def test_a_foreign_file_is_an_error(saved, tmp_path, text, line, why):
    (tmp_path / "fetch.ek").write_text(text)
    assert saved.error('(cet:load-episode-knowledge "fetch.ek")') == REFUSED.format(line, why)
    assert saved("(length (cet:episode-knowledge-task-list cet:*last-episode-knowledge*))") == "3"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "value, why",
    [
        (
            {"symbol": "X", "in": "NO-SUCH-PACKAGE"},
            "it has a symbol X of the package NO-SUCH-PACKAGE, which does not exist here: load the system that defines it",
        ),
        ({"symbol": "NEW", "in": "COMMON-LISP"}, "it has a symbol NEW of the package COMMON-LISP, which has no such symbol"),
        (
            {"class": {"symbol": "NO-CLASS", "in": "CRAM-USER"}, "slots": []},
            "it has an object of the class CRAM-LANGUAGE-USER::NO-CLASS, which does not exist here: load the system that defines it",
        ),
        ({"class": {"symbol": "TASK", "in": "CRAM-LANGUAGE"}, "slots": []}, "objects of the class TASK cannot be read from files"),
        (
            {"class": {"symbol": "SIMPLE-ERROR", "in": "COMMON-LISP"}, "slots": [[{"symbol": "HINT", "in": "CRAM-USER"}, 1]]},
            "the class SIMPLE-ERROR has no slot",
        ),
        ({"backend": {"symbol": "BOX", "in": "CRAM-USER"}, "stored": "1"}, "it has an object of the type"),
        ({"same": 99}, "it refers to a thing, number 99, that was not there before"),
        ({"what": 1}, "{'what': 1} stands for no value"),
        ({"double": [1]}, "[1] stands where a number should be"),
        ({"ratio": [1, 0]}, "it is damaged"),
        ({"vector": 5}, "5 stands where a list"),
        ({"symbol": 5}, "5 stands where a text should be"),
        ({"double": "x"}, "it is damaged"),
        ({"table": "EVIL", "entries": []}, "there are no hash tables of the kind EVIL"),
        ({"character": ""}, None),
    ],
)
def test_a_damaged_value_is_an_error_that_names_the_line(saved, tmp_path, value, why):
    change(tmp_path, 3, lambda line: json.dumps({**json.loads(line), "result": value}))
    if why is None:
        saved('(cet:load-episode-knowledge "fetch.ek")')
        return
    told = saved.error('(cet:load-episode-knowledge "fetch.ek")').replace("CRAM-USER::", "CRAM-LANGUAGE-USER::")
    assert told.startswith(REFUSED.format(3, why).rstrip("."))


def test_missing_and_impossible_parts(saved, tmp_path):
    change(tmp_path, 3, lambda line: json.dumps({key: value for key, value in json.loads(line).items() if key != "status"}))
    assert saved.error('(cet:load-episode-knowledge "fetch.ek")') == REFUSED.format(3, "'status' is missing")
    change(tmp_path, 3, lambda line: json.dumps({**json.loads(line), "status": "FLYING"}))
    assert saved.error('(cet:load-episode-knowledge "fetch.ek")') == REFUSED.format(3, "a task has no status FLYING")


def test_a_file_that_is_not_there(saved):
    assert "does not exist" in saved.error('(cet:load-episode-knowledge "nowhere.ek")')


def test_random_damage_is_an_error_or_an_episode_and_never_more(saved, tmp_path):
    import random

    text = (tmp_path / "fetch.ek").read_text()
    chance = random.Random(5)
    from cramhy_runtime.languages.commonlisp.faces.episodes.files import read_episode
    from cramhy_runtime.lisp_core.conditions import SimpleError

    for _ in range(1500 if SOAK else 300):
        place, length = chance.randrange(len(text)), chance.randrange(4)
        damaged = text[:place] + chance.choice(['"', "[", "{", "7", "null", ",", "}", "x", ""]) + text[place + length :]
        try:
            read_episode(damaged, "damaged")
        except SimpleError as problem:
            assert problem.report().startswith("damaged is not a file of an episode that could be loaded: line ")


def test_reading_is_not_told_what_a_value_is_by_chance():
    with pytest.raises(BadFile):
        Reader().read(object())
