"""``cramhy learn``: the course at the prompt."""

from __future__ import annotations

import sys
from pathlib import Path


LOADING = "; The course is being loaded. On a busy machine that takes some seconds."
"""What a terminal shows at once."""


def tell_begin():
    """Tell at a terminal that the course is on its way."""
    if sys.stdout is not None and sys.stdout.isatty():
        print(LOADING, flush=True)


def learn(options):
    """Go through the course as the options say. Returns the exit status: 2 if there is no such page, or its files cannot be written."""
    from cramhy_runtime import course
    from cramhy_runtime.course import contents
    from cramhy_runtime.course import learn as learning

    from . import session

    name = options.page
    if name is not None and name.isdigit() and 1 <= int(name) <= len(contents.NAMES):
        name = contents.NAMES[int(name) - 1]
    sys.path.append("")  # modules of the current folder are found, as at the other prompts
    try:
        if name is not None:
            course.page(name)
        folder = None if options.folder is None else Path(options.folder)
        return learning.run(lambda closings: session(options, closings), options.language, name, folder)
    except course.PageError as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
