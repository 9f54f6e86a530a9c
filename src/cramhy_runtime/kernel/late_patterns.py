"""Regular expressions that are compiled when they are used first.

Python compiles one in a fifth of a millisecond. A session needs few of those that its modules have, and none of them before its prompt.
Until then a program that only runs plans does without the module ``re``, too.
"""

from __future__ import annotations

from .typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    import re


class _LatePattern:
    def __init__(self, text: str, flags: int = 0) -> None:
        self._text, self._flags = text, flags

    def __getattr__(self, name: str) -> object:
        import re

        value = getattr(re.compile(self._text, self._flags), name)
        setattr(self, name, value)  # so the next use takes no call
        return value


def late_pattern(text: str, flags: int = 0) -> re.Pattern[str]:
    """What ``re.compile(text, flags)`` returns, except that an error in ``text`` is raised by the first use."""
    return _LatePattern(text, flags)  # type: ignore[return-value]  # it has all its methods


__all__ = ["late_pattern"]
