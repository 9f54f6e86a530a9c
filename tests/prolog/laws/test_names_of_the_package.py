"""The names of CRAM-PROLOG, what kind of thing each is, and with which arguments (prolog.md section 14)."""

import pytest

from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package
from cramhy_runtime.languages.commonlisp.printer.printer import princ_to_string
from cramhy_runtime.prolog.builtins import control
from cramhy_runtime.prolog.engine import database

HANDLERS = """and or not -> *-> cut lisp-fun lisp-pred assert-type bound ground true fail once call findall bagof setof every forall
    take filter-bindings generate-values rete-holds"""
FACTS = """== equal length append sort reduce max string-concat format warn error slot-value get-slot-value instance-of lisp-type
    symbol-value set-symbol-value < > <= >= member"""
FUNCTIONS = {
    "unify": "(LHS RHS &OPTIONAL BDGS)",
    "unify-p": "(LHS RHS &OPTIONAL BDGS)",
    "query-var": "(VAR FUNCTION QUERY &REST ARGS)",
    "filter-bindings": "(FORM BDGS &OPTIONAL INITIAL-BDGS)",
    "clear-alpha-network": "NIL",
    "rete-assert": "(FACT)",
    "rete-retract": "(FACT)",
    "rete-holds": "(FACT-PATTERN &OPTIONAL TEST PROCESSED NODE)",
    "alpha-network-size": "(&OPTIONAL NODE)",
    "register-production": "(NAME DEFINITION)",
    "clear-productions": "NIL",
    "remove-production": "(NAME)",
    "register-production-handler": "(PRODUCTION-NAME CALLBACK)",
    "remove-production-handler": "(PRODUCTION-NAME CALLBACK)",
    "rete-prove": "(EXPR &OPTIONAL BDGS)",
}
GENERIC = {"prolog": "(QUERY &OPTIONAL BINDS)", "object-id": "(OBJ)"}
MACROS = "def-fact-group <- def-prolog-handler with-facts-asserted def-production with-productions with-production-handlers"
OTHERS = "?_ *break-on-lisp-errors*"
OURS = "*prolog-depth-limit* explain trace-prolog untrace-prolog"
"""More than the original has: watching proofs."""
OF_DEVEL = "subset"
"""What CRAM's branch devel has beside."""
GROUPS = {
    "misc-utils": "== equal",
    "list-utils": "member length append sort reduce",
    "math-utils": "max < > <= >=",
    "string-utils": "string-concat",
    "debugging": "format warn error",
    "lisp-data-structs": "slot-value get-slot-value symbol-value set-symbol-value",
    "lisp-types": "lisp-type instance-of",
}


def symbol(name):
    """The symbol that users of the package write as ``name``: it must be there for them."""
    found, status = find_package("CRAM-PROLOG").lookup(name.upper())
    assert status == "external" or found in COMMON_LISP.external.values(), name
    return found


def test_the_package():
    package = find_package("CRAM-PROLOG")
    assert package is find_package("PROLOG")
    assert [used.name for used in package.use] == ["COMMON-LISP", "CRAM-UTILITIES"]


def test_nothing_else_is_exported():
    own = {found for found in find_package("CRAM-PROLOG").external.values() if found.package is not COMMON_LISP}
    listed = " ".join([HANDLERS, FACTS, *FUNCTIONS, *GENERIC, MACROS, OTHERS, OURS, OF_DEVEL]).split()
    assert own - {symbol(name) for name in listed} == set()


@pytest.mark.parametrize("name", HANDLERS.split())
def test_handlers(name):
    entry = database.functors.get(symbol(name))
    assert symbol(name) in control.CONTROL or entry.handler is not None


@pytest.mark.parametrize("name", FACTS.split())
def test_predicates_by_facts(name):
    entry = database.functors[symbol(name)]
    assert entry.native and entry.handler is None
    assert [group for group, members in GROUPS.items() if name in members.split()] == [entry.native_group.name.lower()]
    assert entry.native_group.package.name == "CRAM-PROLOG"


@pytest.mark.parametrize("name, lambda_list", [*FUNCTIONS.items(), *GENERIC.items()])
def test_functions(name, lambda_list):
    function = symbol(name).function
    assert isinstance(function, GenericFunction) == (name in GENERIC)
    assert princ_to_string(lambda_list_of(function)) == lambda_list


@pytest.mark.parametrize("name", MACROS.split())
def test_macros(lisp, name):
    assert lisp(f"(not (null (macro-function 'prolog:{name})))") == "T"


def test_variables(lisp):
    assert lisp("(list *break-on-lisp-errors* (eq '?_ 'cut:?_))") == "(NIL T)"


@pytest.mark.parametrize("name", "! is = assert retract nth list-of".split())
def test_there_is_no_such_predicate(lisp, name):
    assert lisp(f"(prolog '({name} 1 2))") == "NIL"
    assert len(lisp.warnings) == 1


def test_methods_of_prolog_see_every_query(lisp):
    assert (
        lisp("""(defmethod prolog :around (query &optional binds) (note query) (call-next-method))
                   (unwind-protect (all '(and (== ?x 1) (not (== ?x 2))))
                     (remove-method #'prolog (find-method #'prolog '(:around) (list (find-class t)))))""")
        == "(((?X . 1)))"
    )
    assert lisp("(all '(true)) *notes*") == "((AND (== ?X 1) (NOT (== ?X 2))))"
