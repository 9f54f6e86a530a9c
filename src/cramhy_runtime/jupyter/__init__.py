"""Jupyter: notebooks whose cells are Common Lisp or Hy, answered by a session.

It needs the extra ``jupyter``, and nothing of it is loaded until somebody asks. What a cell, a key or the stop button asks for is done
by the room ``session``, as for Emacs: each cell is a `session.requests.Request`, a task of its own, and ends through the cleanup of its
plan when it is interrupted. This room says it in Jupyter's messages, and shows values as pictures and tables.

Where the parts are: `notebook_kernel` the messages of Jupyter; `guard` wrong messages; `launching` the process of a kernel; `cells` what a
cell is and how it is evaluated; `settings` cells such as ``%watch``; `asking` completion and inspection; `streams` where programs print and
read; `failures` what a cell says of an error; `rich` values as HTML; `outlines` what can be folded in them; `pictures` what has moved;
`plots` fluents over time; `plans` the tasks of a cell; `live` a cell while it runs; `controls` the buttons of time; `kernelspec` how
Jupyter finds the kernel; `magic` the cell magic ``%%cramhy`` of IPython.
"""


def load_ipython_extension(shell):
    """``%load_ext cramhy_runtime.jupyter``: the cell magic ``%%cramhy``. shell: IPython's."""
    from .magic import register

    register(shell)
