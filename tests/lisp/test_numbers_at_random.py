"""Random programs with numbers mean the same whether the compiler knows the kinds of its variables or not.

Each program is evaluated twice: as it stands, and with every operation called through a variable that holds the function. Then the
compiler knows nothing, and the generic functions compute. Both must print the same answer, the same class of an error, and the same
trace of what was evaluated before. Integers, ratios, singles, doubles and complex numbers are mixed; the largest doubles overflow.
"""

from __future__ import annotations

from systems import SOAK

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

NUMBERS = "0 1 2 3 -1 7 0.5 -1.5 2.0 0.0 1/2 -2/3 0d0 1d0 -2.5d0 3.25d0 1d-3".split()
RARE = ["#c(1 2)", "#c(0d0 1d0)", "1d200", "-1d160", "(expt 10 400)"]
BINARY = "+ - * / max min atan mod rem floor".split()
UNARY = "- + abs 1+ 1- sqrt sin cos tan exp log asin acos atan floor truncate ceiling round float length".split()
VECTORS = "v w z nil".split()
ELEMENTS = ["aref", "aref", "svref", "elt"]
TESTS = "< > <= >= = zerop plusp minusp".split()
VARIABLES = "abcd"


@st.composite
def expressions(draw, names, depth):
    def part(deeper=1):
        return draw(expressions(names, depth - deeper))

    def index():
        return draw(st.sampled_from([*"0112nab", part(2)]))

    if depth <= 0:
        if draw(st.integers(0, 2)):
            return draw(st.sampled_from(names))
        return draw(st.sampled_from(NUMBERS * 6 + RARE))
    kind = draw(
        st.sampled_from(
            "binary binary binary more unary number if let setq noted block values catch closure checked element element matrix coerced".split()
        )
    )
    match kind:
        case "binary":
            return (draw(st.sampled_from(BINARY)), part(), part())
        case "more":
            return (draw(st.sampled_from("+ - * / max min".split())), *[part() for _ in range(draw(st.integers(3, 4)))])
        case "unary":
            return (draw(st.sampled_from(UNARY)), part())
        case "number":
            return draw(st.sampled_from(NUMBERS))
        case "if":
            return ("if", draw(comparisons(names, depth - 1)), part(), part())
        case "let":
            new = draw(st.sampled_from("xy"))
            return ("let", ((new, part()),), draw(expressions((*names, new), depth - 1)))
        case "setq":
            return ("setq", draw(st.sampled_from(names)), part())
        case "noted":
            return ("noted", part())
        case "block":
            return ("block", "b", part(), ("if", draw(comparisons(names, depth - 1)), ("return-from", "b", part()), "nil"), part())
        case "values":
            new = draw(st.sampled_from("xy"))
            inner = draw(expressions((*names, new), depth - 1))
            return ("multiple-value-bind", (new, "rest"), ("floor", part(), "2"), ("noted", "rest"), inner)
        case "catch":
            return (
                "catch",
                "'out",
                ("unwind-protect", (draw(st.sampled_from(["throw", "list"])), "'out", part()), ("noted", part())),
                part(),
            )
        case "closure":
            return ("funcall", ("lambda", (), part()))
        case "element":
            return (draw(st.sampled_from(ELEMENTS)), draw(st.sampled_from(VECTORS)), index())
        case "matrix":
            return ("aref", "m", index(), index())
        case "coerced":
            return ("coerce", part(), draw(st.sampled_from(["'double-float", "'single-float", "'float"])))
        case "checked":
            return ("the", draw(st.sampled_from("number real float double-float integer".split())), part())


@st.composite
def comparisons(draw, names, depth):
    operator = draw(st.sampled_from(TESTS))
    count = 1 if operator in ("zerop", "plusp", "minusp") else draw(st.sampled_from([2, 2, 2, 3]))
    return (operator, *[draw(expressions(names, depth - 1)) for _ in range(count)])


@st.composite
def statements(draw, names, depth):
    kind = draw(st.sampled_from("setq setq setq incf loop when noted store store".split()))
    name = draw(st.sampled_from(VARIABLES))
    match kind:
        case "setq":
            return ("setq", name, draw(expressions(names, 2)))
        case "incf":
            return ("incf", name, draw(expressions(names, 1)))
        case "store":
            index, column = (draw(st.sampled_from([*"012n", draw(expressions(names, 0))])) for _ in range(2))
            array = draw(st.sampled_from([("m", index, column), *((each, index) for each in VECTORS)]))
            return ("setf", ("aref", *array), draw(expressions(names, 2)))
        case "loop" if depth:
            counter = draw(st.sampled_from("ij"))
            inner = (*names, counter)
            return ("dotimes", (counter, draw(st.sampled_from("123n"))), *[draw(statements(inner, depth - 1)) for _ in range(2)])
        case "when":
            return ("when", draw(comparisons(names, 1)), draw(statements(names, 0)))
        case _:
            return ("noted", draw(expressions(names, 2)))


