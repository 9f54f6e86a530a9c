"""Weak pointers, finalizers and the collector of SB-EXT, by Python's.

Python refers weakly to instances, structures, arrays, hash tables, symbols and functions. It cannot to conses, numbers, characters and
strings: a weak pointer keeps such an object alive, and its finalizer is never called, as in SBCL when the object is never garbage. A
finalizer runs in a thread of its own, at the next moment at which the kernel looks for messages. Source: SBCL's manual, chapter 7.
"""

from __future__ import annotations

import gc as collector
import weakref

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import MultipleValues, boolean
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import define_printer, prin1_to_string
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.utilities.wait_queue import need

_finalizers: dict[int, list[weakref.finalize]] = {}
"""The finalizers of living objects, by the object's ``id``."""


class WeakPointer:
    """A pointer that does not keep its object alive."""

    lisp_name = "SB-EXT::WEAK-POINTER"

    def __init__(self, thing: Any) -> None:
        self.reference: Any
        try:
            self.reference = weakref.ref(thing)
        except TypeError:  # Python has no weak references to this
            self.reference = lambda: thing


def make_weak_pointer(object: Any) -> WeakPointer:
    """``sb-ext:make-weak-pointer``"""
    return WeakPointer(object)


def weak_pointer_value(pointer: Any) -> object:
    """``sb-ext:weak-pointer-value``: two values, the object and T, or nil and nil when it is gone."""
    need(pointer, WeakPointer, "SB-EXT:WEAK-POINTER")
    thing = pointer.reference()
    return MultipleValues((thing, boolean(thing is not None)))


def weak_pointer_p(thing: object) -> bool | None:
    """``sb-ext:weak-pointer-p``"""
    return boolean(isinstance(thing, WeakPointer))


def _print(pointer: WeakPointer, stream: Any) -> None:
    thing = pointer.reference()
    stream.write("#<broken weak pointer>" if thing is None else f"#<weak pointer: {prin1_to_string(thing)}>")


define_printer(WeakPointer, _print)


def finalize(object: Any, function: Any, *, dont_save: Any = None) -> object:
    """``sb-ext:finalize``: call ``function``, without arguments, after the object is gone. Returns the object."""
    called = function_of(function)
    try:
        made = weakref.finalize(object, _gone, called, id(object))
        made.atexit = False
        _finalizers.setdefault(id(object), []).append(made)
    except TypeError:  # Python cannot tell when it is gone
        pass
    return object


def _gone(called: Any, number: int) -> None:
    """An object is gone, at whatever moment Python noticed that: have its finalizer called at a moment when code may run."""
    _finalizers.pop(number, None)
    active = kernel.active()
    if active is not None and not active.stopped:
        active.post(lambda: active.spawn(called, name="finalizer", parent=active.main))


def cancel_finalization(object: Any) -> object:
    """``sb-ext:cancel-finalization``: forget the finalizers of the object, which is returned."""
    for made in _finalizers.pop(id(object), ()):
        made.detach()
    return object


def gc(*, full: Any = None, gen: Any = None) -> None:
    """``sb-ext:gc``: collect garbage now, then call the functions in ``*after-gc-hooks*``."""
    collector.collect()
    for hook in sym("SB-EXT::*AFTER-GC-HOOKS*").value or ():
        function_of(hook)()
