"""The functions of the package CRAM-LOCATION-COSTMAP that compute: Lisp's arguments in, Lisp's objects out.

What is better said in Lisp (generic functions, hooks, facts, the search for places) is in ``libraries/cram-location-costmap``, which calls
the functions with a ``%``. Source: mobile-manipulation.md section 9.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from, one, python_list, truth
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import intern, keyword, sym
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.robot_world import remarks
from cramhy_runtime.robot_world.costmaps import costmap, costs, generators, grids, spread
from cramhy_runtime.robot_world.costmaps.arrays import np
from cramhy_runtime.robot_world.costmaps.grids import PACKAGE
from cramhy_runtime.transforms.coercion import slot_reader, wrong_type
from cramhy_runtime.transforms.poses import Pose
from cramhy_runtime.transforms.quaternions import Quaternion
from cramhy_runtime.transforms.vectors import Vector3, point, vector
from cramhy_runtime.utilities.lazy_lists import from_iterator

from ...numbers.random_state import RANDOM_STATE
from ...numbers.random_state import random as random_number
from .matrices import lisp_matrix, numpy_matrix, numpy_vector

if TYPE_CHECKING:
    from collections.abc import Callable

X, Y = keyword("X"), keyword("Y")
ONE = 1.0


def _reader(name, *classes):
    return slot_reader(name, *classes, package=PACKAGE)


width = _reader("width", grids.GridMetadata)
height = _reader("height", grids.GridMetadata)
origin_x = _reader("origin-x", grids.GridMetadata)
origin_y = _reader("origin-y", grids.GridMetadata)
resolution = _reader("resolution", grids.GridMetadata)
generator_function = _reader("generator-function", costmap.CostmapGenerator, grids.LazyValueMap)


def grid_width(grid: Any) -> int:
    """The number of columns of a grid."""
    return _instance(grid, grids.GridMetadata, "GRID").columns


def grid_height(grid: Any) -> int:
    """The number of rows of a grid."""
    return _instance(grid, grids.GridMetadata, "GRID").rows


def generator_name(generator: Any) -> Any:
    """The name that a cost function was registered under."""
    return _instance(generator, costmap.CostmapGenerator, "GENERATOR").name


def remark(map: Any) -> None:
    """Tell those who look on that places are drawn from a costmap."""
    remarks.costmap(_costmap(map))


def cost_functions(map: Any) -> Any:
    """The costmap-generators of a costmap, a list, the newest first."""
    return list_from(_costmap(map).generators)


def _instance(thing: Any, cls: type, parameter: str) -> Any:
    return thing if isinstance(thing, cls) else wrong_type(thing, sym(cls.lisp_name), parameter, package=PACKAGE)


def _costmap(map: Any) -> costmap.LocationCostmap:
    return _instance(map, costmap.LocationCostmap, "MAP")


def _real(value: Any, parameter: str) -> float:
    return float(value) if is_real(value) else wrong_type(value, "REAL", parameter, package=PACKAGE)


# ------------------------------------------------------------------------------------------------------------------- grids


def map_coordinate_to_array_index(coordinate: Any, resolution: Any, origin: Any) -> int:
    """The index of the cell that a coordinate is in."""
    return grids.array_index(_real(coordinate, "COORDINATE"), _real(resolution, "RESOLUTION"), _real(origin, "ORIGIN"))


def array_index_to_map_coordinate(index: Any, resolution: Any, origin: Any) -> float:
    """The coordinate of a cell."""
    return float(grids.coordinate_of(_real(index, "INDEX"), _real(resolution, "RESOLUTION"), _real(origin, "ORIGIN")))


def value_map_lookup(map: Any, x: Any, y: Any) -> Any:
    """The value of the cell at x and y."""
    return _instance(map, grids.ValueMap, "MAP").lookup(x, y)


def value_map_set(map: Any, x: Any, y: Any, value: Any) -> Any:
    """Set the value of the cell at x and y; returns it."""
    return _instance(map, grids.ValueMap, "MAP").set(x, y, value)


def make_padding_mask(size: Any) -> Any:
    """A disc of ones in a matrix of ``size`` by ``size`` cells."""
    if size.__class__ is not int or not 0 < size <= 4096:
        return wrong_type(size, lisp_list(sym("INTEGER"), 1, 4096), "SIZE", package=PACKAGE)
    mask = lisp_matrix(grids.padding_mask(size))
    mask.storage, mask.element_type = [int(value) for value in mask.storage], True
    return mask


def point_in_padding_mask_p(map: Any, x: Any, y: Any, range_mask: Any) -> Any:
    """Whether a cell below the mask, its middle at x and y, is occupied."""
    grid = _instance(map, grids.OccupancyGrid, "MAP")
    return grid.touches(_real(x, "X"), _real(y, "Y"), numpy_matrix(range_mask) > 0) or None


def occupancy_grid_put_mask(x: Any, y: Any, grid: Any, mask: Any, *, coords_raw_p: Any = None) -> Any:
    """Occupy the cells of a mask, its middle at x and y; with ``:coords-raw-p`` these are a column and a row. Returns the grid."""
    _instance(grid, grids.OccupancyGrid, "GRID").put(_real(x, "X"), _real(y, "Y"), numpy_matrix(mask) > 0, truth(coords_raw_p))
    return grid


def occupied(grid: Any, x: Any, y: Any) -> Any:
    """Whether the cell at x and y is occupied."""
    return _instance(grid, grids.OccupancyGrid, "GRID").occupied(_real(x, "X"), _real(y, "Y")) or None


def occupied_places(grid: Any) -> Any:
    """The places of the occupied cells, a list of lists (x y)."""
    places = _instance(grid, grids.OccupancyGrid, "GRID").places().tolist()
    return list_from([lisp_list(float(x), float(y)) for x, y in places])


def pad_grid(grid: Any, padding: Any, inverted: Any = None) -> Any:
    """Exchange occupied and free cells if ``inverted``, then widen what is occupied by ``padding`` metres. Returns the grid."""
    _instance(grid, grids.OccupancyGrid, "GRID")
    if truth(inverted):
        grid.invert()
    return grid.pad(0.0 if padding is None else _real(padding, "PADDING"))


def grid_of_values(metadata: Any, values: Any, accept: Any) -> Any:
    """The occupancy grid whose cells are those of ``values`` (row by row) for which ``accept(value)`` is true."""
    grid = grids.OccupancyGrid(**_instance(metadata, grids.GridMetadata, "METADATA").geometry())
    values = list(python_list(values) if values is None or isinstance(values, Cons) else values)
    if len(values) != grid.rows * grid.columns:
        return error("The message has ~d cells, but says that it is ~d by ~d.", len(values), grid.columns, grid.rows)
    accept = function_of(accept)
    chosen = {value: truth(accept(value)) for value in set(values)}
    grid.grid = np.array([chosen[value] for value in values], np.uint8).reshape(grid.rows, grid.columns)
    return grid


# --------------------------------------------------------------------------------------------------------------- statistics


def _places(points: Any) -> Any:
    points = python_list(points) if points is None or isinstance(points, Cons) else points
    if not points:
        return error("The mean of no points is wanted.")
    return np.array([point(getattr(each, "origin", each), "PTS") for each in points])


def points_mean(pts: Any) -> Vector3:
    """The mean of points (or poses), a 3d-vector."""
    return vector(tuple(spread.mean(_places(pts)).tolist()))


def points_cov(pts: Any, mean: Any = None) -> Any:
    """The 3 by 3 matrix of covariances of points (or poses) around ``mean``."""
    return lisp_matrix(spread.covariance(_places(pts), None if mean is None else numpy_vector(mean)))


def two_d_cov(cov: Any) -> Any:
    """The part of a matrix of covariances that is about x and y."""
    return lisp_matrix(numpy_matrix(cov)[:2, :2])


def two_d_pose_covariance(positions: Any, minimal_variance: Any = 0.1) -> Any:
    """The list of the mean of positions (or poses) and their 2 by 2 matrix of covariances.

    The variances are at least ``minimal-variance``.
    """
    matrix = spread.wide_covariance(_places(positions), _real(minimal_variance, "MINIMAL-VARIANCE"))
    return lisp_list(points_mean(positions), lisp_matrix(matrix))


def _occupied_places(grid: Any) -> Any:
    places = _instance(grid, grids.OccupancyGrid, "GRID").places()
    return np.column_stack([places, np.zeros(len(places))]) if len(places) else error("No cell of ~s is occupied.", grid)


def occupancy_grid_mean(grid: Any) -> Vector3:
    """The mean of the occupied cells, a 3d-vector."""
    return vector(tuple(spread.mean(_occupied_places(grid)).tolist()))


def occupancy_grid_covariance(grid: Any, mean: Any = None) -> Any:
    """The 2 by 2 matrix of covariances of the occupied cells."""
    return lisp_matrix(spread.covariance(_occupied_places(grid)[:, :2], None if mean is None else numpy_vector(mean)))


# ----------------------------------------------------------------------------------------------------------- cost functions


def make_gauss_cost_function(mean: Any, covariance: Any) -> costs.Cost:
    """The density of the normal distribution around ``mean``, a point or pose."""
    mean, matrix = numpy_vector(mean), numpy_matrix(covariance)
    try:
        return costs.Gauss(mean, matrix)
    except ValueError as problem:
        return error("~a", str(problem))


def make_location_cost_function(loc: Any, std_dev: Any) -> costs.Cost:
    """The density of the normal distribution around a pose, with the standard deviation ``std-dev`` along both axes."""
    variance = _real(std_dev, "STD-DEV") ** 2
    return make_gauss_cost_function(loc, np.diag([variance, variance]))


def make_range_cost_function(pose: Any, distance: Any, *, invert: Any = None) -> costs.Cost:
    """1 up to ``distance`` from the pose or point, 0 beyond; with ``:invert`` the other way round."""
    x, y = numpy_vector(pose)[:2].tolist()
    return costs.Range(x, y, _real(distance, "DISTANCE"), truth(invert))


def make_axis_boundary_cost_function(axis: Any, boundary: Any, predicate: Any) -> costs.Cost:
    """1 where ``(predicate coordinate boundary)`` is true of the coordinate on ``axis``, ``:x`` or ``:y``."""
    if axis is not X and axis is not Y:
        return wrong_type(axis, lisp_list(sym("MEMBER"), X, Y), "AXIS", package=PACKAGE)
    function = function_of(predicate)
    return costs.AxisBoundary("x" if axis is X else "y", boundary, lambda coordinate, limit: truth(one(function(coordinate, limit))))


def make_occupancy_grid_cost_function(grid: Any, *, invert: Any = None) -> costs.Cost:
    """1 in occupied cells, 0 elsewhere; with ``:invert`` the other way round."""
    return costs.Occupancy(_instance(grid, grids.OccupancyGrid, "GRID"), truth(invert))


def make_padded_costmap_cost_function(costmap: Any, padding: Any, *, invert: Any = None) -> costs.Cost:
    """1 where a cell of ``costmap`` within ``padding`` metres is not 0; with ``:invert`` the other way round."""
    values = cost_array(costmap)
    grid = grids.OccupancyGrid(**costmap.geometry())
    grid.grid = (values > 0).astype(np.uint8)
    return costs.Occupancy(grid.pad(_real(padding, "PADDING")), truth(invert))


def make_matrix_cost_function(origin_x: Any, origin_y: Any, resolution: Any, matrix: Any) -> costs.Cost:
    """The elements of ``matrix``, whose rows are y, on a grid of its own; 0 outside."""
    return costs.Matrix(_real(origin_x, "ORIGIN-X"), _real(origin_y, "ORIGIN-Y"), _real(resolution, "RESOLUTION"), numpy_matrix(matrix))


# --------------------------------------------------------------------------------------------------- heights and orientations


def make_constant_height_function(height: Any) -> Any:
    """A height generator that gives ``height`` everywhere."""
    _real(height, "HEIGHT")
    return lambda x, y: lisp_list(height)


def make_orientation_generator(
    main_direction_function: Any, *, samples: Any = 1, sample_step: Any = None, sample_offset: Any = None
) -> Any:
    """A generator that keeps the orientations so far; without any, it gives ``samples`` around the direction, ``sample-step`` apart.

    sample_offset: how far the direction is turned, in radians; ``None`` for 0.
    """
    direction = function_of(main_direction_function)
    if samples.__class__ is not int or samples < 1:
        return wrong_type(samples, lisp_list(sym("INTEGER"), 1), "SAMPLES", package=PACKAGE)
    step = 0.0 if sample_step is None else _real(sample_step, "SAMPLE-STEP")
    if samples > 1 and sample_step is None:
        return error("~d orientations are wanted, and :SAMPLE-STEP, the angle between them, is missing.", samples)
    offset = 0.0 if sample_offset is None else _real(sample_offset, "SAMPLE-OFFSET")
    generate = generators.orientations(lambda x, y: _real(one(direction(x, y)), "DIRECTION") + offset, samples, step)

    def orientations(x, y, previous):
        given = generate(x, y, previous)
        return list_from(given) if given.__class__ is list else given

    return orientations


def make_angle_to_point_generator(position: Any, *, samples: Any = 1, sample_step: Any = None, sample_offset: Any = None) -> Any:
    """A generator of orientations towards a point; see `make_orientation_generator`."""
    x, y = numpy_vector(position)[:2].tolist()
    return make_orientation_generator(generators.towards(x, y), samples=samples, sample_step=sample_step, sample_offset=sample_offset)


def cached(costmap: Any, function: Any) -> Any:
    """A function of x, y and perhaps more that calls ``function`` once for each cell of ``costmap``, and remembers."""
    known: dict[Any, Any] = {}
    function, grid = function_of(function), _costmap(costmap)

    def remember(x, y, *others):
        cell = grid.cell(x, y)
        if cell not in known:
            known[cell] = one(function(x, y, *others))
        return known[cell]

    return remember


# ----------------------------------------------------------------------------------------------------------------- costmaps


def register_cost_function(map: Any, fun: Any, name: Any) -> Any:
    """Enter a function of x and y, or a costmap-generator, under ``name``. A map that is computed already stays as it is."""
    _costmap(map).register(fun if isinstance(fun, costmap.CostmapGenerator) else _function(fun, "FUN"), name)
    return map


def _function(function: Any, parameter: str) -> Any:
    found = function_of(function)
    return found if callable(found) else wrong_type(function, sym("FUNCTION"), parameter, package=PACKAGE)


def register_height_generator(costmap: Any, generator: Any) -> Any:
    """Enter a function of x and y that returns a list of heights, beside those that are there."""
    _costmap(costmap).register_height_generator(_function(generator, "GENERATOR"))
    return costmap


def register_orientation_generator(costmap: Any, generator: Any) -> Any:
    """Enter a function of x, y and the orientations so far; those registered earlier see what it gives, and may override it."""
    _costmap(costmap).register_orientation_generator(_function(generator, "GENERATOR"))
    return costmap


def generate_by_function(generator: Any, map: Any, metadata: Any) -> Any:
    """The method of ``generate`` for CRAM's own generators: the matrix ``map`` times the costs, a new matrix."""
    _instance(generator, costmap.CostmapGenerator, "GENERATOR")
    if isinstance(generator, costmap.MapCostmapGenerator):
        return one(generator.generator_function(metadata, map))
    return lisp_matrix(generator.generate(numpy_matrix(map), _instance(metadata, grids.GridMetadata, "METADATA")))