@st.composite
def programs(draw):
    """A function of ``n`` and ``u`` with four variables; what one begins with is declared, as often as not."""
    first = [draw(st.sampled_from(NUMBERS)) for _ in VARIABLES]
    names = (*VARIABLES, "n", "u")
    body = [("guarded", draw(statements(names, 2))) for _ in range(draw(st.integers(1, 5)))]
    bindings = tuple(zip(VARIABLES, first))
    return ("let", bindings, *body, ("list", *VARIABLES, "v", "w", "z", "m", ("guarded", draw(expressions(names, 2)))))


def text(form, unknown):
    """The Lisp text of ``form``; ``unknown``: operators of numbers are called as values of variables."""
    if isinstance(form, str):
        return form
    head, *rest = form
    if head in ("let", "dotimes"):
        binding = rest[0]
        if head == "let":
            first = "(" + " ".join(f"({name} {text(value, unknown)})" for name, value in binding) + ")"
        else:
            first = f"({binding[0]} {text(binding[1], unknown)})"
        return f"({head} {first} " + " ".join(text(each, unknown) for each in rest[1:]) + ")"
    if head == "multiple-value-bind":
        return f"({head} ({' '.join(rest[0])}) " + " ".join(text(each, unknown) for each in rest[1:]) + ")"
    if head == "lambda":
        return "(lambda () " + text(rest[1], unknown) + ")"
    arguments = " ".join(text(each, unknown) for each in rest)
    if unknown and head == "incf":
        name, amount = rest
        return f"(let ((amount {text(amount, unknown)})) (setq {name} (call '+ {name} amount)))"
    if unknown and head == "setf":
        (_, *place), new = rest
        parts = [text(each, unknown) for each in (*place, new)]
        bindings = " ".join(f"(s{index} {part})" for index, part in enumerate(parts))
        return f"(let* ({bindings}) (funcall #'(setf aref) s{len(parts) - 1} {' '.join(f's{index}' for index in range(len(parts) - 1))}))"
    if unknown and head == "the":
        return f"(checked '{rest[0]} {text(rest[1], unknown)})"
    if unknown and head in (*BINARY, *UNARY, *TESTS, *ELEMENTS, "coerce"):
        return f"(call '{head} {arguments})"
    return f"({head} {arguments})"


SETUP = """
(defvar *noted* nil)
(defmacro guarded (form) `(handler-case ,form (error (c) (noted (type-of c)))))
(defun noted (x) (push x *noted*) x)
(defun call (f &rest arguments) (apply f (mapcar #'identity arguments)))
(defun checked (type x) (if (typep x type) x (error 'type-error :datum x :expected-type type)))
"""
_session = []


def session():
    if not _session:
        _session.append(Session(time="virtual", turtlesim=False))
        _session[0].evaluate_text(SETUP)
    return _session[0]


def answer(program, arguments, unknown):
    *_, found = session().evaluate_text(
        f"""(setq *noted* nil)
        (let ((f (let ((v (vector 1 2.5 3d0 1/2)) (w (make-array 3 :element-type 'double-float :initial-element 2d0))
                       (z (make-array 4 :fill-pointer 2 :initial-element 1.5)) (m (make-array '(2 3) :initial-element 2)))
                   (lambda (n u) n u {text(program, unknown)}))))
          (list (handler-case (funcall f {arguments}) (error (c) (list :error (type-of c)))) (reverse *noted*)))"""
    )
    return prin1_to_string(found)


ARGUMENTS = ["2 1", "3 2.5", "1 1.5d0", "3 -2d0"] * 3 + ["2 1/3", "1 #c(1 1)", "2 nil"]


@settings(max_examples=500 if SOAK else 30, deadline=None, suppress_health_check=list(HealthCheck))
@given(programs(), st.sampled_from(ARGUMENTS))
def test_numbers_are_the_same_when_their_kinds_are_known(program, arguments):
    known, unknown = (answer(program, arguments, each) for each in (False, True))
    assert known == unknown, text(program, False)
