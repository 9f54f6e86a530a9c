"""Each function of COMMON-LISP, called with arguments of wrong types, returns or signals a condition of Lisp, none of Python.

What SBCL signals for which call stands in ``symbols/details.txt``; here all functions are called, and only the kind of the condition
is looked at.
"""

import itertools

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Character, Cons, Symbol, UndefinedFunction, lisp_list
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP, COMMON_LISP_USER, keyword, sym
from cramhy_runtime.languages.commonlisp.objects.classes import class_name
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.streams.streams import StringInputStream, StringOutputStream, TwoWayStream
from cramhy_runtime.repl.session import Session, condition_of

LEFT_OUT = set(
    """SLEEP Y-OR-N-P YES-OR-NO-P BREAK INVOKE-DEBUGGER ABORT CONTINUE MUFFLE-WARNING ED DRIBBLE INSPECT ROOM DESCRIBE REQUIRE LOAD COMPILE-FILE
    DELETE-FILE RENAME-FILE OPEN ENSURE-DIRECTORIES-EXIST DELETE-PACKAGE RENAME-PACKAGE UNINTERN UNEXPORT EXPORT IMPORT SHADOW
    SHADOWING-IMPORT USE-PACKAGE UNUSE-PACKAGE MAKE-PACKAGE MAKUNBOUND FMAKUNBOUND SET PROCLAIM SET-PPRINT-DISPATCH""".split()
)
"""They wait, ask, show much, or change the image or the disk for good."""

ENDLESS = set(
    """BUTLAST COPY-ALIST COPY-LIST COPY-SEQ COPY-TREE DELETE-DUPLICATES LAST LENGTH MAKE-ARRAY MAKE-STRING-INPUT-STREAM
    NBUTLAST NREVERSE REMOVE-DUPLICATES REVERSE VALUES-LIST WRITE-LINE WRITE-STRING""".split()
)
"""A circular list keeps them busy for ever, as in SBCL, until somebody interrupts them."""


def a_circle():
    """``#1=(1 . #1#)``"""
    cons = Cons(1, None)
    cons.cdr = cons
    return cons


SINGLE = [
    lambda: sym("CRAMHY::FOO"),
    lambda: keyword("K"),
    lambda: 42,
    lambda: -1,
    lambda: 1.5,
    lambda: "text",
    lambda: Character("a"),
    lambda: None,
    lambda: True,
    lambda: lisp_list(1, 2),
    lambda: Cons(1, 2),
    lambda: [1, 2],
    lambda: sym("CAR").function,
]
FEW = [lambda: sym("CRAMHY::FOO"), lambda: 42, lambda: "text", lambda: lisp_list(1, 2)]


def functions():
    """(name, function) of the functions of COMMON-LISP that are tried."""
    for name in sorted(COMMON_LISP.external):
        symbol = COMMON_LISP.lookup(name)[0]
        if isinstance(symbol, Symbol) and symbol.macro is None and name not in LEFT_OUT:
            if not isinstance(symbol.function, UndefinedFunction):
                yield name, symbol.function


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


@pytest.fixture
def quiet():
    """What the functions print goes nowhere, and what they read ends at once."""
    shown = StringOutputStream()
    outputs = [(sym(name), shown) for name in "*STANDARD-OUTPUT* *ERROR-OUTPUT* *TRACE-OUTPUT*".split()]
    both = [(sym(name), TwoWayStream(StringInputStream(""), shown)) for name in "*QUERY-IO* *DEBUG-IO* *TERMINAL-IO*".split()]
    others = [(sym("*STANDARD-INPUT*"), StringInputStream("")), (sym("*PACKAGE*"), COMMON_LISP_USER), (sym("*PRINT-CIRCLE*"), True)]
    others.append((sym("*READTABLE*"), sym("COPY-READTABLE").function(None)))  # whose characters some of them change
    with binding(*itertools.chain.from_iterable([*outputs, *both, *others])):
        yield


def wrong(name, function, arguments):
    """The text of what is wrong with the condition that the call signals; ``None``: nothing."""
    try:
        function(*arguments)
        return None
    except Condition as condition:
        kind = class_name(type(condition))
    except Exception as problem:
        kind = class_name(type(condition_of(problem)))
    if kind.package is None or kind.package.name != "PYTHON":
        return None
    return f"({name} {' '.join(map(prin1_to_string, arguments))}) signals {kind!r}"


def complaints(choices):
    """What is wrong with the calls of all functions with each of the argument lists that ``choices()`` makes."""
    calls = ((name, function, arguments) for name, function in functions() for arguments in choices())
    return [complaint for complaint in itertools.starmap(wrong, calls) if complaint is not None]


