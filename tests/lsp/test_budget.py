"""Texts whose macros never end are stopped, and the next text is checked as ever."""

from __future__ import annotations

import pytest

from cramhy_runtime.lsp import documents, surroundings


@pytest.mark.soak
@pytest.mark.parametrize(
    "text",
    [
        "(defmacro m () (loop))\n(m)\n",
        "#.(loop)\n",
        "(eval-when (:compile-toplevel) (loop))\n",
        "(defmacro m () (ignore-errors (unwind-protect (loop) (print 1))))\n(m)\n",
        "(defmacro m () (unwind-protect (loop) (loop)))\n(m)\n",
        "(defmacro m () (let ((*print-base* 2)) (loop (let ((*print-base* 3)) (cpl:top-level (cpl:par (identity 1) (identity 2)))))))\n(m)\n",
    ],
)
def test_what_never_ends_is_stopped(monkeypatch, text):
    monkeypatch.setattr(documents, "SECONDS", 0.3)
    document = documents.Document("untitled:endless.lisp", None, text, surroundings.Surroundings())
    (found,) = document.compile()
    assert "was stopped" in found.message
    monkeypatch.setattr(documents, "SECONDS", 20.0)
    document.renew("(defun f (x) x)\n(f 1)\n")
    assert document.compile() == []
