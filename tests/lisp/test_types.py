"""Types as Python code meets them: predicates, ``deftype``, types that are classes of Python."""

import pytest

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import PackageError, SimpleError, SimpleTypeError
from cramhy_runtime.lisp_core.data import Symbol, lisp_list, list_from
from cramhy_runtime.languages.commonlisp.objects.classes import class_of, find_class, register_class
from cramhy_runtime.lisp_core.packages import find_package, make_package, sym
from cramhy_runtime.languages.commonlisp.types import coercion, types

boot()
HOME = find_package("TYPE-TESTS") or make_package("TYPE-TESTS", use=("COMMON-LISP",))


def test_an_answer_is_true_or_none():
    assert types.typep(1, sym("INTEGER")) is True
    assert types.typep("1", sym("INTEGER")) is None


@pytest.mark.parametrize("name", ["NUMBER", "INTEGER", "REAL", "BIT", "FIXNUM"])
def test_pythons_true_is_no_number(name):
    assert types.typep(True, sym(name)) is None
    assert types.typep(True, sym("SYMBOL")) is True


def test_pythons_false_counts_as_nil():
    for name in ("NULL", "LIST", "SYMBOL", "BOOLEAN", "SEQUENCE"):
        assert types.typep(False, sym(name)) is True
    assert types.type_of(False) is sym("NULL")
    assert class_of(False) is find_class(sym("NULL"))


def test_a_list_specifier_is_compiled_once():
    specifier = lisp_list(sym("OR"), sym("NULL"), sym("STRING"))
    assert types.type_predicate(specifier) is types.type_predicate(specifier)


def test_a_defined_type_takes_arguments_and_can_be_defined_again():
    small = HOME.intern("SMALL")

    def expander(limit):
        def expand(form, environment):
            given = form.cdr.car if form.cdr is not None else limit
            return lisp_list(sym("INTEGER"), 0, given)

        return expand

    types.define_type(small, expander(10))
    assert types.typep(10, small) is True and types.typep(11, small) is None
    assert types.typep(11, lisp_list(small, 20)) is True
    types.define_type(small, expander(5))
    assert types.typep(10, small) is None


def test_a_type_of_common_lisp_cannot_be_defined_again():
    with pytest.raises(PackageError) as problem:
        types.define_type(sym("INTEGER"), lambda form, environment: None)
    assert " violated when defining INTEGER as a type specifier" in str(problem.value)


def test_an_unknown_type_is_an_error_now_and_a_class_once_it_is_defined():
    name = HOME.intern("LATER")
    with pytest.raises(SimpleError, match="unknown type specifier"):
        types.typep(1, name)
    later = register_class(name, type("Later", (), {}))
    assert types.typep(later(), name) is True


def test_a_class_of_the_runtime_is_found_by_its_lisp_name():
    class Rover:
        lisp_name = "TYPE-TESTS::ROVER"

    assert types.typep(Rover(), HOME.intern("ROVER")) is True
    assert types.type_of(Rover()) is HOME.intern("ROVER")
    assert types.typep(Rover(), sym("STANDARD-OBJECT")) is True


def test_member_compares_with_eql():
    specifier = lisp_list(sym("MEMBER"), 1, True)
    assert types.typep(1, specifier) is True
    assert types.typep(1.0, specifier) is None
    assert types.typep(True, specifier) is True


def test_satisfies_looks_the_function_up_at_each_test():
    predicate = Symbol("EVEN-NOW")
    predicate.function = lambda number: True
    specifier = list_from([sym("SATISFIES"), predicate])
    assert types.typep(3, specifier) is True
    predicate.function = lambda number: None
    assert types.typep(3, specifier) is None


def test_python_sequences_are_vectors():
    assert types.typep(b"ab", sym("VECTOR")) is True
    assert types.typep([1, 2], lisp_list(sym("SIMPLE-VECTOR"), 2)) is True


