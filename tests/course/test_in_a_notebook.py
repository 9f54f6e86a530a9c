"""The pages as notebooks, from the state in which other pages leave the folder: each cell, and each task with its check."""

from __future__ import annotations

import pytest

for module in ("ipykernel", "jupyter_client"):
    pytest.importorskip(module, reason="the extra jupyter is not installed")

from cramhy_runtime.course import reading  # noqa: E402
from systems import needs_processes  # noqa: E402

from .in_a_notebook import walk  # noqa: E402
from .walks import LANGUAGES, WITHOUT_ROBOT, orders  # noqa: E402

pytestmark = pytest.mark.soak


@needs_processes
@pytest.mark.parametrize("language", LANGUAGES)
def test_each_page_goes_well_after_other_pages(language, tmp_path):
    for number, names in enumerate(orders(WITHOUT_ROBOT, language, "notebook")):
        for name in names:
            wrong, verdicts = walk(name, language, tmp_path / str(number))
            assert wrong == [], f"{name}, after {names[: names.index(name)]}"
            assert verdicts == {task.name: True for task in reading.page(name).tasks}
