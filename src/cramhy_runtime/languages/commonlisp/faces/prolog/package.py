"""The Lisp package of this room: CRAM-PROLOG (nickname PROLOG).

Source: prolog.md sections 1, 13 and 14; ``explain`` and ``trace-prolog`` are more than the original has. The macros
(``def-fact-group``, ``<-``, ...) are in ``hy_src``; here their names are exported.
"""

from __future__ import annotations

from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import PROLOG
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic

from cramhy_runtime.utilities import patterns

from cramhy_runtime.prolog.builtins import builtins, productions, rete  # noqa: F401  the built-in predicates come along
from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog.explanations import explanations
from cramhy_runtime.prolog import query
from cramhy_runtime.prolog.builtins.function_calls import BREAK_ON_LISP_ERRORS
from cramhy_runtime.prolog.engine.machine import DEFAULT_DEPTH, DEPTH_LIMIT


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    generic("CRAM-PROLOG::PROLOG", "(query &optional binds)", documentation=query.prolog.__doc__).method(object)(query.prolog)
    define_face(
        "CRAM-PROLOG",
        nicknames=("PROLOG",),
        use=("COMMON-LISP", "CRAM-UTILITIES"),
        functions={
            query: "query-var filter-bindings",
            patterns: "unify unify-p",
            rete: "rete-assert rete-retract rete-holds rete-prove clear-alpha-network alpha-network-size",
            facts: "restore-fact-group",
            productions: """register-production clear-productions remove-production register-production-handler
                remove-production-handler""",
            "explain": explanations.print_explanation,
        },
        variables={BREAK_ON_LISP_ERRORS.name: None, DEPTH_LIMIT.name: DEFAULT_DEPTH},
        internal="restore-fact-group",
        export="""?_ prolog object-id and or not -> *-> cut lisp-fun lisp-pred assert-type bound ground true fail once call findall bagof
        setof
            every forall member subset take generate-values == equal length append sort reduce max string-concat format warn error
            slot-value get-slot-value instance-of lisp-type symbol-value set-symbol-value < > <= >=""",
    )
    export(PROLOG)
