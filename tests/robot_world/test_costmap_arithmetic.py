"""The arithmetic of costmaps, without Lisp: grids, masks, cost functions at once and one by one, and drawing."""

from __future__ import annotations

import collections
import importlib
import math
import random
import sys

import pytest

np = pytest.importorskip("numpy", reason="needs numpy")

from cramhy_runtime import kernel  # noqa: E402  what follows needs numpy
from cramhy_runtime.extras import install_command  # noqa: E402
from cramhy_runtime.lisp_core.conditions import Condition  # noqa: E402
from cramhy_runtime.session.boot import define_costmaps  # noqa: E402
from cramhy_runtime.robot_world.costmaps import costmap, costs, generators, grids, spread  # noqa: E402


@pytest.fixture(autouse=True)
def running_kernel():
    kernel.start(clock="virtual")
    yield
    kernel.stop()


def a_map(*functions, size=2, **geometry):
    made = costmap.LocationCostmap(**{"width": size, "height": size, "origin_x": 0, "origin_y": 0, "resolution": 1, **geometry})
    for score, function in enumerate(functions):
        made.register(function, score)
    return made


def half_occupied():
    grid = grids.OccupancyGrid(width=3, height=2, origin_x=-1, origin_y=0, resolution=0.5)
    grid.put(-0.5, 0.5, grids.padding_mask(1))
    grid.put(0.5, 1.0, grids.padding_mask(3))
    return grid


COSTS = {
    "gauss": costs.Gauss((0.3, 0.4), [[0.5, 0], [0, 0.2]]),
    "gauss, turned": costs.Gauss((0.3, 0.4, 7), [[0.5, 0.1], [0.1, 0.2]]),
    "range": costs.Range(0.1, 0.2, 1),
    "range, inverted": costs.Range(0.1, 0.2, 1, True),
    "boundary": costs.AxisBoundary("x", 0.25, lambda value, limit: value < limit),
    "boundary of y": costs.AxisBoundary("y", 0.25, lambda value, limit: value > limit),
    "occupancy": costs.Occupancy(half_occupied()),
    "occupancy, inverted": costs.Occupancy(half_occupied(), True),
    "matrix": costs.Matrix(-0.5, -0.5, 0.5, [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]),
}


@pytest.mark.parametrize("cost", COSTS.values(), ids=COSTS)
def test_a_cost_function_gives_a_grid_what_it_gives_each_place(cost):
    geometry = {"size": 3, "origin_x": -1, "origin_y": -1, "resolution": 0.25}
    at_once, one_by_one = a_map(cost, **geometry), a_map(lambda x, y: cost(x, y), **geometry)
    assert np.allclose(at_once.values(), one_by_one.values(), rtol=1e-12)


def test_a_range_includes_its_end():
    assert [costs.Range(0, 0, 0.3)(x, 0) for x in (0.1 + 0.2, 0.31)] == [1, 0]


def test_a_matrix_of_covariances_without_an_inverse_is_refused():
    with pytest.raises(ValueError, match="not positive definite"):
        costs.Gauss((0, 0), [[1, 1], [1, 1]])


def test_a_cell_that_is_0_is_not_asked_again():
    asked = []
    made = a_map(lambda x, y: asked.append((x, y)) or 1, lambda x, y: float(x == 0))
    assert made.values().tolist() == [[0.5, 0], [0.5, 0]]
    assert asked == [(0, 0), (0, 1)]


@pytest.mark.parametrize("cost", [-1, math.nan, math.inf, None, "much", True])
def test_a_cost_that_is_not_a_number_from_0_on_is_an_error(cost):
    with pytest.raises(Condition) as problem:
        a_map(lambda x, y: cost).values()
    assert "The cost function 0 gave" in problem.value.report() and "A number from 0 to 1 is wanted." in problem.value.report()


def test_nothing_possible_names_the_functions_up_to_the_one_that_left_nothing():
    made = a_map(costs.Range(0, 0, 1), costs.Range(0, 0, 9, True), costs.Range(0, 0, 1))
    with pytest.raises(costmap.NothingPossible) as problem:
        made.values()
    assert problem.value.names == [2, 1]


def test_without_functions_there_are_no_values():
    with pytest.raises(costmap.NoCostFunctions):
        a_map().values()


def test_of_one_name_the_first_registered_counts_and_of_merged_maps_the_last_map():
    first, second = a_map(), a_map()
    for function in (costs.Range(0, 0, 0), costs.Range(0, 0, 9)):
        first.register(function, 5)
    second.register(costs.Range(1, 1, 0), 5)
    second.register(costs.Range(0, 0, 9), 5.0)  # another name
    assert first.values().tolist() == [[1, 0], [0, 0]]
    assert costmap.merged([first, second]).values().tolist() == [[0, 0], [0, 1]]


