"""Solutions are not tests, whatever their tasks are called. What a learner of Hy has defined in one test is not there in the next."""

import sys

import pytest

collect_ignore = ["solutions"]


@pytest.fixture(autouse=True)
def fresh_console():
    """Forget the module in which Hy's prompt evaluates: all prompts of a process share it."""
    yield
    sys.modules.pop("__console__", None)
