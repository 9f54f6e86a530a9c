"""Indentation beside a real Emacs with SLIME's rules, over the files of the course and the slides: the same columns in each line.

Emacs is told what SLIME learns from the server: how many arguments stand before the body of each macro. In ``.asd`` files the lines below
``:components`` stay where CRAM has them; Emacs puts them below the first argument of ``:module``.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from cramhy_runtime.lsp import answers, documents, surroundings
from cramhy_runtime.lsp.indentation import indented

from .mistakes import ROOT

SLIME = Path("/usr/share/emacs/site-lisp/elpa-src")
pytestmark = [
    pytest.mark.skipif(not shutil.which("emacs"), reason="emacs is missing"),
    pytest.mark.skipif(not list(SLIME.glob("slime-*")), reason="slime is missing"),
]
SHAPED = frozenset(
    ("let", "flet", "labels", "macrolet", "defun", "defmethod", "defmacro", "loop", "do", "do*", "cond", "case", "handler-case")
)
"""Emacs knows more of these than a number."""


def indented_by_us(file, text, known, bodies):
    document = documents.Document(file.as_uri(), str(file), text, known)
    document.compile()

    def inside():
        ask = answers.body_starts(document)
        for token in document.text.tokens:
            if token.kind == "word" and document.text.text[token.start - 1] == "(":
                name = token.text.lower().rpartition(":")[2]
                if name and name not in SHAPED and name[0].isalpha() and "#" not in token.text or name == "<-":
                    bodies[name] = ask(token.text)
        return indented(document.text, ask)

    changes = document.in_image(inside)
    for start, end, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    document.close()
    return text


@pytest.mark.parametrize("which, least", [("lectures", 600), pytest.param("kitchen", 400, marks=pytest.mark.soak)])
def test_lines_stand_where_emacs_puts_them(tmp_path, shared, which, least):
    if which == "lectures":
        files = [*(ROOT / "cram_my_beginner_tutorial").rglob("*.hy"), ROOT / "spiral.lisp", *(shared / "slides").rglob("*.lisp")]
    else:
        files = [*(ROOT / "kitchen" / "cram_my_pick_place_tutorial").rglob("*.hy"), *(ROOT / "kitchen").rglob("*.lisp")]
    known, bodies, ours = surroundings.Surroundings(), {}, {}
    for number, file in enumerate(sorted(files)):
        copy = tmp_path / f"{number}.lisp"
        copy.write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
        ours[copy] = file, indented_by_us(file, copy.read_text(encoding="utf-8"), known, bodies)
    known.forget()
    (tmp_path / "bodies.el").write_text(f"(setq cramhy-bodies '({' '.join(f'({n} . {c})' for n, c in bodies.items() if c is not None)}))")
    script = Path(__file__).parent / "editors" / "indent.el"
    subprocess.run(
        ["emacs", "--batch", "-Q", "-l", tmp_path / "bodies.el", "-l", script, *ours], check=True, timeout=120, stderr=subprocess.PIPE
    )
    different, lines = [], 0
    for copy, (file, text) in ours.items():
        theirs = Path(f"{copy}.emacs").read_text(encoding="utf-8")
        for line, (mine, emacs) in enumerate(zip(text.split("\n"), theirs.split("\n"), strict=True), 1):
            lines += 1
            if mine.rstrip() != emacs.rstrip():
                different.append((file.name, line, mine, emacs))
    assert lines > least and different == []
