"""The cell magic ``%%cramhy`` of IPython: a cell of Common Lisp or Hy in a notebook of Python.

``%%cramhy`` evaluates Lisp, ``%%cramhy hy`` Hy. The session begins with the first such cell and stays. It lives in virtual time, unless the
variable CRAMHY_TIME says otherwise.
"""

from __future__ import annotations

import signal
import sys
from contextlib import contextmanager

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.lisp_core.printing import speak
from cramhy_runtime.session import time_setting
from cramhy_runtime.session.session import Interruption, Session

from . import rich
from .cells import HY, LISP, Aborted, Notebook
from .failures import CellDebugger, told_of
from .pictures import Watcher

_notebook = Cell(None, fresh=True)


def notebook():
    """The `Notebook` of this process, which begins with its first cell."""
    if _notebook.value is None or kernel.active() is None:
        _notebook.value = Notebook(Session.at_hand(time_setting.decide()))
        _notebook.value.watcher = Watcher()
    return _notebook.value


@contextmanager
def _interruptible():
    """SIGINT ends the plan of the cell through its cleanup."""
    active = kernel.active()
    before = signal.signal(signal.SIGINT, lambda number, frame: active.interrupt())
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def cramhy(line, cell):
    """Evaluate ``cell``, and show its last value and what has moved. line: ``""`` or ``"lisp"`` for Common Lisp, ``"hy"`` for Hy."""
    from IPython.display import display

    word = line.strip() or LISP
    if word not in (LISP, HY):
        print(f"%%cramhy {word}: a cell is lisp or hy.", file=sys.stderr)
        return
    opened = notebook()
    opened.language = word
    debugger = CellDebugger(opened.session, sys.stderr.write, in_hy=lambda: opened.answered_in == HY)
    opened.watcher.begin()
    conditions.install_debugger(debugger)
    bundle, told = None, None
    with _interruptible():
        try:
            bundle = rich.bundle(opened.evaluate(cell), opened.shown)
        except Interruption:
            print("; Interrupted. The plan has been cleaned up.", file=sys.stderr)
        except Aborted:
            pass
        except (Exception, Condition) as problem:
            told = debugger.told or told_of(problem, opened.answered_in == HY)
        finally:
            conditions.install_debugger(None)
            speak(lisp=False)  # the other cells are Python
    for _, picture in opened.watcher.pictures():
        display(picture, raw=True)
    if told is not None:
        print("\n".join(told.lines), file=sys.stderr)
    elif bundle is not None:
        display(bundle, raw=True)


def register(shell):
    """Let ``%%cramhy`` be a cell magic of IPython's ``shell``."""
    shell.register_magic_function(cramhy, "cell", "cramhy")
