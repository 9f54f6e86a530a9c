"""The lessons in a tab, from the state in which other pages leave the folder: each button, each block, each file, each task with its check."""

from __future__ import annotations

import pytest

pytest.importorskip("markdown", reason="the pages become HTML with it: pip install markdown")

from cramhy_runtime.course import reading  # noqa: E402
from cramhy_runtime.course.parts import Task  # noqa: E402
from cramhy_runtime.session import Image  # noqa: E402

from .in_a_tab import TabWalk  # noqa: E402
from .walks import LANGUAGES, WITHOUT_ROBOT, orders  # noqa: E402


@pytest.mark.soak
@pytest.mark.parametrize("language", LANGUAGES)
def test_each_page_goes_well_after_other_pages(language, tmp_path):
    for number, names in enumerate(orders(WITHOUT_ROBOT, language, "tab")):
        folder = tmp_path / str(number)
        folder.mkdir()
        for name in names:
            with Image().entered():
                walk = TabWalk(name, language, folder)
            assert (walk.status, walk.wrong) == (0, []), f"{name}, after {names[: names.index(name)]}"
            tasks = [part.name for part in reading.page(name).parts if isinstance(part, Task)]
            assert [task for task in tasks if not walk.verdicts[task]] == []
