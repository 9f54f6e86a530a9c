"""cramhy's machine: the runtime under the plan language, usable from Python without any Lisp.

The rooms, ground floor first: ``kernel`` (tasks, time), ``lisp`` (Common Lisp), ``utilities`` (``cut``), then ``transforms``,
``cpl``, ``prolog`` and ``ros``, then ``designators``, ``episodes`` and ``turtlesim``, then ``occasions``, ``process_modules``,
``projection``, then ``repl`` and ``testing``. A room imports only from the floors below its own, and importing this package imports
none of them.
"""

__version__ = "0.1.0"