def _generic(name: str) -> Any:
    """A generic function of the Lisp half of the library: that of the present image, since each loads the library for itself."""
    return intern(name, PACKAGE).function


def score(name: Any) -> Any:
    """What the generic function ``costmap-generator-name->score`` gives for a name."""
    return _real(one(_generic("COSTMAP-GENERATOR-NAME->SCORE")(name)), "SCORE")


def run(generator: Any, matrix: Any, metadata: Any) -> Any:
    """Let a generator multiply a matrix: CRAM's own for functions at once, others by the generic function ``generate``."""
    if generator.__class__ is costmap.FunctionCostmapGenerator:
        return generator.generate(matrix, metadata)
    result = numpy_matrix(one(_generic("GENERATE")(generator, lisp_matrix(matrix), metadata)))
    if result.shape != matrix.shape:
        return error("The generator ~s gave a matrix of another size: ~s instead of ~s.", generator.name, *map_texts(result, matrix))
    return result


class LispCostmap(costmap.LocationCostmap):
    """A costmap whose scores and generators are those of Lisp's generic functions."""

    lisp_name = costmap.LocationCostmap.lisp_name
    score = staticmethod(score)
    run = staticmethod(run)


def map_texts(*arrays: Any) -> list[str]:
    """The sizes of arrays, as texts."""
    return [" x ".join(map(str, array.shape)) for array in arrays]


