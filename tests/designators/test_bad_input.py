"""What users get wrong with designators, and what they are told: the whole texts, and that everything goes on afterwards."""

import pytest


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form, text, hint",
    [
        ("(register-location-generator 5 'gen)", "The name of a function is wanted, not 'GEN.",
         "Write the bare name of the function, without #': what it names is looked up at each use."),
        ("(register-location-validation-function 5 #'car)", "The name of a function is wanted, not #'CAR.",
         "Write the bare name of the function, without #': what it names is looked up at each use."),
        ('(register-location-generator "5" gen)', 'The priority of GEN is not an integer: "5".',
         "The priority comes first, then the name of the function. Lower priorities are asked earlier."),
        ("(register-location-validation-function 1.5 gen)", "The priority of GEN is not an integer: 1.5.",
         "The priority comes first, then the name of the function. Lower priorities are asked earlier."),
        ("(validate-location-designator-solution (a motion) 1)", "The value #<A MOTION> is not of type LOCATION-DESIGNATOR", None),
        ("(a motion (type . driving))", "The description of a designator contains a dotted list: (TYPE . DRIVING). Write lists as (element "
         "element ...), and remember that a dot between two spaces makes a pair.", None),
        ("(a 5 (x 1))", "The A form (A 5 (X 1)) is malformed: it has the wrong number of parts, or a part is not a list.",
         "It is written (a type (key value)...)."),
        ("(desig-prop-value 5 :speed)", "There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION "
         "CRAM-DESIGNATORS:DESCRIPTION (1)> when called with arguments (5). See also: The ANSI Standard, Section 7.6.6", None),
        ("(desig-prop-value (make-designator :motion '(:speed 5)) :speed)", "The value :SPEED is not of type LIST", None),
        ("(desig-prop-value (make-designator :motion '((:speed . 5))) :speed)", "The value 5 is not of type LIST", None),
        ("(reference)", "invalid number of arguments: 0", None),
        ("(reference 1 2 3)", "invalid number of arguments: 3", None),
        ("(copy-designator (make-instance 'designator))", "Designator type `NIL' undefined",
         "The types of designators are action, human, location, motion and object."),
    ],
)  # fmt: skip
def test_errors(lisp, form, text, hint):
    assert lisp.error(form) == text
    if hint is not None:
        assert lisp.hint(form) == hint
    assert lisp("(props (a motion (speed 1)))") == "((:SPEED 1))"


WARNINGS = {
    "(a motion (speed (+ 1 ?x)))": "; caught STYLE-WARNING:\n;   The value of speed is the list (+ 1 ?x): only ?variables in a designator are evaluated. To use what "
    "the call returns, write\n;     (let ((?speed (+ 1 ?x))) ... (speed ?speed) ...).\n",
    "(a motion (type 'driving))": "; caught STYLE-WARNING:\n;   The value of type is the list (quote driving). The parts of a designator are not evaluated, and "
    "need no quote.\n",
    "(a motion (test #'car))": "; caught STYLE-WARNING:\n;   The value of test is the list #'car: only ?variables in a designator are evaluated. To use what the "
    "call returns, write\n;     (let ((?test #'car)) ... (test ?test) ...).\n",
    '(a motion (type driving) (name "X") (name "X"))': '; caught STYLE-WARNING:\n;   The property (name "X") is there twice.\n',
}


@pytest.mark.parametrize("form", WARNINGS)
def test_what_looks_like_something_else_is_told_of_with_its_place(lisp, form, capsys):
    lisp(f"(let ((?x 2)) (declare (ignorable ?x)) {form})")
    told = capsys.readouterr().err
    assert told.startswith(WARNINGS[form])
    assert f"(let ((?x 2)) (declare (ignorable ?x)) {form})" in told and ";   at <repl" in told


@pytest.mark.parametrize("form", [
    "(a motion (type driving) (arm left) (arm right))", "(a motion (arms (left right)) (order (first second last)) (goal (1 2 0)))",
    "(a motion (goal (?x ?x 0)) (at (a location (list (x 1)))) (pose ((1 2) (3 4))))", "(a motion (speed (?x)) (pair (when 1 2)))",
])  # fmt: skip
def test_what_is_meant_as_it_is_written_is_not_warned_of(lisp, form, capsys):
    lisp(f"(let ((?x 2)) (declare (ignorable ?x)) {form})")
    assert capsys.readouterr().err == ""


