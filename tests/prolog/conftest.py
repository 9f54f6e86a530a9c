import pytest
from prolog_text import RegisteredWarnings

from cramhy_runtime import kernel


@pytest.fixture(autouse=True)
def fresh_kernel():
    yield kernel.start(clock="virtual", time_limit=3600)
    kernel.stop()


@pytest.fixture
def warnings_given():
    """The texts of the warnings that the test signals; they are not printed."""
    with RegisteredWarnings() as given:
        yield given


@pytest.fixture(autouse=True)
def no_groups_left():
    """Fact groups that a test defines are gone after it."""
    from cramhy_runtime.prolog.engine import fact_groups as facts

    before = set(facts.fact_group_names())
    yield
    for name in facts.fact_group_names():
        if name not in before:
            facts.remove_fact_group(name)
