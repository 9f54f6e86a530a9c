"""roslisp: the functions of a Lisp program on the graph. The program has one node.

The graph does not depend on this folder. Where the parts are, from the ground up:

* `master`    the master's address;  `clock` the time;  `log_file`, `logging` the log;  `errors` the conditions
* `node`      the node's life and its names;  `parameter_values`, `structs` Lisp values as parameters
* `topics`, `services`, `parameters`, `time`, `utilities`   the functions, as in the sections 6, 7, 8, 9, 11 of roslisp.md

``languages/commonlisp/faces/ros/package.py`` has the names for Lisp programs, ``languages/commonlisp/faces/ros/roslisp_printing.py``
prints these objects.
"""

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package

# Their tables are in languages/commonlisp/faces/ros/package.py; modules that only need some symbol find the packages here.
for _package in ("ROSLISP", "ROSLISP-UTILITIES"):
    ensure_package(_package, use=[COMMON_LISP])
