"""A cell shows its error though something in it cannot be printed, and the kernel goes on."""

from __future__ import annotations

from pathlib import Path

import bad_printers


def test_a_cell_shows_each_error(cells):
    folder = Path(bad_printers.__file__).parent
    cells.run(f'{bad_printers.DEFINITIONS}\n(py:exec "import sys; sys.path.append({str(folder)!r})")')
    for what, form, said in bad_printers.forms():
        answer = cells.run(form)
        shown = "\n".join("\n".join(content["traceback"]) for content in answer.of("error"))
        assert said in " ".join(shown.split()) and len(shown) < bad_printers.MOST, (what, shown[:500])
    assert cells.run("(+ 1 2)").text == "3"
