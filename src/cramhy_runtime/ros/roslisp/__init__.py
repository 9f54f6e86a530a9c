"""roslisp: what a Lisp program sees of the graph, as functions of the one node that the program has.

The graph below knows nothing of it and can be used without. Where the parts are, from the ground up:

* `master`    the master's address;  `clock` what time it is;  `log_file`, `logging` the log;  `errors` the conditions
* `node`      the node's life and its names;  `parameter_values`, `structs` what Lisp values are as parameters
* `topics`, `services`, `parameters`, `time`, `utilities`   the functions, as in the sections 6, 7, 8, 9, 11 of roslisp.md
* `printing`  how these objects print

The names that Lisp programs use for all this stand in ``ros/package.py``.
"""

from ...lisp.faces import define_face

# Their tables are in ros/package.py; modules that only need some symbol find the packages here.
for _package in ("ROSLISP", "ROSLISP-UTILITIES"):
    define_face(_package, use=["COMMON-LISP"])
