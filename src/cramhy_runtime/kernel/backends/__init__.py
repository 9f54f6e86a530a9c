"""Back ends: they give tasks their stacks.

A back end makes stacks and jumps between them, and knows nothing of queues, clocks or cancellation. A stack is called
a carrier, since it carries one task after the other: making one costs more than keeping it. The whole interface:

* `adopt(kernel) -> carrier` the stack that called `kernel.start`; it carries the main task.
* `carrier(job) -> carrier` (or `NoStack`) a stack that waits for its first `transfer` and then calls `job(carrier)`. The job returns
  the carrier that gets the baton next; after that this carrier may be given out again.
* `transfer(mine, other)` give the baton to OTHER; returns when another carrier transfers to MINE.
* `run_blocking(kernel, task, call)` run CALL while other tasks run, and return its result. `calls_back` says whether the task can go on
  before CALL has returned.
* `frame(carrier)` the innermost Python frame of a stack that does not have the baton, for reports.
* `close()` the kernel has stopped: free the stacks that are not needed.
* `forsake(carrier)` its task will never end: keep the stack, but don't expect it back.

A carrier has `ident`, the thread of the operating system on which it runs.

A third back end (for a browser, which has neither threads nor greenlets) would implement these seven and be named in `make_backend`.
"""

from __future__ import annotations

from ..typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..signatures import Backend, BackendName


def make_backend(backend: BackendName | Backend) -> Backend:
    """A fresh back end for "threads" or "greenlet". An object with the interface above is returned as it is.

    "auto" is "greenlet" where the package is installed, and "threads" elsewhere: plans do the same on both, and greenlets are faster.
    Another word is a ValueError; "greenlet" without the package is an ImportError.
    """
    if backend == "auto":
        try:
            from .greenlet import GreenletBackend

            return GreenletBackend()
        except ImportError:
            backend = "threads"
    if backend == "threads":
        from .threads import ThreadBackend

        return ThreadBackend()
    if backend == "greenlet":
        try:
            from .greenlet import GreenletBackend
        except ImportError as missing:
            from ...extras import install_command

            raise ImportError(
                'The back end "greenlet" needs the package greenlet, which is not installed. '
                f'Use the back end "threads", or type: {install_command("fast")}'
            ) from missing
        return GreenletBackend()
    if isinstance(backend, str):
        raise ValueError(f'There is no back end "{backend}". Choose "auto", "threads" or "greenlet".')
    return backend