def test_a_generator_that_raises_is_named_and_the_designator_stays_usable(lisp):
    lisp("""(defun gen (d) (declare (ignore d)) (error "no map"))
            (register-location-generator 5 gen)
            (defvar *d* (a location (name here)))""")
    assert lisp.error("(reference *d*)") == "no map"
    assert lisp.hint("(reference *d*)").startswith("in the location generator gen, for #<A LOCATION (NAME HERE)>, called at <repl ")
    assert lisp("(effective *d*)") == "NIL"
    assert lisp("(defun gen (d) (declare (ignore d)) (list 1)) (reference *d*)") == "1"


def test_a_lazy_list_that_fails_half_way_goes_on_where_it_was(lisp):
    lisp("""(defvar *broken* t)
            (defun gen (d) (declare (ignore d)) (lazy-list ((i 1)) (when (and *broken* (= i 2)) (error "no ~a" i)) (cont i (1+ i))))
            (register-location-generator 5 gen)
            (defvar *d* (a location (name here)))""")
    assert lisp("(reference *d*)") == "1"
    assert lisp.error("(next-solution *d*)") == "no 2"
    assert lisp.hint("(next-solution *d*)").startswith("in the location generator gen, for #<A LOCATION (NAME HERE)>")
    assert lisp("(setf *broken* nil) (reference (next-solution *d*))") == "2"


def test_a_validator_that_raises_is_named_and_sees_the_same_candidate_again(lisp):
    lisp("""(defun gen (d) (declare (ignore d)) (list 1 2)) (register-location-generator 5 gen)
            (defun val (d s) (declare (ignore d s)) (error "no scale")) (register-location-validation-function 5 val)
            (defvar *d* (a location (name here)))""")
    assert lisp.error("(reference *d*)") == "no scale"
    assert lisp.hint("(reference *d*)").startswith("in the location validator val, for #<A LOCATION (NAME HERE)>, called at <repl ")
    assert lisp("(defun val (d s) (declare (ignore d)) (note s) :accept) (list (reference *d*) *notes*)") == "(1 (1))"


@pytest.mark.parametrize("value", ["5", '"pose"', "#'car", "t"])
def test_a_generator_that_gives_no_list(lisp, value):
    lisp(f"(defun gen (d) (declare (ignore d)) {value}) (register-location-generator 5 gen)")
    shown = {"#'car": "#<FUNCTION CAR>", "t": "T"}.get(value, value)
    assert lisp.error("(reference (a location))") == f"The location generator GEN gave {shown}, which is not a list."
    assert lisp.hint("(reference (a location))").startswith(
        "A generator returns a list of candidates, lazy or not: (list candidate) for a single one, nil for none."
    )


def test_a_generator_that_nobody_defined(lisp):
    lisp("(register-location-generator 5 nowhere)")
    assert lisp.error("(reference (a location))").startswith("The function") and lisp("(first (list-location-generators))") == "NOWHERE"
    lisp("(delete-location-generator-function 'nowhere)")
    assert lisp.error("(reference (a location))") == "Unable to resolve designator `#<A LOCATION>'"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "generator, validator",
    [("(loop)", ":accept"), ("(lazy-list ((i 0)) (cont i (1+ i)))", ":reject"), ("(lazy-list ((i 0)) (next (1+ i)))", ":accept")],
)
def test_a_search_without_end_can_be_evaporated_and_begun_anew(lisp, generator, validator):
    lisp(f"""(defun gen (d) (declare (ignore d)) {generator}) (register-location-generator 5 gen)
             (defun val (d s) (declare (ignore d s)) {validator}) (register-location-validation-function 5 val)
             (setf *location-generator-max-retries* most-positive-fixnum)
             (defvar *d* (a location))""")
    try:
        assert lisp("(cpl:top-level (cpl:pursue (progn (note :searching) (reference *d*)) (progn (cpl:sleep 0) :enough)) *notes*)") == (
            "(:SEARCHING)"
        )
        assert lisp("(defun gen (d) (declare (ignore d)) (list 1)) (defun val (d s) (declare (ignore d s)) :accept) (reference *d*)") == "1"
    finally:
        lisp("(setf *location-generator-max-retries* 30)")


def test_a_value_that_cannot_be_printed_hides_no_error(lisp):
    lisp("""(defclass broken () ()) (defmethod print-object ((b broken) stream) (write-string "#<bro" stream) (error "not printable"))
            (defvar *d* (let ((?b (make-instance 'broken))) (a motion (type driving) (thing ?b) (things (1 ?b)) (speed 5))))""")
    assert lisp.text("(handler-case (reference *d*) (designator-error (e) (princ-to-string e)))") == (
        "Cannot resolve motion designator #<A MOTION\n    (TYPE DRIVING)\n    (THING #<error printing a BROKEN: not printable>)\n"
        "    (THINGS #<error printing a CONS: not printable>)\n    (SPEED 5)>."
    )


