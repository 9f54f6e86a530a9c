"""cramhy's machine: the runtime under the plan language, usable from Python without any Lisp.

The rooms, ground floor first: ``kernel`` (tasks, time) and ``storage`` (files), ``lisp_core`` (what plans and languages share),
``utilities`` and ``transforms``, then ``cpl``, ``prolog`` and ``ros``, then ``designators``, ``turtlesim``, ``episodes``, ``actionlib``
and ``rosbridge``, then ``occasions`` and ``tf``, ``process_modules``, ``projection``, ``languages`` (Common Lisp), ``session`` (images),
then ``chronicle``, ``ros_tools`` and ``testing``, then ``view`` and ``repl``, and ``cli``. A room imports only from the floors below its
own, and importing this package imports none of them. ARCHITECTURE.md tells what stands where.
"""

__version__ = "0.1.0"
