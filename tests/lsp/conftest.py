"""One server for all tests of a run."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from .editor import Editor  # noqa: E402  it needs pygls


@pytest.fixture(scope="package")
def editor():
    found = Editor()
    yield found
    found.end()