def test_cells_are_drawn_as_often_as_their_values_say():
    made = a_map(lambda x, y: (1 + x) * (1 + 2 * y))  # 1 2 / 3 6
    draw = random.Random(1)
    counts = collections.Counter(made.draw(draw.random) for _ in range(12_000))
    assert set(counts) == {(0, 0), (1, 0), (0, 1), (1, 1)}
    for (column, row), count in counts.items():
        assert abs(count - 1000 * (1 + column) * (1 + 2 * row)) < 200
    assert made.draw(lambda: 0.0) == (0, 0) and made.draw(lambda: math.nextafter(1, 0)) == (1, 1)


def test_a_drawn_place_is_in_the_cell_it_was_drawn_from():
    made = a_map(lambda x, y: 1, size=12, origin_x=-6, origin_y=-6, resolution=0.05)
    for column in range(240):
        x = grids.coordinate_of(column, made.resolution, made.origin_x)
        assert made.cell(x, x) == (column, column) and grids.array_index(x, made.resolution, made.origin_x) == column


def test_outside_of_the_grid_the_value_is_0():
    made = a_map(lambda x, y: 1)
    assert [made.value(x, 0) for x in (-0.5, 0, 1.9, 2)] == [0, 0.25, 0.25, 0]


@pytest.mark.parametrize("size, rows", [(1, ["1"]), (3, ["010", "111", "010"]), (5, ["00100", "01110", "11111", "01110", "00100"])])
def test_masks_are_discs(size, rows):
    assert ["".join(map(str, row)) for row in grids.padding_mask(size).tolist()] == rows


def test_padding_widens_what_is_occupied_and_stops_at_the_edge():
    grid = grids.OccupancyGrid(width=5, height=3, resolution=1)
    grid.put(0, 1, grids.padding_mask(1))
    grid.put(4, 2, grids.padding_mask(1), raw=True)
    assert grid.places().tolist() == [[0, 1], [4, 2]]
    assert grid.pad(1).grid.tolist() == [[1, 0, 0, 0, 0], [1, 1, 0, 0, 1], [1, 0, 0, 1, 1]]
    assert grid.touches(2, 0, grids.padding_mask(1)) is False and grid.touches(2, 2, grids.padding_mask(3)) is True
    grid.put(-9, -9, grids.padding_mask(3))  # beside the grid
    assert grid.invert().grid.sum() == 15 - 7


@pytest.mark.parametrize(
    "geometry, text",
    [
        ({"width": "wide"}, "is not of type"),
        ({"resolution": 0}, "has no cells"),
        ({"height": -1}, "has no cells"),
        ({"width": math.nan}, "has no cells"),
        ({"resolution": 1e-9}, "too many cells: the most is 16,000,000"),
    ],
)
def test_a_geometry_that_makes_no_grid_is_an_error(geometry, text):
    with pytest.raises(Condition) as problem:
        a_map(**geometry)
    assert text in problem.value.report()


def test_a_fan_of_directions():
    assert generators.fan(0, 5, 2) == [0, 2, -2, 4, -4]


def test_means_and_covariances():
    places = [(0, 0, 0), (2, 0, 0), (0, 4, 0), (2, 4, 0)]
    assert spread.mean(places).tolist() == [1, 2, 0]
    assert spread.covariance(places).tolist() == [[1, 0, 0], [0, 4, 0], [0, 0, 0]]
    assert spread.wide_covariance(places, 2).tolist() == [[2, 0], [0, 4]]
    assert spread.wide_covariance([(1, 1, 1)]).tolist() == [[0.1, 0], [0, 0.1]]


def test_without_numpy_one_line_says_what_to_install(monkeypatch, session):
    for name in [name for name in sys.modules if ".costmaps" in name]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "numpy", None)
    wanted = f"Costmaps need the Python package numpy, which is not installed. Type: {install_command('robot')}"
    importlib.import_module("cramhy_runtime.robot_world.costmaps")  # the folder itself needs nothing
    with pytest.raises(ImportError) as problem:
        importlib.import_module("cramhy_runtime.robot_world.costmaps.costmap")
    assert str(problem.value) == wanted
    with pytest.raises(Condition) as condition:
        define_costmaps()
    assert condition.value.report() == wanted


def test_a_map_of_240_by_240_cells_is_computed_in_a_moment():
    """The processor's time, best of several, with room for a slow machine: here it takes 1 ms."""
    from time import process_time

    def once():
        grid = grids.OccupancyGrid(width=12, height=12, origin_x=-6, origin_y=-6, resolution=0.05)
        grid.put(0, 0, grids.padding_mask(31))
        made = a_map(
            costs.Matrix(-6, -6, 0.05, np.ones((240, 240))),
            costs.Gauss((1, 1), [[0.5, 0], [0, 0.5]]),
            costs.Range(1, 1, 0.2, True),
            costs.Range(1, 1, 2),
            costs.Occupancy(grid, True),
            **grid.geometry(),
        )
        start = process_time()
        made.values()
        return process_time() - start

    assert min(once() for _ in range(5)) < 0.05