def test_coercion_leaves_alone_what_is_of_the_type():
    text = "abc"
    assert coercion.coerce(text, sym("STRING")) is text
    assert coercion.coerce(None, sym("LIST")) is None


def test_coercion_that_is_impossible_says_so():
    with pytest.raises(SimpleTypeError) as problem:
        coercion.coerce("12", sym("NUMBER"))
    assert str(problem.value) == '"12" can\'t be converted to type NUMBER.'


@pytest.mark.parametrize(
    ("specifier", "shown"),
    [
        ("colour", "(MEMBER :RED :GREEN)"),
        ("(small 4)", "(MOD 5)"),
        ("(integer 0 255)", "(UNSIGNED-BYTE 8)"),
        ("symbol", "SYMBOL"),
        ("(or colour (small 1))", "(OR (MEMBER :RED :GREEN) BIT)"),
    ],
)
def test_check_type_shows_what_a_type_means(session, specifier, shown):
    session.package = "CL-USER"
    session.evaluate_text("(deftype colour () '(member :red :green))")
    session.evaluate_text("(deftype small (limit) `(integer 0 ,limit))")
    [text] = session.evaluate_text(f"""(handler-case (let ((x "a")) (check-type x {specifier}))
                                         (type-error (c) (prin1-to-string (type-error-expected-type c))))""")
    assert str(text) == shown


SUBTYPES_OF_COMPOUNDS = """
((AND SYMBOL LIST) NULL) (T T)
((AND LIST SYMBOL) NULL) (T T)
((AND SYMBOL SEQUENCE) NULL) (T T)
((AND ATOM LIST) NULL) (T T)
((AND LIST ATOM) NULL) (T T)
((AND LIST (NOT NULL)) CONS) (T T)
((AND LIST (NOT CONS)) NULL) (T T)
((NOT ATOM) CONS) (T T)
(CONS (NOT ATOM)) (T T)
((NOT CONS) ATOM) (T T)
((NOT LIST) ATOM) (T T)
(ATOM (NOT CONS)) (T T)
((NOT ATOM) LIST) (T T)
((NOT CONS) LIST) (NIL T)
((NOT NULL) T) (T T)
(T (NOT CONS)) (NIL T)
((NOT INTEGER) (NOT FIXNUM)) (T T)
((NOT FIXNUM) (NOT INTEGER)) (NIL T)
(T (OR ATOM CONS)) (T T)
(T (OR SYMBOL (NOT SYMBOL))) (T T)
((NOT SYMBOL) ATOM) (NIL T)
((NOT NUMBER) (NOT INTEGER)) (T T)
(BIGNUM (AND INTEGER (NOT FIXNUM))) (T T)
((AND SYMBOL (NOT NULL)) SYMBOL) (T T)
((AND VECTOR LIST) NIL) (T T)
((AND VECTOR SYMBOL) NIL) (T T)
((AND SYMBOL LIST) NIL) (NIL T)
((AND FLOAT RATIONAL) NIL) (T T)
((AND REAL (NOT RATIONAL)) FLOAT) (T T)
((AND RATIONAL (NOT INTEGER)) RATIO) (T T)
((AND FLOAT (NOT SINGLE-FLOAT)) DOUBLE-FLOAT) (T T)
((AND LIST SYMBOL) BOOLEAN) (T T)
((AND ARRAY (NOT VECTOR)) ATOM) (T T)
((AND LIST (OR SYMBOL STRING)) NULL) (T T)
((AND (OR CONS SYMBOL) LIST) LIST) (T T)
((AND CHARACTER LIST) NULL) (T T)
((AND INTEGER (OR CONS SYMBOL)) NIL) (T T)
((AND BOOLEAN LIST) NULL) (T T)
((AND BOOLEAN SYMBOL) SYMBOL) (T T)
((NOT (OR SYMBOL CONS)) ATOM) (T T)
((NOT (AND SYMBOL LIST)) T) (T T)
(NULL (AND SYMBOL LIST)) (T T)
((AND FIXNUM (INTEGER 0)) UNSIGNED-BYTE) (T T)
((AND (INTEGER 0) (INTEGER * 10)) (INTEGER 0 10)) (T T)
((AND (INTEGER 0 10) (INTEGER 5 20)) (INTEGER 5 10)) (T T)
((AND (INTEGER 0 10) (INTEGER 5 20)) (INTEGER 6 10)) (NIL T)
((NOT NIL) T) (T T)
(T (NOT NIL)) (T T)
((NOT T) NIL) (T T)
(INTEGER (NOT NIL)) (T T)
((AND (NOT SYMBOL) LIST) CONS) (T T)
((OR CONS NULL) LIST) (T T)
(LIST (NOT VECTOR)) (T T)
((AND CONS SYMBOL) NIL) (T T)
((NOT SYMBOL) LIST) (NIL T)
((AND (NOT INTEGER) (NOT CONS)) (NOT CONS)) (T T)
((AND (NOT INTEGER) (NOT CONS)) ATOM) (T T)
((NOT (NOT CONS)) CONS) (T T)
((NOT (NOT SYMBOL)) LIST) (NIL T)
(CONS (NOT (NOT CONS))) (T T)
((NOT (OR CONS INTEGER)) (NOT INTEGER)) (T T)
((AND (NOT NULL) SYMBOL LIST) NIL) (T T)
"""


