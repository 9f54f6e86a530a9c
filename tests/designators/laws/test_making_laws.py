"""Making, printing, copying and reading designators, as users write it: designators.md 13, invariants 1 to 12 and 41 to 44."""

import pytest


@pytest.mark.law("designators", 1)
def test_the_words_of_a_description_become_keywords(lisp):
    assert lisp("(props (a motion (type driving)))") == "((:TYPE :DRIVING))"
    assert lisp('(props (a motion (|type| Driving) ("s" |driving|)))') == '((:TYPE :DRIVING) ("s" :DRIVING))'


@pytest.mark.law("designators", 2)
def test_numbers_and_strings_stay_as_they_are(lisp):
    assert lisp('(props (an action (n 5) (x 1.5) (r 1/2) (d 1d0) (s "Text") (c #\\a)))') == (
        '((:N 5) (:X 1.5) (:R 1/2) (:D 1.0d0) (:S "Text") (:C #\\a))'
    )


@pytest.mark.law("designators", 3)
def test_a_variable_has_the_value_that_it_has_where_and_when_the_form_runs(lisp):
    assert lisp("(let ((?x 3)) (props (a motion (speed ?x))))") == "((:SPEED 3))"
    assert lisp("""(mapcar (lambda (make) (props (funcall make)))
                           (loop for i from 1 to 3 collect (let ((?i i)) (lambda () (a motion (n ?i))))))""") == (
        "(((:N 1)) ((:N 2)) ((:N 3)))"
    )
    assert lisp.error("(a motion (speed ?nowhere))") == "The variable ?NOWHERE is unbound."


@pytest.mark.law("designators", 4)
def test_a_list_mixes_constants_and_variables(lisp):
    assert lisp("(let ((?x 1) (?y '(2 b))) (props (a motion (goal (?x left (?y 0))))))") == "((:GOAL (1 :LEFT ((2 B) 0))))"


@pytest.mark.law("designators", 5)
def test_a_nested_designator_is_an_object(lisp):
    lisp("(defvar *at* (desig-prop-value (an object (at (a location (of (an object (type cup)))))) :at))")
    assert lisp("(list (type-of *at*) (type-of (desig-prop-value *at* :of)))") == "(LOCATION-DESIGNATOR OBJECT-DESIGNATOR)"
    assert lisp("(quantifier (desig-prop-value (an action (on (all objects (type cup)))) :on))") == ":ALL"
    assert lisp("(props (an object (places ((a location (n 1)) here))))") == "((:PLACES (#<A LOCATION (N 1)> :HERE)))"


@pytest.mark.law("designators", 6)
def test_when_leaves_an_entry_or_none(lisp):
    lisp("(defun made (?v) (props (a motion (type driving) (when ?v (key ?v)))))")
    assert lisp("(list (made nil) (made 5))") == "(((:TYPE :DRIVING)) ((:TYPE :DRIVING) (:KEY 5)))"
    assert lisp("(let ((?n 3)) (props (a motion (when (> ?n 2) (many t)) (when (> ?n 5) (too-many t)))))") == "((:MANY T))"
    assert lisp("(props (a motion (when word (key 1)) (when 1 2 3)))") == "((:KEY 1) (:WHEN 1 2 3))"  # a plain symbol is a keyword


@pytest.mark.law("designators", 7)
def test_nil_is_a_value_and_no_entry(lisp):
    assert lisp("(props (a motion nil (speed nil) () (off ()) (in (when nil 1))))") == "((:SPEED NIL) (:OFF NIL) (:IN NIL))"


@pytest.mark.law("designators", 8)
def test_quantifiers(lisp):
    assert lisp("""(mapcar (lambda (d) (list (quantifier d) (type-of d)))
                           (list (a motion) (an object) (all objects (type cup)) (all object) (all motionssS)))""") == (
        "((:A MOTION-DESIGNATOR) (:A OBJECT-DESIGNATOR) (:ALL OBJECT-DESIGNATOR) (:ALL OBJECT-DESIGNATOR) (:ALL MOTION-DESIGNATOR))"
    )


