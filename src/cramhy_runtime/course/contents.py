"""Where the course's pages are, and their order: the pages of the tutorials in the documentation.

A wheel has them in ``cramhy_runtime/course/pages/``, a clone in ``docs/tutorials/``.
"""

from __future__ import annotations

from pathlib import Path

NAMES = (
    "first-forms",
    "names-and-functions",
    "first-plan",
    "lecture-34",
    "simple-plans",
    "motion-designators",
    "lecture-38",
    "choosing-a-module",
    "location-designators",
    "high-level-plans",
    "failure-handling",
    "tests",
    "bricks",
)
"""The names of the pages, in their order."""
GROWING = ("lecture-34", "simple-plans", "motion-designators", "lecture-38")
"""The pages on which one package grows: each needs the files of those before it."""
WITH_ROBOT = ("bricks",)
"""Pages whose forms need the extra ``robot``, which a browser's tab does not have."""


def folder() -> Path:
    """The folder with the pages and their pictures. Raises `FileNotFoundError` if they are not there."""
    here = Path(__file__).parent
    for place in (here / "pages", here.parents[2] / "docs" / "tutorials"):
        if (place / f"{NAMES[0]}.md").is_file():
            return place
    raise FileNotFoundError(
        f"The pages of the course are neither in {here / 'pages'} nor in a clone's docs/tutorials. Install cramhy again."
    )
