"""The figures of ``docs/explanation/house.md`` stay within their budgets, and the page has the budgets."""

from __future__ import annotations

import json


import pytest

from . import house

KNOWN = json.loads(house.BUDGETS.read_text())
RUNNING = ("calls", "drive files", "drive rooms", "modules")


@pytest.mark.parametrize("key", house.ROWS)
def test_a_figure_is_within_its_budget(key):
    pytest.importorskip("greenlet", reason="the calls are counted on greenlets: pip install greenlet")
    what, _, count = house.ROWS[key]
    room = 1.05 if key in RUNNING else 1  # what a session calls depends a little on the version of Python
    assert count() <= KNOWN["budget"][key] * room, (
        f"{what}: delete something, or raise the budget in tests/docs/house.json and say what it buys"
    )


def test_the_page_has_the_budgets():
    page = house.PAGE.read_text(encoding="utf-8")
    missing = [what for key, (what, _, _) in house.ROWS.items() if f"| {what} | {KNOWN['before'][key]:,} |" not in page]
    assert missing == []
    assert [what for key, (what, _, _) in house.ROWS.items() if f"| {KNOWN['budget'][key]:,} |" not in page] == []


@pytest.mark.soak
def test_a_class_counts_what_it_inherits():
    methods, files = house.whole_class(("cramhy_runtime.testing.watched", "WatchedKernel"))
    assert "spawn" in methods  # of the kernel's own class, in another file
    assert len(files) > 1


def test_words_of_a_docstring_are_no_code(tmp_path):
    path = tmp_path / "some.py"
    path.write_text('"""About pursue-it."""\n\ndef par_it():\n    """Not try-it."""\n    return ["with-it", other.on_it]\n')
    assert {"with-it", "par_it", "on_it"} <= house.names_of_code(path)
    assert not {"pursue-it", "try-it"} & house.names_of_code(path)
