"""Projections under faults and schedules: whatever happens to them, what was started up is shut down, and nothing is left."""

import pytest

from cramhy_runtime import cpl, testing
from cramhy_runtime.session import boot
from cramhy_runtime import process_modules as pm
from cramhy_runtime import projection as proj
from cramhy_runtime.designators.classes import make_designator
from cramhy_runtime.lisp_core.packages import intern, keyword
from cramhy_runtime.projection import environments
from cramhy_runtime.testing import assert_order, mark, faults

boot()
WORLD, ARM, IMAGINED = (intern(f"FAULTY-{name}", "CRAM-USER") for name in ("WORLD", "ARM", "IMAGINED-ARM"))


@pytest.fixture(autouse=True)
def world(monkeypatch):
    monkeypatch.setattr(environments, "_environments", {})
    pm.define_process_module(IMAGINED, lambda designator: cpl.sleep(1))


def define(name):
    proj.define_projection_environment(
        WORLD, modules=[(ARM, IMAGINED)], startup=lambda: mark(f"startup {name}"), shutdown=lambda: (cpl.sleep(1), mark(f"shutdown {name}"))
    )


def project(name):
    def body():
        mark(f"body {name}")
        pm.pm_execute(ARM, make_designator(keyword("MOTION"), None))
        mark(f"done {name}")
        return environments.PROJECTION_ENVIRONMENT.value

    define(name)
    return list(proj.with_projection_environment(WORLD, body).result or ())


def side_by_side():
    found = {}

    def branch(name):
        found[name] = project(name)

    cpl.top_level(lambda: cpl.par(lambda: branch("left"), lambda: branch("right")))
    assert environments.PROJECTION_ENVIRONMENT.value is None and pm.get_running_process_module(ARM) is None
    return sorted(found), found["left"]


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_projections_side_by_side_do_not_depend_on_who_goes_first(backend):
    def check(outcome):
        return outcome == (["left", "right"], [WORLD])

    testing.explore(side_by_side, schedules=40, check=check, backend=backend)


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
@pytest.mark.parametrize("action", ["evaporate", "fail", "suspend-and-resume"])
def test_what_was_started_up_is_shut_down_whatever_happens(action, backend):
    def plan():
        try:
            cpl.top_level(lambda: project("world"))
        except cpl.PlanFailure:
            pass

    points = [point for point in testing.run(plan, backend=backend).points if point.task == "TOP-LEVEL"]
    assert len(points) > 3
    for point in points:
        for entering in (True, False):
            fault = faults.at(task="TOP-LEVEL", nth=point.number, action=action, entering=entering)
            outcome = testing.run(plan, backend=backend, faults=[fault])
            names = [event.name for event in outcome.trace]
            assert names.count("startup world") == names.count("shutdown world"), (point, names)
            if "body world" in names:
                assert_order(outcome.trace, ("startup world", "body world", "shutdown world"))
