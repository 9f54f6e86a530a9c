"""Where interruptions reach a thread: the work of SB-SYS's ``without-interrupts`` and of the forms that let them in again.

A thread that is not to be interrupted has one shield of the kernel, however many such forms stand around each other. Cleanup forms have
shields of their own, which nothing here takes away. Source: SBCL's ``src/code/early-thread.lisp`` and its answers.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.kernel.typing_names import Any, NamedTuple


class Interrupts(NamedTuple):
    """What holds in a thread: SBCL's ``*interrupts-enabled*`` and ``*allow-with-interrupts*``.

    allowed_around: what the innermost ``without-interrupts`` found in ``*allow-with-interrupts*``; ``None`` outside of all of them.
    """

    enabled: bool
    allowed: bool
    allowed_around: bool | None


BEGIN = Interrupts(True, True, None)


def _found() -> Interrupts:
    return getattr(kernel.current().local, "interrupts", BEGIN)


def _call(body: Any, found: Interrupts, wanted: Interrupts) -> object:
    """The values of ``body()`` where ``wanted`` holds in place of ``found``. An interruption that waited arrives as soon as it may."""
    local = kernel.current().local
    local.interrupts = wanted
    try:
        if found.enabled is wanted.enabled:
            return body()
        if wanted.enabled:
            with kernel.unshielded():
                kernel.checkpoint()
                return body()
        with kernel.shield():
            values = body()
    finally:
        local.interrupts = found
    kernel.checkpoint()
    return values


def call_uninterrupted(body: Any) -> object:
    """The work of ``without-interrupts``: the values of ``body()``; requests to end the thread, and interruptions, wait."""
    found = _found()
    return _call(body, found, Interrupts(False, False, found.allowed))


def call_interrupted(body: Any) -> object:
    """The work of ``with-interrupts``: the values of ``body()``; interruptions arrive in it, if that is allowed here."""
    found = _found()
    return _call(body, found, found._replace(enabled=found.enabled or found.allowed))


def _inside(name: str) -> tuple[Interrupts, bool]:
    """What holds here, and what was allowed around the ``without-interrupts``, which must be there."""
    found = _found()
    if found.allowed_around is None:
        error("~S is valid only inside ~S.", sym(f"SB-SYS::{name}"), sym("SB-SYS::WITHOUT-INTERRUPTS"))
    return found, bool(found.allowed_around)


def call_allowing_interrupts(body: Any) -> object:
    """The work of ``allow-with-interrupts``: the values of ``body()``, in which ``with-interrupts`` may let interruptions in."""
    found, around = _inside("ALLOW-WITH-INTERRUPTS")
    return _call(body, found, found._replace(allowed=around))


def call_locally_interrupted(body: Any) -> object:
    """The work of ``with-local-interrupts``: the values of ``body()``; interruptions arrive in it, if they were allowed around the
    ``without-interrupts``."""
    found, around = _inside("WITH-LOCAL-INTERRUPTS")
    return _call(body, found, found._replace(enabled=around, allowed=around))