NO_FUNCTIONS = f"{PACKAGE}::NO-COST-FUNCTIONS-REGISTERED"


def cost_array(map: Any) -> Any:
    """The values of a costmap as an array of numpy; CRAM's conditions for one without functions, or that is 0 everywhere."""
    return _computed(map, _costmap(map).values)


def ready(map: Any) -> None:
    """Find that places can be drawn from a costmap, or raise the conditions of `cost_array`. Slow functions are asked about few cells."""
    _computed(map, _costmap(map).ready)


def above(map: Any, x: Any, y: Any, part: Any) -> Any:
    """Whether the value at x and y is more than that part of the greatest value."""
    return _computed(map, lambda: map.above(_real(x, "X"), _real(y, "Y"), _real(part, "PART"))) or None


def _computed(map: Any, compute: Callable[[], Any]) -> Any:
    try:
        return compute()
    except costmap.NoCostFunctions:
        return _signal(NO_FUNCTIONS)
    except costmap.NothingPossible as problem:
        map.views["why empty"] = why = _why_empty(problem.names)
        return _signal("CRAM-MATH::INVALID-PROBABILITY-DISTRIBUTION", why)


def _signal(name: str, hint: str | None = None) -> Any:
    package, _, symbol = name.rpartition("::")
    return error(make_instance(intern(symbol, package)), hint=hint)


