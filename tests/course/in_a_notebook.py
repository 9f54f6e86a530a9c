"""The pages as notebooks, run cell by cell by a kernel, as Jupyter does it: what somebody does who also solves the tasks."""

from __future__ import annotations

import contextlib
import re
import sys
from pathlib import Path

from cramhy_runtime.course import files, reading

from .walking import solution

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.docs import notebooks  # noqa: E402
from tests.jupyter.conftest import Notebook  # noqa: E402

_CHECK = re.compile(r'\((?:course:)?check "([\w-]+)"(?: "hy")?\)\Z')


def walk(name, language, top):
    """(what came otherwise than the page says, task → whether its solution has passed) of the notebook of a page, run in its folder below
    ``top``, in which other notebooks may have left files."""
    page, wrong, verdicts = notebooks.TUTORIALS / f"{name}.md", [], {}
    folder = Path(top) / notebooks.folder_of(page)
    notebooks.prepare(folder, page)
    with contextlib.chdir(folder):  # the notebooks of the lectures before were run
        for file, text in files.earlier(reading.page(name), language).items():
            files.provide(file, text)
    kernel = Notebook(folder, "--time", "virtual")
    try:
        for kind, text, fails in notebooks.cells(page.read_text(encoding="utf-8"), language):
            task = _CHECK.search(text) if kind == "code" else None
            if kind != "code":
                continue
            answer = kernel.run(text)
            if (answer.reply["status"] == "error") is not fails:
                wrong.append(f"{text}\n{answer.printed}{answer.reply.get('evalue', '')}")
            if task is None:
                continue
            if "Not yet." not in answer.printed:
                wrong.append(f"{task[1]}, before it was solved: {answer.printed}")
            for cell in (solution(task[1], language), text):
                answer = kernel.run(cell)
                if answer.reply["status"] == "error":
                    wrong.append(f"{cell}\n{answer.printed}{answer.reply.get('evalue', '')}")
            verdicts[task[1]] = "Well done" in answer.printed
            if not verdicts[task[1]]:
                wrong.append(f"{task[1]}, solved: {answer.printed}")
    finally:
        kernel.end()
    return wrong, verdicts
