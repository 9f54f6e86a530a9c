"""Whether somebody has typed a line: `select` on a terminal, which not every system has.

Windows selects among sockets only, and a browser has nothing to select from. There nobody can say whether reading would wait.
"""

from __future__ import annotations

import select


def readable(file, seconds):
    """Whether reading from the file, or file descriptor, would return at once, after waiting ``seconds`` for that at most.

    ``None`` where the system cannot tell: for a file without a descriptor, or where only sockets can be waited for.
    """
    try:
        return bool(select.select([file], [], [], seconds)[0])
    except (OSError, ValueError, AttributeError):
        return None
