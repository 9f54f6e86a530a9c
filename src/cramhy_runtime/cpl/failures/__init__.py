"""Failures: their classes, how they are handled and retried, and how they cross the border to Python.

Where the parts are: `failure_types` the classes · `handling` ``with-failure-handling`` · `retry_counters` · `debugging` when a task
stops in the debugger · `python_exceptions` which exception an ``except`` clause sees.
"""
