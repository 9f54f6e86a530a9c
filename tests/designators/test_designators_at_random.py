"""Random descriptions, as data and as text: made, printed, copied, read, asked in Prolog and resolved, they give values or Lisp errors.

An internal error of Python (an attribute that is missing, a wrong type) in any of this is a bug, whatever the description.
"""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from systems import SOAK

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.designators import classes, equating, protocol
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import intern, keyword, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group, remove_fact_group
from cramhy_runtime.prolog.query import ask
from cramhy_runtime.prolog.terms.terms import Var

boot()
KINDS = ("MOTION", "ACTION", "LOCATION", "OBJECT", "HUMAN")
KEYS = st.sampled_from(["TYPE", "SPEED", "ANGLE", "AT"])
atoms = st.one_of(
    st.none(),
    st.just(True),
    st.integers(-9, 9),
    st.floats(allow_nan=False),
    st.text(max_size=3),
    st.builds(keyword, st.sampled_from(["DRIVING", "MOVING", "x y", ""])),
    st.builds(lambda: intern("?X", "CRAM-USER")),
    st.builds(lambda: intern("WORD", "CRAM-USER")),
    st.just(1.5),
    st.just(len),
)


def location_at(thing):
    return classes.make_designator(keyword("LOCATION"), lisp_list(lisp_list(keyword("AT"), thing)))


values = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3).map(list_from), st.tuples(inner, inner).map(lambda pair: Cons(*pair)), inner.map(location_at)
    ),
    max_leaves=6,
)
pairs = st.builds(lambda key, value: lisp_list(keyword(key), value), KEYS, values)
descriptions = st.one_of(st.lists(pairs, max_size=4).map(list_from), st.lists(st.one_of(pairs, values), max_size=4).map(list_from), values)

TRIED = {
    "prin1": prin1_to_string,
    "princ": princ_to_string,
    "desig-prop-value": lambda d: classes.desig_prop_value(d, keyword("SPEED")),
    "desig-prop-values": lambda d: classes.desig_prop_values(d, keyword("TYPE")),
    "copy-designator": lambda d: classes.copy_designator(d, new_description=lisp_list(lisp_list(keyword("SPEED"), 1))),
    "merge": lambda d: classes.merge_desig_descriptions(d, d.description),
    "extend": lambda d: classes.extend_designator_properties(d, d.description),
    "update": lambda d: classes.update_designator_properties(d.description, d.description),
    "effective": lambda d: classes.make_effective_designator(d, data_object=1),
    "desig-prop": lambda d: list(ask(sym("DESIG::DESIG-PROP"), d, lisp_list(keyword("SPEED"), 1))),
    "desig-prop, any": lambda d: list(ask(sym("DESIG::DESIG-PROP"), d, Var())),
    "desig-prop, time": lambda d: list(ask(sym("DESIG::DESIG-PROP"), d, Var(), Var())),
    "desig-value": lambda d: list(ask(sym("DESIG::DESIG-VALUE"), d, Var(), Var())),
    "desig-location-prop": lambda d: list(ask(sym("DESIG::DESIG-LOCATION-PROP"), d, Var())),
    "designator": lambda d: list(ask(sym("DESIG::DESIGNATOR"), Var(), Var(), d)),
    "reference": protocol.reference,
    "next-solution": protocol.next_solution,
    "designator-solutions": lambda d: equating.designator_solutions(d),
    "equate": lambda d: protocol.equate(d, classes.make_designator(keyword("MOTION"), d.description, d)),
}


@pytest.fixture(autouse=True, params=["greenlet"])
def fresh_kernel(request):
    yield kernel.start(clock="virtual", backend=request.param)
    kernel.stop()


@pytest.fixture(autouse=True)
def driving():
    d, s, prop = intern("?D", "CRAM-USER"), intern("?S", "CRAM-USER"), sym("DESIG::DESIG-PROP")
    groups = []
    for name in ("MOTION-GROUNDING", "ACTION-GROUNDING", "LOCATION-GROUNDING"):
        functor = sym(f"DESIG::{name}")
        groups.append(intern(f"RANDOM-{name}", "CRAM-USER"))
        define_fact_group(
            groups[-1],
            lisp_list(functor),
            lisp_list(
                lisp_list(
                    lisp_list(functor, d, lisp_list(intern("DRIVE", "CRAM-USER"), s)),
                    lisp_list(prop, d, lisp_list(keyword("TYPE"), keyword("DRIVING"))),
                    lisp_list(prop, d, lisp_list(keyword("SPEED"), s)),
                )
            ),
        )
    yield
    for group in groups:
        remove_fact_group(group)


@settings(max_examples=200 if SOAK else 60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(KINDS), descriptions)
def test_nothing_but_lisp_conditions(kind, description):
    designator = classes.make_designator(keyword(kind), description)
    for what, function in TRIED.items():
        try:
            function(designator)
        except Condition as condition:
            if isinstance(condition, classes.DesignatorError) or description is None or description.__class__ is Cons:
                assert isinstance(princ_to_string(condition), str), what
            assert getattr(condition, "hint", None) is None or isinstance(condition.hint, str), what


WORDS = st.sampled_from("?x a an the when t nil type driving :key 1 2.5 \"s\" #'car 'q #\\a .".split())
forms = st.recursive(WORDS, lambda inner: st.lists(inner, max_size=4).map(lambda parts: f"({' '.join(parts)})"), max_leaves=8)


@pytest.mark.soak
@settings(max_examples=100 if SOAK else 50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from(["a", "an", "all"]),
    st.sampled_from(["motion", '"motion"', "objects", "(x)", "5", "nil", ""]),
    st.lists(forms, max_size=3),
)
def test_any_text_is_a_designator_or_a_lisp_error(operator, kind, parts):
    from cramhy_runtime.repl.session import Session, condition_of

    session = Session(time="virtual", turtlesim=False, backend="greenlet")
    try:
        (value,) = session.evaluate_text(
            f"(let ((desig::?x 1)) (declare (ignorable desig::?x)) (desig:{operator} {kind} {' '.join(parts)}))".replace(
                " ?x", " desig::?x"
            ).replace("(?x", "(desig::?x")
        )
        assert isinstance(value, classes.Designator)
    except Condition as condition:
        text = princ_to_string(condition_of(condition))
        assert "Python" not in text and "object has no attribute" not in text, text
