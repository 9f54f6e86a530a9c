"""All that we change in Hy, since Hy has no other way: three patches, of Hy 1.3.1, with the change that Hy would need.

``tests/hy_files/test_patches.py`` fails when Hy changes there, so that somebody looks whether a patch can go or must change. No other file
changes Hy (``tests/test_foreign_patches.py``). A patch stays only because it cannot be done otherwise:

1. `require_quickly`. ``hy.macros.require``, which each compiled file of Hy calls when it is imported, asks `inspect.stack` for the frame of
   its caller. That describes all frames, and reads the lines of each: 10 ms in a small program, 100 ms in one with many modules. hyrule
   alone has 45 of them. Code that others have compiled calls Hy's function, so no loader of ours can help.
   Hy would need: ``sys._getframe(1)`` in place of ``inspect.stack()[1][0]``, in ``require``, ``require_reader`` and ``enable_readers``.
2. `hash_keywords`. A keyword of Hy and the keyword of Lisp that it stands for are equal, so they need equal hashes: else no dictionary
   finds ``:driving``. Lisp's keywords are keys of many tables and keep the quick hash of an object. Hy compiles ``:driving`` to a call of
   ``hy.models.Keyword``, in files that know nothing of us, too.
   Hy would need: a function in ``hy`` that makes the keyword of a name, which the compiler's code calls and which a program may set; or
   ``Keyword.__hash__`` that asks such a function.
3. `change_class`. ``hy`` makes its REPL before anybody can say of which class, and cramhy is required at its prompt. Then plans must go on
   while it waits for a line, and their failures must not end it.
   Hy would need: a variable ``repl_class`` of the file HYSTARTUP, beside ``repl_ps1`` and ``repl_output_fn``; or an option of ``hy``.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import hy.macros
from hy import models

SEEN_WITH = "1.3.1"
"""The version of Hy in which these patches were last looked at."""


class _Inspect:
    """`inspect` for `hy.macros`."""

    def __getattr__(self, name: str) -> Any:
        return getattr(inspect, name)

    @staticmethod
    def stack(context: int = 1) -> list[tuple[FrameType]]:
        """What calls this, and the caller of that, each as a tuple that begins with the frame, as the entries of `inspect.stack` do."""
        frame = sys._getframe(1)
        return [(each,) for each in (frame, frame.f_back) if each is not None]


def require_quickly() -> None:
    """Let Hy find the file that requires macros without a look at every source file on the stack."""
    hy.macros.inspect = _Inspect()  # type: ignore[attr-defined]


def hash_keywords(function: Callable[[models.Keyword], int]) -> None:
    """Let ``function`` be the hash of Hy's keywords, in the whole process."""
    models.Keyword.__hash__ = function  # type: ignore[method-assign, assignment]


def change_class(repl: hy.REPL, cls: type[hy.REPL]) -> None:
    """Let ``repl``, which runs, be of the class ``cls``, which is made of its own one."""
    repl.__class__ = cls


__all__ = ["SEEN_WITH", "change_class", "hash_keywords", "require_quickly"]