def _why_empty(names: list[Any]) -> str:
    """A sentence that tells which cost function left nothing."""
    last, *others = [prin1_to_string(name).lower() for name in reversed(names)]
    if not others:
        return f"The cost function {last} is 0 in every cell."
    return f"The cost function {last} is 0 wherever {' and '.join(reversed(others))} {'is' if len(others) == 1 else 'are'} not."


def why_empty(map: Any) -> Any:
    """Which cost function left nothing of a costmap whose values were found to be 0 everywhere: a sentence."""
    return _costmap(map).views.get("why empty")


def get_cost_map(map: Any) -> Any:
    """The matrix of a costmap's values, whose rows are y and whose sum is 1; computed once."""
    cost_array(map)
    return map.view("matrix", lisp_matrix)


def get_map_value(map: Any, x: Any, y: Any) -> float:
    """The value of the cell at x and y; 0 outside of the map."""
    cost_array(map)
    return map.value(_real(x, "X"), _real(y, "Y"))


def map_maximum(map: Any) -> float:
    """The greatest value of a costmap."""
    cost_array(map)
    return float(map.maximum)


def merge_costmaps(cm_1: Any, *costmaps: Any) -> Any:
    """A new costmap with all functions and generators, and the geometry of the first. ``cm-1`` may be a list, lazy or not."""
    given = [*(python_list(cm_1) if cm_1 is None or isinstance(cm_1, Cons) else [cm_1]), *costmaps]
    return costmap.merged(map(_costmap, given)) if given else error("No costmaps are given to be merged.")


