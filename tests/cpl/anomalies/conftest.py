"""The plans of the anomaly loop bring kernels of their own, and leave nothing behind for other tests."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.prolog.facts import fact_group_names, remove_fact_group


@pytest.fixture(autouse=True)
def fresh_kernel():
    kernel.stop()


@pytest.fixture(scope="package", autouse=True)
def facts_are_forgotten():
    before = set(fact_group_names() or ())
    yield
    for name in set(fact_group_names() or ()) - before:
        remove_fact_group(name)
