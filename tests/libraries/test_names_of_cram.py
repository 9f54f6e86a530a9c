"""Our libraries define what CRAM's own define: each exported name as a function, macro, class or variable, and each predicate.

``names_of_cram.json`` has the names, and no more, of cram2/cram (branch master, 2020-07-09) and ros/roslisp_common: what a ``defpackage``
exports, by the kind of its definition, and the heads ``functor/arity`` of each fact group whose functors other packages can name.
`MISSING` says what is not here. A test holds that it is really missing, so the list does not outlive its reasons.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, python_list
from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.languages.commonlisp.evaluation.symbols import fboundp
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.prolog.engine import database, fact_groups

pytestmark = pytest.mark.soak

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

NAMES = json.loads((Path(__file__).parent / "names_of_cram.json").read_text())
SYSTEMS = """cffi-ros-utils cl-bullet cl-urdf cram-btr-spatial-relations-costmap cram-btr-visibility-costmap cram-bullet-reasoning
    cram-bullet-reasoning-belief-state cram-bullet-reasoning-utilities cram-cloud-logger cram-common-designators cram-common-failures
    cram-designator-specification cram-json-prolog cram-knowrob-pick-place cram-location-costmap cram-math cram-mobile-pick-place-plans
    cram-object-interfaces cram-occupancy-grid-costmap cram-physics-utils cram-plan-occasions-events cram-pr2-description
    cram-pr2-environment-manipulation cram-pr2-fetch-deliver-plans cram-pr2-pick-place-demo cram-pr2-projection
    cram-pr2-projection-reasoning cram-robot-interfaces cram-robot-pose-gaussian-costmap cram-simple-actionlib-client cram-tf
    cram-language-designator-support actionlib cl-tf cl-tf2 roslisp-utilities""".split()
MISSING = {
    "OpenGL and what is drawn with it": "CRAM-BULLET-REASONING:flat-color-object-proxy CRAM-BULLET-REASONING:drawable-list",
    "semantic maps, which KnowRob answers": """CRAM-BULLET-REASONING:semantic-map-object semantic-map/2 container/3 semantic-map-part/3
        semantic-map-part-type/4 semantic-map-part-pose/4""",
    "states of Bullet's: a state of a world is a world": "CRAM-BULLET-REASONING:bt-reasoning-world-state",
    "the choice among runs, which with-projected-task-tree makes": "CRAM-PR2-PROJECTION-REASONING:pick-best-parameters-by-distance",
    "internal machines of states": "ACTIONLIB-LISP:state",
}
"""Why, and what of the original's names is not here."""
missing = {name for names in MISSING.values() for name in names.split()}


@pytest.fixture
def with_all_libraries(session):
    for system in SYSTEMS:
        session.evaluate_text(f"(asdf:load-system :{system})")


def defined(symbol, kind):
    if kind == "function" or kind == "macro":
        return fboundp(symbol) is not None
    if kind == "class":
        return find_class(symbol, None) is not None
    return kind == "name" or symbol.value is not UNBOUND


def test_each_name_is_exported_and_defined(with_all_libraries):
    wrong = set()
    for package, kinds in NAMES["names"].items():
        found = find_package(package)
        for kind, names in kinds.items():
            for name in names.split():
                symbol, status = found.lookup(name.upper())
                if status != "external" or not defined(symbol, kind):
                    wrong.add(f"{package}:{name}")
    assert wrong == {name for name in missing if ":" in name}


def heads():
    """The heads ``functor/arity`` that hold here, of all packages."""
    found = set()
    for functor, entry in database.functors.items():
        if isinstance(functor, Symbol):
            found |= {f"{functor.name.lower()}/{len(python_list(clause.head)) - 1}" for clause in entry.clauses}
            if entry.native_group is not None or entry.handler is not None:
                found.add(functor.name.lower())
    return found


def test_each_predicate_is_there(with_all_libraries):
    here, wrong = heads(), set()
    for groups in NAMES["facts"].values():
        for predicates in groups.values():
            for predicate in predicates.split():
                plain = predicate.rpartition(":")[2]
                if plain not in here and plain.partition("/")[0] not in here:
                    wrong.add(plain)
    assert wrong == {name for name in missing if "/" in name}


SPLIT = """actions poses spatial-relations reachability semantic-map debug costmap-params location-desig-utils relations-lookup-table spatial-relations-knowledge
    pose-sampling occasion-utilities navigation-motions torso-motions ptu-motions pick-and-place-manipulation semantic-map-maniplation
    object-knowledge object-type-hierarchy pick-and-place-atomic-actions environment-manipulation-costmap pr2-matching-pms
    pr2-available-pms location-costmap-utils location-costmap robot-parts-location demo-costmap pr2-metadata""".split()
"""Fact groups of the original whose predicates stand in several groups here, or in one with others."""


def test_fact_groups_have_the_names_of_the_original(with_all_libraries):
    ours = {group.name.lower() for group in fact_groups.fact_group_names()}
    theirs = {group for groups in NAMES["facts"].values() for group in groups}
    assert theirs - ours - set(SPLIT) == set()