def chance() -> float:
    """A random number from 0 to below 1, of the session's ``*random-state*``."""
    return random_number(ONE, RANDOM_STATE.value)


def _heights(map: Any, x: Any, y: Any) -> list[Any]:
    return [height for generate in map.height_generators for height in (one(generate(x, y)) or ())]


def heights_at(map: Any, x: Any, y: Any) -> Any:
    """All heights that the height generators give at x and y, a list."""
    return list_from(_heights(_costmap(map), x, y))


def has_height_generators(map: Any) -> Any:
    """Whether a costmap has height generators."""
    return bool(_costmap(map).height_generators) or None


def gen_costmap_sample_point(map: Any, *, sampling_function: Any = None) -> Vector3:
    """A place drawn from the costmap, a 3d-vector. Its height is one of those of the height generators, or 0.

    ``sampling-function``: a function of the matrix that gives the list (column row); by default cells are drawn by their values.
    """
    ready(map)
    if sampling_function is None:
        column, row = map.draw(chance)
    else:
        column, row = _cell_of(one(_function(sampling_function, "SAMPLING-FUNCTION")(get_cost_map(map))))
    x = grids.coordinate_of(column, map.resolution, map.origin_x)
    y = grids.coordinate_of(row, map.resolution, map.origin_y)
    heights = _heights(map, float(x), float(y)) if map.height_generators else ()
    z = 0.0 if not heights else heights[0] if len(heights) == 1 else heights[random_number(len(heights), RANDOM_STATE.value)]
    return vector((x, y, _real(z, "HEIGHT")))


