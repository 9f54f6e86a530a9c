"""The kernel: tasks that park and wake, one baton, a clock. Everything stands on it, and it knows nothing of Lisp.

    from cramhy_runtime import kernel

    kernel.start(clock="virtual")
    def drive():
        kernel.sleep(2.0)
        return "there"
    kernel.spawn(drive, name="drive").join()      # "there", at once; kernel.now() is 2.0

Plans wait all the time: for a pose, for a failure of a sibling, for two seconds to pass. In CRAM each branch of a plan is
a thread of SBCL, and time is wall time. Here a branch is a task, and one task runs at a time: the one that has the
baton. It passes the baton at named points: it parks (waits for `unpark` or for a time), it yields, it ends, or it has
used up its slice of checkpoints. Between two such points no other task runs. So a plan needs no locks, a test of a
condition and the wait after it are one step, and the whole run is deterministic: the same program, the same seed and the
same order of events from outside give the same run.

All waiting goes through the kernel, so it also controls time. When every task is parked, nothing can happen before the next
timer, and the virtual clock jumps there. The wall clock is the same with a pace-maker: it waits before it jumps.

Where the parts are:

* `scheduler`  the baton, the queue, the next task; `endings` interrupts, stopping, unhandled failures; `uncaught` exceptions that
  end the program; `signals` of the system; `inbox` other threads and calls that block; `patient_calls` Python's own that wait;
  `standard_input` typed lines; `terminals` keys and modes; `asyncio_thread` a thread of the system that serves clients, and its share
  of the processor
* `tasks`      a task, its end, the request to end; `cleanup` the cleanup of a task that ends
* `timers`, `clocks`, `throttle` (of virtual time for spectators), `budget` (the count of checkpoints), `reports` (for people),
  `unstarted` (calls that ran nothing), `looking_on` (spectators), `errors`
* `waiting`    tasks that wait for a change, made of the functions below
* `backends`   stacks: threads of the operating system, greenlets, or WebAssembly's; `depth` how deep code may recurse on them
* `active`     the functions below, which act on the active kernel; `typing_names`, `signatures` the names in their annotations;
  `late_patterns` regular expressions that are compiled when they are used
* `images`     global state, in cells and tables, and how the state of one image takes the place of another's

From trio come cancellation at checkpoints, the shield, a clock that jumps, and the deadlock as an error with a text, but
not cancel scopes and nurseries, since CPL has its own tree with its own rules. From Erlang comes counting reductions. From
SimPy comes real time on top of simulated time, and not the other way round.

`install_reporter` lets a floor above describe frames and failures in its own terms (see `reports`). A room that serves a session
registers with the kernel's ``at_stop`` to end with it.
"""

from .active import (
    active,
    aside,
    at_hand,
    call_at,
    call_every,
    checkpoint,
    choice_point,
    current,
    holds_baton,
    interrupt,
    interrupt_over,
    now,
    on_own_stack,
    outside_source,
    pace,
    park,
    post,
    refill,
    run_blocking,
    set_clock,
    settle,
    shield,
    sleep,
    slice_over,
    spawn,
    start,
    stop,
    time_held,
    time_limited,
    time_wanted,
    unpark,
    unshielded,
    woken_by,
    work_limited,
    yield_,
)
from .cleanup import cleanup, cleanup_here, limit_by
from .clocks import VirtualClock, WallClock
from .depth import allow_deep_recursion
from .endings import CLEANUP_LIMIT
from .errors import Abandoned, Cancelled, Deadlock, Interrupted, KernelError, Terminated, TimeLimit, WaitEnded, WorkLimit
from .reports import describe_frame, install_reporter, unhandled
from .scheduler import Kernel
from .tasks import Task
from .timers import Timer
from .waiting import Waiting

__all__ = [
    "Abandoned", "CLEANUP_LIMIT", "Cancelled", "Deadlock", "Interrupted", "Kernel", "KernelError", "Task", "Terminated", "TimeLimit",
    "Timer", "VirtualClock", "WaitEnded", "Waiting", "WallClock", "WorkLimit", "active", "allow_deep_recursion", "aside", "at_hand",
    "call_at", "call_every", "checkpoint", "choice_point", "cleanup", "cleanup_here", "current", "describe_frame", "holds_baton",
    "install_reporter", "interrupt", "interrupt_over", "limit_by", "now", "on_own_stack", "outside_source", "pace", "park", "post",
    "refill", "run_blocking", "set_clock", "settle", "shield", "sleep", "slice_over", "spawn", "start", "stop", "time_held",
    "time_limited", "time_wanted", "unhandled", "unpark", "unshielded", "woken_by", "work_limited", "yield_",
]  # fmt: skip
