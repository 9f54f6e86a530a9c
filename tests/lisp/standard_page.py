"""``make docs``: write ``docs/common-lisp.md``, the table of all symbols of Common Lisp, from the code; with ``--print`` only show it."""

import sys
from pathlib import Path

from cramhy_runtime.session import boot
from cramhy_runtime.languages.commonlisp import coverage

PAGE = Path(__file__).parents[2] / "docs" / "common-lisp.md"


def text():
    boot()
    return coverage.page()


if __name__ == "__main__":
    if sys.argv[1:] == ["--print"]:
        sys.stdout.write(text())
    else:
        PAGE.write_text(text(), encoding="utf-8")
