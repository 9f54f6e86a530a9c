"""What was typed, kept so that errors can show it and `function-lambda-expression` can find it: the newest texts, and more that define.

Python's `linecache` has the lines of a file by its name; a text typed at the prompt is such a file, ``<repl 12>``. A session of days has
many of them. An error in a form shows its text at once, so few need to be kept for that; a function that was typed is called later, so
texts that define something are kept for longer. An error in a function whose text is gone still tells the place.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime.lisp_core.source_places import keep_text

MOST = 200
"""Texts that are kept."""
MOST_DEFINITIONS = 2000
"""Texts with a definition that are kept."""

_plain, _definitions = deque(), deque()


def keep(name, text):
    """Let ``linecache`` have the lines of ``text`` under ``name``, and forget the oldest when there are too many."""
    keep_text(name, text)
    kept, most = (_definitions, MOST_DEFINITIONS) if "(def" in text.lower() else (_plain, MOST)
    kept.append(name)
    if len(kept) <= most:
        return
    import linecache  # it imports the tokenizer

    while len(kept) > most:
        gone = kept.popleft()
        if gone not in kept:  # the name of texts that are not numbered comes again and again
            linecache.cache.pop(gone, None)
