"""Fixtures of the libraries' tests: forms in, printed values out."""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

collect_ignore = ["workspace"]  # packages that test_systems_as_cram_has_them.py runs in sessions and processes of their own


@pytest.fixture
def values(session):
    """A function: the printed values of the last form of a text, in a package of its own, with something between them."""
    session.package = ensure_package("LIBRARIES-TESTS", use=[COMMON_LISP])
    return lambda text, between=" ": between.join(prin1_to_string(value) for value in session.evaluate_text(text, "<test>"))
