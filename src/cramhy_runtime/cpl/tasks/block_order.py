"""Blocks are left in the reverse order in which they were entered, in the task that entered them; else it is an error with both places.

Python's ``with`` statements see to that in one function. A generator that waits inside of a block breaks it: while the generator does
not run, other code runs as if it were in the block. trio has the same problem with cancel scopes (PEP 789). Nothing tells that a
generator is suspended. So it is found when a block is left while one that was entered after it is open, when it is left in another task,
when a block is to end whose generator does not run, and when the task ends with an open block. A block is closed then, in any case: its
timer ends nothing any more, and its branches end (law 1).

A generator that makes a context manager (``contextlib.contextmanager``) does not count: it stands for the one that enters it.
"""

from __future__ import annotations

import contextlib
import sys

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from cramhy_runtime import kernel
from cramhy_runtime.kernel import reports

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import error

if TYPE_CHECKING:
    from types import FrameType

    from .tasks import AbstractTask
    from .timeouts import Block

GENERATOR = 0x20  # inspect.CO_GENERATOR, of a module that a prompt starts without
PASSED = ("__enter__", "enter_context")  # functions that enter a block for the function that calls them
_CONTEXTLIB = contextlib.__file__
REMEDY = (
    "Leave blocks in the reverse order in which they were entered, in the task that entered them. If a generator waits in a block, use it "
    "up, or close it (contextlib.closing), before you leave what is around it."
)


def who_enters(frame: FrameType) -> FrameType:
    """The frame of the code whose ``with`` statement enters a block in ``frame``: a context manager enters it for another function."""
    while (around := frame.f_back) is not None:
        code = frame.f_code
        if code.co_name not in PASSED and not (code.co_flags & GENERATOR and around.f_code.co_filename == _CONTEXTLIB):
            break
        frame = around
    return frame


def check_runs(block: Block) -> None:
    """Signal an error if the generator that entered ``block`` does not run now, though the block is to end. The block's task calls it."""
    frame: FrameType | None = sys._getframe(1)
    here = frame
    while frame is not None:
        if frame is block.generator:
            return
        frame = frame.f_back
    block.discard()
    _error(
        f"A {block.form} block was to end, but the generator that entered it does not run.",
        f"It was entered at {_entered(block)}, and its task is at {reports.place(here)}.",
    )


def is_left_in_order(block: Block, exception: BaseException | None) -> bool:
    """Whether ``block`` may be left with ``exception``. False: it was closed already, and the exception goes on. A wrong order is an error.

    When another exception unwinds the stack, blocks of generators that are suspended are closed without an error.
    """
    running = kernel.active()
    me = block.kernel_task
    if block.over:
        if exception is None and running is not None and not me.dead:
            _error(
                f"A {block.form} block was left after a block around it.",
                f"It was entered at {_entered(block)}, and left at {reports.place(sys._getframe(2))}.",
            )
        return False
    if running is None or running.current is not me:
        _left_elsewhere(block, exception)
        return False
    if me.local.blocks[-1] is not block:
        _close_inner(block, exception)
    return True


def _left_elsewhere(block: Block, exception: BaseException | None) -> None:
    me = block.kernel_task
    block.discard()
    other = kernel.active()
    texts = (
        f"A {block.form} block was left in another task than the one that entered it.",
        f"It was entered at {_entered(block)}, in {me.name}, and left at {reports.place(sys._getframe(3))}"
        f"{'' if other is None else f', in {other.current.name}'}.",
    )
    if other is None:
        return
    me.interject(lambda: _error(*texts))
    if not isinstance(exception, GeneratorExit):  # else it may be the garbage collector that closes it, which lets no exception out
        _error(*texts)


def _close_inner(block: Block, exception: BaseException | None) -> None:
    blocks = block.kernel_task.local.blocks
    inner = blocks[blocks.index(block) + 1 :]
    for other in reversed(inner):
        other.discard()
    if exception is None or isinstance(exception, GeneratorExit) or getattr(exception, "block", None) is block:
        block.discard()
        _error(
            f"A {block.form} block was left before the {inner[0].form} block that was entered after it.",
            f"The {block.form} block was entered at {_entered(block)}, and the {inner[0].form} block at {_entered(inner[0])}.",
        )


def close_rest(task: AbstractTask[object], blocks: list[Block]) -> types.SimpleError | None:
    """Close ``blocks``, which ``task`` leaves open where it ends. Returns the error that says so, ``None`` if there are none."""
    left = blocks[:]
    for block in reversed(left):
        block.discard()
    if not left:
        return None
    return types.SimpleError(
        "~a",
        f"A {left[0].form} block was never left: the task ended. It was entered at {_entered(left[0])}, and the task that ended is "
        f"{task.name}. {REMEDY}",
    )


def _entered(block: Block) -> str:
    return reports.place(reports.Place(*block.place))


def _error(what: str, where: str) -> None:
    error(types.SimpleError("~a", f"{what} {where} {REMEDY}"))
