"""roslisp: what a Lisp program sees of the graph, as functions of the one node that the program has.

The graph below knows nothing of it and can be used without. Where the parts are, from the ground up:

* `master`    the master's address;  `clock` what time it is;  `log_file`, `logging` the log;  `errors` the conditions
* `node`      the node's life and its names;  `parameter_values`, `structs` what Lisp values are as parameters
* `topics`, `services`, `parameters`, `time`, `utilities`   the functions, as in the sections 6, 7, 8, 9, 11 of roslisp.md

The names that Lisp programs use for all this stand in ``languages/commonlisp/faces/ros/package.py``; how these objects print, in
``languages/commonlisp/faces/ros/roslisp_printing.py``.
"""

from cramhy_runtime.ground.packages import COMMON_LISP, ensure_package

# Their tables are in languages/commonlisp/faces/ros/package.py; modules that only need some symbol find the packages here.
for _package in ("ROSLISP", "ROSLISP-UTILITIES"):
    ensure_package(_package, use=[COMMON_LISP])
