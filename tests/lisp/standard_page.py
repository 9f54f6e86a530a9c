"""``make docs``: write ``docs/common-lisp.md``, the table of all symbols of Common Lisp, from the code; with ``--print`` only show it."""

import sys
from pathlib import Path

from cramhy_runtime import image
from cramhy_runtime.lisp import coverage

PAGE = Path(__file__).parents[2] / "docs" / "common-lisp.md"


def text():
    image.boot()
    return coverage.page()


if __name__ == "__main__":
    if sys.argv[1:] == ["--print"]:
        sys.stdout.write(text())
    else:
        PAGE.write_text(text(), encoding="utf-8")