@pytest.mark.soak(all_but=22)
@pytest.mark.parametrize("line", SUBTYPES_OF_COMPOUNDS.split("\n")[1:-1])
def test_subtypep_of_intersections_and_complements(line, session):
    """Each line has what SBCL answers."""
    session.package = "CL-USER"
    assert session.evaluate_text(f"""(let ((line '({line})))
      (equal (multiple-value-list (subtypep (first (first line)) (second (first line)))) (second line)))""") == [True]


CERTAIN = """
((AND SYMBOL (NOT NULL)) KEYWORD) (NIL T)
(SYMBOL (OR KEYWORD NULL)) (NIL T)
(NUMBER (OR REAL COMPLEX)) (T T)
(SEQUENCE (OR LIST VECTOR)) (T T)
((AND SEQUENCE STANDARD-OBJECT) NIL) (T T)
((AND VECTOR (NOT (VECTOR T)) (NOT STRING) (NOT BIT-VECTOR)) NIL) (NIL T)
((AND CONDITION (NOT ERROR)) NIL) (NIL T)
"""


@pytest.mark.parametrize("line", CERTAIN.split("\n")[1:-1])
def test_subtypep_is_certain_where_sbcl_leaves_it_open_or_has_more_types(line, session):
    session.package = "CL-USER"
    assert session.evaluate_text(
        f"(let ((line '({line}))) (equal (multiple-value-list (apply #'subtypep (first line))) (second line)))"
    ) == [True]


def test_two_classes_that_have_a_common_subclass_are_not_disjoint(session):
    session.package = "CL-USER"
    session.evaluate_text("(defclass left-part () ()) (defclass right-part () ())")
    asked = "(multiple-value-list (subtypep '(and left-part right-part) nil))"
    assert session.evaluate_text(f"(equal {asked} '(nil nil))") == [True]
    session.evaluate_text("(defclass both-parts (left-part right-part) ())")
    assert session.evaluate_text(f"(equal {asked} '(nil t))") == [True]


def test_a_declaration_means_the_class_that_its_name_has_now(session):
    """As SBCL: a class that took the place of another one, whose name it has."""
    text = "(defclass held () ()) (defun hold{0} (x) (declare (type held x)) x) (type-of (hold{0} (make-instance 'held)))"
    assert session.evaluate_text(text.format(1))[0].name == "HELD"
    assert session.evaluate_text("(setf (find-class 'held) nil)" + text.format(2))[0].name == "HELD"
