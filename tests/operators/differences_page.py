"""``make docs``: write ``docs/differences.md`` from the rows beside the operators; with ``--print`` only show it."""

import sys
from pathlib import Path

from cramhy_runtime.languages.operators.differences import SECTIONS, section

PAGE = Path(__file__).parents[2] / "docs" / "differences.md"
BEGINNING = """# Where cramhy differs from CRAM on SBCL

Names, lambda lists, results, printed forms and message texts are the original's. cramhy repairs the places where the original loses work, hangs, leaks
tasks or stops the robot too early. Each repair is a row here. Where the second column is empty, the original does not do what the third one says.
`make docs` writes this page from the rows in `src/cramhy_runtime/languages/operators/differences/`.
"""
COLUMNS = "| Name | Original | Here | Why |\n|---|---|---|---|\n"


def cell(text):
    """A text in a cell of a table."""
    return text.replace("|", "\\|")


def text():
    """The page."""
    made = [BEGINNING]
    for name in SECTIONS:
        heading, rows = section(name)
        table = "".join(f"| {cell(row.names)} | {cell(row.original)} | {cell(row.here)} | {cell(row.why)} |\n" for row in rows)
        made.append(f"{heading}\n\n{COLUMNS}{table}")
    return "\n".join(made)


if __name__ == "__main__":
    if "--print" in sys.argv:
        print(text())
    else:
        PAGE.write_text(text(), encoding="utf-8")