@pytest.mark.soak(only=("two",), all_but=1)
@pytest.mark.parametrize("count, values", [(0, ()), (1, SINGLE), (2, FEW)], ids=["no argument", "one", "two"])
def test_wrong_arguments_give_conditions_of_lisp(session, quiet, count, values):
    assert complaints(lambda: ([make() for make in makers] for makers in itertools.product(values, repeat=count))) == []


@pytest.mark.soak
def test_three_wrong_arguments_give_conditions_of_lisp(session, quiet):
    assert complaints(lambda: [[first(), second(), first()] for first, second in itertools.combinations(FEW, 2)]) == []


def test_a_circular_argument_gives_a_condition_of_lisp(session, quiet):
    found = [wrong(name, function, [a_circle()]) for name, function in functions() if name not in ENDLESS]
    assert [complaint for complaint in found if complaint is not None] == []


def test_functions_that_change_names_for_good_refuse_what_is_no_name(session, quiet):
    for name in "MAKUNBOUND FMAKUNBOUND SET PROCLAIM SHADOW MAKE-PACKAGE USE-PACKAGE EXPORT IMPORT".split():
        for value in (42, 1.5, [1, 2]):
            arguments = [value, value] if name == "SET" else [value]
            assert wrong(name, sym(name).function, arguments) is None, (name, value)


@pytest.mark.soak
def test_wrong_values_at_places_give_conditions_of_lisp(session, quiet):
    found = []
    for name in sorted(COMMON_LISP.external):
        setter = getattr(COMMON_LISP.lookup(name)[0], "setf_function", None)
        if setter is not None and name != "DOCUMENTATION":
            for makers in [FEW[:2], FEW[1:3], FEW[2:4], FEW[:3], FEW[1:]]:
                found.append(wrong(f"SETF {name}", setter, [make() for make in makers]))
    assert [complaint for complaint in found if complaint is not None] == []


WRONG = """
(cpl:composite-failures 1)
(cpl:composite-failures nil)
(cpl:envelop-error "a")
(cut:lazy-car 1)
(cut:lazy-cdr :k)
(cut:lazy-elt :k 1)
(cut:lazy-skip 1 :k)
(cut:lazy-mapcar (function 1+) 5)
(cut:lazy-mapcan (function list) 5)
(cut:lazy-filter (function evenp) 5)
(cut:lazy-fold (function +) 5)
(cut:pool-value 1 2)
(cut:new-pool-value nil 2)
(cut:delete-pool-value nil 2)
(cpm:input 1)
(cpm:cancel nil)
(cpm:caller "a")
(actionlib:goal 1)
(actionlib:feedback nil)
(desig:get-equal-designators 1)
(desig:designator-solutions nil)
(desig:make-effective-designator 1)
(desig:make-effective-designator nil)
(prolog:rete-prove 1)
(prolog:rete-prove '((a) . 1))
(prolog:alpha-network-size "a")
(prolog:filter-bindings '(?a) 2)
(prolog:filter-bindings '(?a) '((?b . 1)) '(1))
(prolog:register-production #(1) '((a)))
(prolog:register-production 'a 2)
(prolog:register-production-handler #(1) (function list))
(prolog:remove-production #(1))
(cut:minimum 1)
(cut:maximum :k)
(cut:add-bdg '?a 1 2)
(cut:add-bdg '?a 1 '(2))
(cut:var-value '?a "a")
(cut:bindings-equal 1 nil)
(cut:bindings-equal '(1) nil)
(cut:bindings-equal '((?a . 1)) 1)
(cut:cached-file-value 1)
(cut:cached-file-value '(1))
(cut:lazy-append 1 nil)
(cut:lazy-append nil "a")
(cut:lazy-take 2 :k)
(cut:lazy-take :k '(1))
(cut:lazy-flatten 5)
(cut:lazy-elt '(1) :k)
(cut:lazy-skip '(1) nil)
(cpl:mapcar-clean 5 '(1))
(cpl:mapcar-clean (function 1+) 5)
(cpl:named-policy #(1))
(cpl:get-top-level-task-tree #(1))
(desig:disable-location-generator-function #(1))
(desig:enable-location-validation-function #(1))
(desig:delete-location-generator-function #(1))
(cpm:register-process-module #(1))
(cpm:get-running-process-module #(1))
(cram-execution-trace:get-top-level-episode-knowledge #(1))
(cram-execution-trace:register-top-level-episode-knowledge #(1))
(roslisp:make-response #(1))
(proclaim '(1 . 2))
(proclaim '(special . 2))
(proclaim '(inline . 2))
(proclaim '(optimize . 2))
"""


@pytest.mark.soak(all_but=21)
@pytest.mark.parametrize("form", WRONG.strip().splitlines())
def test_functions_of_cram_refuse_arguments_of_wrong_types_in_lisp(session, form):
    (answer,) = session.evaluate_text(f"(handler-case {form} (type-error (problem) (list :refused (type-error-expected-type problem))))")
    assert isinstance(answer, Cons) and str(answer.car) == ":REFUSED"