def test_a_description_that_is_no_list(lisp):
    lisp("(defvar *d* (make-designator :motion #'car))")
    assert lisp.error("(princ-to-string *d*)") == "The value #<FUNCTION CAR> is not of type LIST"
    assert lisp.error("(reference *d*)") == "Cannot resolve motion designator #<A MOTION #<FUNCTION CAR>>."
    assert lisp("(props *d*)") == "#<FUNCTION CAR>"


def test_a_designator_class_of_ones_own(lisp):
    lisp("""(register-designator-class tool tool-designator)
            (defclass tool-designator (object-designator) ((sharp :initarg :sharp :initform :very :reader sharp)))
            (defmethod initialize-instance :after ((d tool-designator) &key) (note (props d)))
            (defmethod resolve-designator ((d tool-designator) role) (list :tool (sharp d) role))""")
    assert lisp("(let ((d (a tool (type knife)))) (list (type-of d) (sharp d) (reference d) (effective d) *notes*))") == (
        "(TOOL-DESIGNATOR :VERY (:TOOL :VERY NIL) T (((:TYPE :KNIFE))))"
    )
    assert lisp.text("(prin1-to-string (copy-designator (all tools (type saw))))") == "#<A TOOL\n    (TYPE SAW)>"
    assert lisp("(list (typep (a tool) 'designator-id-mixin) (typep (make-instance 'designator) 'equate-notification-mixin))") == "(T NIL)"
    assert lisp("(type-of (extend-designator-properties (a tool (type saw)) '((:n 1))))") == "TOOL-DESIGNATOR"


def test_readers_are_open_to_classes_of_ones_own(lisp):
    lisp("""(defclass happening () ((at :initarg :at :reader timestamp) (text :initform "x" :reader description)))
            (defvar *h* (make-instance 'happening :at 7))""")
    assert lisp("(list (timestamp *h*) (description *h*) (timestamp (a motion)) (description (a motion (n 1))))") == (
        '(7 "x" NIL ((:N 1)))'
    )


def test_predicates_with_a_time_give_each_member_of_the_chain_once(lisp):
    lisp("""(defvar *d* (a motion (k 1) (k 2))) (defvar *e* (a motion (k 3)))
            (setf (slot-value *d* 'desig::timestamp) 5 (slot-value *d* 'data) 'one (slot-value *e* 'data) 'two)
            (equate *d* *e*)""")
    assert lisp("(answers `(desig-prop ,*d* (:k ?v) ?t))") == "(((?V . 1) (?T . 5)) ((?V . 2) (?T . 5)) ((?V . 3) (?T)))"
    assert lisp("(answers `(desig-prop ,*e* (:k ?v) 5))") == "(((?V . 1)) ((?V . 2)))"
    assert lisp("(answers `(desig-value ,*d* ?v ?t))") == "(((?V . ONE) (?T . 5)) ((?V . TWO) (?T)))"


@pytest.mark.parametrize("predicate", ["current-designator", "newest-effective-designator"])
def test_of_no_designator_the_current_one_is_nil(lisp, predicate):
    """As (current-desig nil) is; plans give nil where an action has no such part. What is no designator, and no nil, has none."""
    assert lisp(f"(answers '({predicate} nil ?found))") == "(((?FOUND)))"
    assert lisp(f"(answers '({predicate} 3 ?found))") == "NIL"
    assert lisp(f"(answers '({predicate} nil 3))") == "NIL"


def test_other_predicates(lisp):
    lisp("(defvar *d* (a location (pose p) (location other) (n 1))) (defvar *m* (a motion (n 1)))")
    assert lisp("(list (answers `(desig-location-prop ,*d* ?p)) (answers `(desig-location-prop ,*m* ?p)))") == "((((?P . :P))) NIL)"
    assert lisp("(answers `(designator ?c ?d ,*m*))") == "(((?C . :MOTION) (?D (:N 1))))"
    assert lisp("(answers '(and (designator :motion ((:n 2)) ?d) (desig-prop ?d (:n ?n)) (desig-class ?d ?c)))").endswith(
        "(?N . 2) (?C . :MOTION)))"
    )
    assert lisp("(answers '(designator ?unbound ((:n 2)) ?d))") == "NIL"
    assert lisp("(answers '(designator :nonsense ((:n 2)) ?d))") == "NIL"  # with a warning, as with lisp-fun
    assert lisp("(answers `(and (desig-value ,*m* ?v) (effective-designator ,*m*)))") == "NIL"
    assert lisp("(answers `(and (newest-effective-designator ,*m* ?e) (current-designator ,*m* ,*m*) (equated-desigs ,*m* ?o)))") == (
        "(((?E) (?O)))"
    )
    assert lisp("(length (answers `(and (designator ?x) (== ?x ,*m*))))") == "1"
