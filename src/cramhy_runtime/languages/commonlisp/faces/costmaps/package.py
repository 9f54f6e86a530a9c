"""What the library ``cram-location-costmap`` calls first: the package's functions and classes that are written in Python get their names.

The package itself, with what it uses and exports, is defined in the library.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.classes import register_class
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import find_package_or_error
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.robot_world.costmaps import costmap, costs, grids

from . import functions

SAME_NAMES = """width height origin-x origin-y resolution generator-function grid-width grid-height generator-name cost-functions
    make-padding-mask point-in-padding-mask-p occupancy-grid-put-mask points-mean points-cov occupancy-grid-mean occupancy-grid-covariance
    make-gauss-cost-function make-location-cost-function make-range-cost-function make-axis-boundary-cost-function
    make-occupancy-grid-cost-function make-padded-costmap-cost-function make-matrix-cost-function make-constant-height-function
    make-orientation-generator make-angle-to-point-generator register-cost-function register-height-generator
    register-orientation-generator get-cost-map get-map-value merge-costmaps gen-costmap-sample-point costmap-samples"""
NAMES = {
    "map-coordinate->array-index": functions.map_coordinate_to_array_index,
    "array-index->map-coordinate": functions.array_index_to_map_coordinate,
    "2d-value-map-lookup": functions.value_map_lookup,
    "2d-value-map-set": functions.value_map_set,
    "2d-cov": functions.two_d_cov,
    "2d-pose-covariance": functions.two_d_pose_covariance,
}
GENERIC = """width height origin-x origin-y resolution generator-function grid-width grid-height generator-name cost-functions get-cost-map
    get-map-value gen-costmap-sample-point costmap-samples register-cost-function register-height-generator
    register-orientation-generator 2d-value-map-lookup"""
"""Those that are generic in the original: users may define methods on them."""
INTERNAL = """occupied occupied-places pad-grid grid-of-values cached generate-by-function map-maximum heights-at has-height-generators
    orientations-at check-metadata visible-cells why-empty remark ready above"""
"""For the Lisp half of the library: `orientations_at` is ``%orientations-at``."""
CLASSES = (
    grids.GridMetadata,
    grids.OccupancyGrid,
    grids.ValueMap,
    grids.LazyValueMap,
    costmap.CostmapGenerator,
    costmap.FunctionCostmapGenerator,
    costmap.MapCostmapGenerator,
    functions.LispCostmap,
)


def define():
    """Give the functions and classes their names in the package, which must exist."""
    package = find_package_or_error(grids.PACKAGE)
    named = {name: getattr(functions, python_name(name)) for name in SAME_NAMES.split()} | NAMES
    named |= {"%" + name: getattr(functions, python_name(name)) for name in INTERNAL.split()}
    for name, function in named.items():
        package.intern(name.upper()).function = lispify(function)
    for name in GENERIC.split():
        open_to_methods(named[name], f"{grids.PACKAGE}::{name.upper()}")
    for cls in CLASSES:
        register_class(package.intern(cls.lisp_name.rpartition("::")[2]), cls)
    register_class(package.intern("COST-FUNCTION"), costs.Cost)
    return package
