"""Location costmaps: where to stand, as a distribution over the cells of a grid.

A costmap is a grid with cost functions. Each gives every cell a number from 0 to 1, their product is normalised, and places are drawn
from it with those probabilities (CRAM's ``cram_location_costmap``). The modules, from the lowest:

* ``arrays``: numpy, and what is said when it is missing,
* ``grids``: the geometry of a grid, occupancy grids, masks, maps of values,
* ``costs``: the cost functions that come along; each knows its values over a whole grid at once,
* ``spread``: means and covariances of places,
* ``generators``: height and orientation generators,
* ``costmap``: the map itself: registering, computing, merging, drawing.

Nothing here knows Lisp: a cost function is any callable of x and y. Source: mobile-manipulation.md section 9.
"""