@pytest.mark.law("designators", 9)
@pytest.mark.parametrize(
    "form, text, hint",
    [
        ("(a motoin (type driving))", "Designator type `MOTOIN' undefined", "Did you mean motion?"),
        (
            "(make-designator :place nil)",
            "Designator type `PLACE' undefined",
            "The types of designators are action, human, location, motion and object.",
        ),
        ("(all buss)", "Designator type `BU' undefined", "The types of designators are action, human, location, motion and object."),
        ("(make-designator 'location nil)", "Designator type `LOCATION' undefined", "The type is a keyword: write :location."),
        (
            "(make-designator 5 nil)",
            "Designator type `5' undefined",
            "The types of designators are action, human, location, motion and object.",
        ),
    ],
)
def test_an_unknown_type_is_an_error(lisp, form, text, hint):
    assert lisp.error(form) == text
    assert lisp.hint(form) == hint
    assert lisp(f"(typep (nth-value 1 (ignore-errors {form})) 'simple-error)") == "T"


@pytest.mark.law("designators", 10)
def test_a_property_a_line_and_the_bracket_behind_the_last(lisp):
    assert lisp.text('(prin1-to-string (an object (type bottle) (at (a location (name "x"))) (l (1 (two)))))') == (
        '#<A OBJECT\n    (TYPE BOTTLE)\n    (AT #<A LOCATION\n    (NAME "x")>)\n    (L (1 (:TWO)))>'
    )
    assert lisp.text("(princ-to-string (a location))") == "#<A LOCATION>"


@pytest.mark.law("designators", 11)
def test_princ_leaves_out_the_quotes_and_nothing_else(lisp):
    lisp('(defvar *d* (make-designator :motion \'((:s "x") (:m :|mixed|) (:l ("y" :k)))))')
    assert lisp.text('(format nil "~s" *d*)') == '#<A MOTION\n    (S "x")\n    (M |mixed|)\n    (L ("y" :K))>'
    assert lisp.text('(format nil "~a" *d*)') == "#<A MOTION\n    (S x)\n    (M mixed)\n    (L (y K))>"


@pytest.mark.law("designators", 12)
def test_a_switch_leaves_the_description_out(lisp):
    assert lisp.text("(let ((*designator-pprint-description* nil)) (prin1-to-string (a motion (type driving))))") == "#<>"


@pytest.mark.law("designators", 41)
def test_an_effective_designator_is_equated_to_nothing(lisp):
    lisp("""(defvar *parent* (an object (type cup)))
            (defvar *seen* (make-effective-designator *parent* :data-object 'the-cup :timestamp 3))
            (defvar *other* (make-effective-designator *parent* :new-properties '((:type :plate)) :data-object 1))""")
    assert lisp("(list (effective *seen*) (timestamp *seen*) (reference *seen*) (props *seen*) (desig-equal *parent* *seen*))") == (
        "(T 3 THE-CUP ((:TYPE :CUP)) NIL)"
    )
    assert lisp("(list (type-of *other*) (props *other*) (timestamp *other*) (effective *parent*))") == (
        "(OBJECT-DESIGNATOR ((:TYPE :PLATE)) 0.0d0 NIL)"
    )


@pytest.mark.law("designators", 42)
def test_a_copy_has_the_new_description_and_what_it_lacks_of_the_old(lisp):
    lisp("""(defvar *old* (make-designator :motion '((:a 1) (:b 2) (:c 3) (:a 4))))
            (defvar *copy* (copy-designator *old* :new-description '((:b 9) (:d 4))))""")
    assert lisp("(list (props *copy*) (type-of *copy*) (desig-equal *old* *copy*))") == (
        "(((:C 3) (:A 1) (:B 9) (:D 4)) MOTION-DESIGNATOR NIL)"
    )
    assert lisp("(list (props *old*) (props (copy-designator *old*)))") == ("(((:A 1) (:B 2) (:C 3) (:A 4)) ((:C 3) (:B 2) (:A 1)))")


@pytest.mark.law("designators", 43)
def test_one_value_or_all(lisp):
    lisp("(defvar *d* (a motion (arm left) (type driving) (arm right) (arm)))")
    assert lisp("(list (desig-prop-value *d* :arm) (desig-prop-values *d* :arm))") == "(:LEFT (:LEFT :RIGHT NIL))"
    assert lisp("(list (desig-prop-value *d* :leg) (desig-prop-values *d* :leg) (desig-prop-value nil :arm))") == "(NIL NIL NIL)"


@pytest.mark.law("designators", 44)
def test_properties_as_variables(lisp):
    lisp("(defun given () (note :asked) (a motion (type driving) (speed 5)))")
    assert lisp("(with-desig-props (type speed angle) (given) (list type speed angle))") == "(:DRIVING 5 NIL)"
    assert lisp("*notes*") == "(:ASKED)"
    assert lisp("(with-desig-props (type) nil type)") == "NIL"
