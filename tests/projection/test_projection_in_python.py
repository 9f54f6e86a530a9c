"""Projection from Python: `projection_environment`, `project`, `projection_variable`."""

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import cpl, kernel
from cramhy_runtime.designators import Motion
from cramhy_runtime.process_modules import UnknownProcessModule, execute, process_module, process_modules
from cramhy_runtime.projection.python import project, projection_environment, projection_variable
from cramhy_runtime.session import Image


@pytest.fixture(params=ONE_BACKEND, autouse=True)
def plan(request):
    with Image(as_now=True):
        with cpl.plan(clock="virtual", backend=request.param):
            yield
        kernel.stop()


@pytest.fixture
def moved():
    return []


@pytest.fixture
def robot(moved):
    @process_module
    def base(motion):
        moved.append(motion.speed)
        return "moved"

    @process_module
    def imagined_base(motion):
        return f"would move at {motion.speed}"

    return base, projection_environment(modules={base: imagined_base})


def test_the_imagined_module_stands_for_the_real_one_while_that_runs(robot, moved):
    base, imagined = robot
    with process_modules(base):
        assert project(imagined, lambda: execute(base, Motion(speed=2))).value == "would move at 2"
        assert moved == []
        assert execute(base, Motion(speed=3)) == "moved"
    assert moved == [3]


def test_a_module_is_known_in_the_projection_only(robot):
    base, imagined = robot
    project(imagined, lambda: execute(base, Motion(speed=2)))
    with pytest.raises(UnknownProcessModule):
        execute(base, Motion(speed=2))


def test_variables_have_values_of_their_own_and_the_result_tells_them():
    place, belief = cpl.define_task_variable("place", "kitchen"), projection_variable("belief", lambda: [])
    imagined = projection_environment(variables={place: lambda: "hall"})

    def think():
        place.value += " door"
        belief.value.append("cup")

    result = project(imagined, think)
    assert (place.value, result.variables[place], result.variables[belief]) == ("kitchen", "hall door", ["cup"])
    assert project(imagined, lambda: list(belief.value)).value == []


def test_what_the_function_raises_comes_out_when_shutdown_has_run():
    calls = []
    imagined = projection_environment(startup=lambda: calls.append("begins"), shutdown=lambda: calls.append("ends"))
    with pytest.raises(ZeroDivisionError):
        project(imagined, lambda: 1 / 0)
    assert calls == ["begins", "ends"]


def test_two_projections_side_by_side_do_not_see_each_other(robot):
    base, imagined = robot

    @process_module
    def lazy_base(motion):
        cpl.sleep(1)
        return "stays"

    lazy = projection_environment(modules={base: lazy_base})
    with cpl.par() as branches:
        branches.start(lambda: project(imagined, lambda: execute(base, Motion(speed=2))).value)
        branches.start(lambda: project(lazy, lambda: execute(base, Motion(speed=2))).value)
    assert branches.results == ["would move at 2", "stays"]
