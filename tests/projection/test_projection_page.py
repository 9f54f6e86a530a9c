"""docs/projection.md names everything that there is. Its examples are run by ``tests/docs``."""

from pathlib import Path

import pytest

from .test_inventory import EXPORTS

PAGE = (Path(__file__).parents[2] / "docs" / "projection.md").read_text()


@pytest.mark.parametrize("package", EXPORTS)
def test_every_macro_and_variable_is_told_of(package):
    there = {*EXPORTS[package].get("macro", "").split(), *EXPORTS[package].get("variable", "").split()}
    untold = {name for name in there if name.lower() not in PAGE}
    assert untold <= {"with-episode-knowledge", "*episode-knowledge*", "*last-episode-knowledge*"}