def _cell_of(answer: Any) -> Any:
    cell = python_list(answer) if isinstance(answer, Cons) else ()
    if len(cell) != 2 or not all(number.__class__ is int for number in cell):
        return error("A sampling function returns the list (column row), not ~s.", answer)
    return cell


def orientations_at(map: Any, x: Any, y: Any) -> Any:
    """The orientations of a place: the generators in turn, each with what the one before gave; without any, the identity."""
    found = None
    for generate in _costmap(map).orientation_generators:
        found = one(generate(float(x), float(y), found))
    return found or lisp_list(Quaternion())


def costmap_samples(map: Any, *, sampling_function: Any = None) -> Any:
    """The endless lazy list of poses drawn from the costmap; each drawn place comes with all its orientations."""
    ready(map)

    show = _generic("ON-VISUALIZE-COSTMAP-SAMPLE")

    def poses():
        while True:
            place = gen_costmap_sample_point(map, sampling_function=sampling_function)
            show(place)
            x, y, _ = place.components
            for orientation in python_list(orientations_at(map, x, y)):
                yield Pose(place, orientation)

    return from_iterator(poses())


def check_metadata(width: Any, height: Any, origin_x: Any, origin_y: Any, resolution: Any) -> Any:
    """The list of initargs for a costmap; figures that are not numbers, or make no grid, are errors."""
    made = grids.GridMetadata(width=width, height=height, origin_x=origin_x, origin_y=origin_y, resolution=resolution)
    return list_from([part for name, attribute in made.initargs.items() for part in (keyword(name), getattr(made, attribute))])


def visible_cells(map: Any, threshold: Any) -> Any:
    """The cells whose value is at least ``threshold`` times the maximum: a list of (x y value/maximum)."""
    values = cost_array(map) / map.maximum
    cells = np.argwhere(values >= _real(threshold, "THRESHOLD"))
    return list_from(
        [
            lisp_list(
                float(grids.coordinate_of(column, map.resolution, map.origin_x)),
                float(grids.coordinate_of(row, map.resolution, map.origin_y)),
                float(values[row, column]),
            )
            for row, column in cells.tolist()
        ]
    )
