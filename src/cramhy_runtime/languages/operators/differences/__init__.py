"""What differs from CRAM on SBCL, on purpose: a row for each difference, beside the tables of operators.

The texts in this folder are the rows, one file for each section of ``docs/differences.md``, which is made from them (``make docs``). A row
has the operators, or other words, that it is about, what the original does, what cramhy does, and why::

    `pursue`
      original: An evaporated branch is an assertion.
      here: A branch that somebody evaporated counts as done without values.
      why: An evaporated branch has not failed.

``original`` may be left out where the row says enough. Names in backticks are operators, and a test looks for each of them.
"""

from __future__ import annotations

import re
from pathlib import Path

from cramhy_runtime.kernel.typing_names import NamedTuple

SECTIONS = """tasks utilities designators process_modules occasions prolog geometry robot_world costmaps ros common_lisp course
    turtle""".split()
"""The files of this folder, in the order of the page."""
FIELDS = ("original", "here", "why")


class Difference(NamedTuple):
    """A row: the names that it is about, in Markdown, and the three texts. ``original`` may be empty."""

    names: str
    original: str
    here: str
    why: str

    @property
    def operators(self) -> list[str]:
        """The names in backticks."""
        return re.findall(r"`([^`]+)`", self.names)


def section(name: str) -> tuple[str, list[Difference]]:
    """The heading of the section ``name``, in Markdown, and its rows. A row that is written wrongly is a ValueError."""
    heading, *blocks = (Path(__file__).parent / f"{name}.txt").read_text(encoding="utf-8").strip().split("\n\n")
    return heading, [row(block) for block in blocks]


def row(block: str) -> Difference:
    """The row that ``block``, the text between two empty lines, has. One that is written wrongly is a ValueError."""
    names, *lines = block.splitlines()
    texts: dict[str, list[str]] = {}
    for line in lines:
        field, colon, text = line.strip().partition(": ")
        if line.startswith("  ") and not line.startswith("   ") and colon and field in FIELDS:
            texts[field] = [text]
        elif line.startswith("    ") and texts:
            texts[list(texts)[-1]].append(line.strip())
        else:
            raise ValueError(f"This line of a difference begins no field (original, here, why), and goes on with none: {line}")
    if names != names.strip() or not {"here", "why"} <= texts.keys():
        raise ValueError(f"A difference has its names in the first line, and the fields here and why: {block}")
    return Difference(names, *(" ".join(texts.get(field, ())) for field in FIELDS))


__all__ = ["Difference", "FIELDS", "SECTIONS", "row", "section"]
