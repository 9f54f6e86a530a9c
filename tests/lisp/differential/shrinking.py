"""The smallest question near a given one that two Lisps still answer differently.

First the parts of the question are tried by themselves, the shortest first. Then each part is tried in place of what is around it, and
left out. What is tried need not be well typed: if the two Lisps agree about it, it is not taken.
"""

from __future__ import annotations

import re

TOKEN = re.compile(
    r"""(?P<space>\s+|;[^\n]*)|(?P<prefix>\#'|\#\d*[ACSPacsp*+-](?=\()|\#\d*(?=\()|,@|[',`])|(?P<open>\()|(?P<close>\))
    |(?P<atom>"(?:\\.|[^"\\])*"|\#\\(?:\w+|.)|(?:\|[^|]*\||\\.|[^\s()"';`,|\\])+|.)""",
    re.VERBOSE | re.DOTALL,
)
TRIES = 600


def parts(text):
    """The (start, end) of each form in ``text``, those inside of others too."""
    found, starts, prefix = [], [], None
    for token in TOKEN.finditer(text):
        kind, start = token.lastgroup, token.start()
        if kind == "prefix":
            prefix = start if prefix is None else prefix
        elif kind == "open":
            starts.append(start if prefix is None else prefix)
            prefix = None
        elif kind == "close" and starts:
            found.append((starts.pop(), token.end()))
        elif kind == "atom":
            found.append((start if prefix is None else prefix, token.end()))
            prefix = None
    return found


def smaller(text):
    """Texts that are shorter than ``text`` and made of its parts."""
    places = sorted(parts(text), key=lambda place: place[1] - place[0])
    for start, end in places:
        if end - start < len(text):
            yield text[start:end]
    for start, end in reversed(places):
        yield re.sub(r"\s+\)", ")", text[:start].rstrip() + " " + text[end:].lstrip())
        for inner, last in places:
            if start <= inner and last <= end and last - inner < end - start:
                yield text[:start] + text[inner:last] + text[end:]


def shrunk(text, differs, tries=TRIES):
    """The shortest question that was found for which ``differs`` holds as it does for ``text``; at most ``tries`` are asked."""
    tried = {text}
    while True:
        for candidate in smaller(text):
            if len(candidate) >= len(text) or candidate in tried or not candidate.strip():
                continue
            tried.add(candidate)
            if len(tried) > tries:
                return text
            if differs(candidate):
                text = candidate
                break
        else:
            return text
