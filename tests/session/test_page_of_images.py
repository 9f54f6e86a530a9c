"""docs/images.md: its examples run as they stand, and print what stands below them."""

import contextlib
import io
import re
import threading
from pathlib import Path

import pytest
from cramhy_runtime.session import outside

PAGE = Path(__file__).parents[2] / "docs" / "images.md"


@pytest.mark.soak
def test_the_examples_of_the_page_print_what_it_shows():
    blocks = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", PAGE.read_text(), re.S)
    assert len(blocks) == 4
    printed, problems = [], []

    def run():
        space = {"__name__": "page"}
        try:
            for code, _ in blocks:
                printed.append(io.StringIO())
                with contextlib.redirect_stdout(printed[-1]), contextlib.redirect_stderr(io.StringIO()):
                    exec(compile(code, str(PAGE), "exec"), space)
        except BaseException as problem:
            problems.append(problem)

    thread = threading.Thread(target=run)  # one that is in no image, as the reader is
    thread.start()
    with outside():
        thread.join()
    for problem in problems:
        raise problem
    texts = ["".join(line for line in text.getvalue().splitlines(True) if "INFO]" not in line) for text in printed]
    assert texts == [shown for _, shown in blocks]
