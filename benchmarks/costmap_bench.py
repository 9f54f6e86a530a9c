"""Location costmaps: computing one of 240 by 240 cells, drawing places, judging them.

    python benchmarks/costmap_bench.py

Microseconds of the processor, best and median round (``measuring.py``). The costmap has five of CRAM's own cost functions: an occupancy
grid, two rings, a normal distribution, a matrix. A function that a program wrote in Lisp is called for each cell. No figures of CRAM are
known.
"""

from __future__ import annotations

import sys
from statistics import median
from time import process_time

from measuring import Table, repeat, rounds

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
from cramhy_runtime.languages.commonlisp.reader.reader_functions import read_from_string
from cramhy_runtime.session import fresh_start

PROGRAM = """
(progn
  (setf *package* (find-package '#:costmap))
  (defun empty-map ()
    (make-instance 'location-costmap :width 12 :height 12 :origin-x -6 :origin-y -6 :resolution 0.05))
  (defvar *grid* (make-instance 'occupancy-grid :width 12 :height 12 :origin-x -6 :origin-y -6 :resolution 0.05))
  (occupancy-grid-put-mask 0 0 *grid* (make-padding-mask 31))
  (defvar *matrix* (make-array '(240 240) :initial-element 0.5d0))
  (defvar *functions*
    (list (make-occupancy-grid-cost-function *grid* :invert t)
          (make-range-cost-function (make-3d-vector 1 1 0) 2)
          (make-range-cost-function (make-3d-vector 1 1 0) 0.2 :invert t)
          (make-gauss-cost-function (make-3d-vector 1 1 0) '((0.5 0.1) (0.1 0.5)))
          (make-matrix-cost-function -6 -6 0.05 *matrix*)))
  (defun computed (&rest functions)
    (let ((map (empty-map)))
      (loop for function in functions for score from 1 do (register-cost-function map function score))
      (get-map-value map 0 0)
      map))
  (defvar *map* (apply #'computed *functions*))
  (register-height-generator *map* (make-constant-height-function 0.0))
  (register-orientation-generator *map* (make-angle-to-point-generator (make-3d-vector 1 1 0) :samples 2 :sample-step 0.1)))
"""


def lisp(text):
    """The value of the form in ``text``."""
    return one(evaluate(one(read_from_string(text))))


def main():
    try:
        import numpy  # noqa: F401
    except ImportError:
        sys.exit("Costmaps need numpy, which comes with the extra robot.")
    fresh_start(turtlesim=False)
    lisp("(in-package #:costmap)")
    sym("*PACKAGE*").value = sym("COSTMAP::*Z-PADDING*").package
    lisp(PROGRAM)
    table = Table("location costmaps", kernel.active().backend.name)

    def row(name, work, count, goal=None):
        """What the processor spent: the rounds are long, and others' turns fall into them."""
        times = rounds(work, count, process_time)
        table.line(name, min(times), median(times), goal)

    row("240 x 240 cells, 5 functions", repeat(lisp("(lambda () (apply #'computed *functions*))")), 5, goal=5000)
    row("240 x 240 cells, a function in Lisp", repeat(lisp("(lambda () (computed (lambda (x y) (* 0.1 (+ 20 x y)))))")), 1)
    lisp("(defvar *samples* (costmap-samples *map*))")
    row("pose drawn", lisp("(lambda (n) (loop repeat n do (setf *samples* (lazy-cdr *samples*))))"), 1000, goal=100)
    row("value of a place", repeat(lisp("(lambda () (get-map-value *map* 1.2 0.4))")), 1000)
    table.end()


if __name__ == "__main__":
    main()
