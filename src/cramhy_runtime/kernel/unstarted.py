"""Functions of Python that run nothing when they are called, and values of calls that were to be functions.

A plan, a branch, a grounding or a callback is called once, and what it returns is its result. A generator function or a coroutine
function returns at once, and its body would never run, without a word. `ran` finds that out where results come in. Whoever writes
``par(drive())`` has called ``drive`` himself, before ``par`` began: `callable_part` tells that where functions come in.
"""

from __future__ import annotations

from types import AsyncGeneratorType, CoroutineType, GeneratorType

from cramhy_runtime.kernel.typing_names import Any, TypeVar

T = TypeVar("T")
CO_GENERATOR, CO_COROUTINE, CO_ASYNC_GENERATOR = 0x20, 0x80, 0x200
"""The flags of such functions' code, as `inspect` has them."""
UNSTARTED = frozenset({GeneratorType, CoroutineType, AsyncGeneratorType})
"""The classes of what calls of such functions return. Hot code looks here before it calls `ran`."""


def ran(result: Any, role: str) -> Any:
    """``result``, the value of a call of a user's function, unless the call has run nothing: then it is a TypeError.

    ``role`` is the function's part in the program, as in "a branch". A generator that has begun, or a generator expression, is a value
    like others.
    """
    if result.__class__ not in UNSTARTED:
        return result
    from inspect import GEN_CREATED, getgeneratorstate  # costs a tenth of the import of plans

    if result.__class__ is GeneratorType:
        if getgeneratorstate(result) != GEN_CREATED or result.__name__ == "<genexpr>":
            return result
        kind, given, advice = "a generator function (there is a `yield` in it)", "a generator", "Write it without `yield`"
    elif result.__class__ is CoroutineType:
        kind, given, advice = "an `async def`", "a coroutine", "Write `def`, and leave out `await`"
        result.close()  # else Python warns that nobody has awaited it
    else:
        kind, given, advice = "an `async def` with a `yield` in it", "an asynchronous generator", "Write a plain `def`"
    raise TypeError(
        f"{result.__qualname__} is {role}, and {kind}: the call returned {given}, and has run nothing of it. "
        f"{advice}: plans are plain functions, and wait by calls such as cpl.sleep(1) and cpl.wait_for(fluent)."
    )


def callable_part(given: T, form: str, role: str, written: str = "drive") -> T:
    """``given``, which the operator ``form`` calls as ``role``, such as "a branch"; a TypeError if it is not a function.

    written: how the arguments of the operator look when they are right.
    """
    if callable(given):
        return given
    text = repr(given)
    text = text if len(text) <= 60 else text[:57] + "..."
    raise TypeError(
        f"cpl.{form} takes a function as {role}, and calls it, but was given {text} (of the type {type(given).__name__}). If that is "
        f"what a call such as drive() gave, the call was over before cpl.{form} began. Write cpl.{form}({written}), without the "
        f"parentheses behind drive, or with arguments cpl.{form}({written.replace('drive', 'lambda: drive(2)')})."
    )


def plain_function(function: T, role: str, yields: bool = False) -> T:
    """``function``, which a user gives for ``role``, as in "a subscriber's callback"; a TypeError if a call of it would run nothing.

    yields: whether generator functions are wanted there. Objects whose code Python does not show are taken as they are.
    """
    inner: Any = function
    while hasattr(inner, "func"):  # functools.partial
        inner = inner.func
    flags = getattr(getattr(inner, "__code__", None), "co_flags", 0)
    if flags & (CO_COROUTINE | CO_ASYNC_GENERATOR) or flags & CO_GENERATOR and not yields:
        kind = "a generator function (there is a `yield` in it)" if flags & CO_GENERATOR else "an `async def`"
        raise TypeError(
            f"{inner.__qualname__} is {kind}, and cannot be {role}: its call would return at once, and run nothing of it. "
            "Write a plain function; it waits by calls such as cpl.sleep(1) and cpl.wait_for(fluent)."
        )
    return function
