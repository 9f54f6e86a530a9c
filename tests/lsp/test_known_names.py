"""What the texts of a system define for plans."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from cramhy_runtime.lsp.known_names import KnownNames  # noqa: E402  it needs pygls
from cramhy_runtime.lsp.texts import Text  # noqa: E402


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("(make-goal :speed 1)", {"SPEED"}),
        ("(add-goal :speed 1)", {"SPEED"}),  # begins as A does
        ("(and-so-on :angle 2 :speed 1)", {"ANGLE", "SPEED"}),
        ("(desig-prop ?d (:radius ?r))", {"RADIUS"}),
        ("(with-desig-props (speed angle) ?d)", {"SPEED", "ANGLE"}),
        ("(an action :speed 1)", set()),  # what a designator itself says is what is checked
        ("(desig:a motion :speed 1)", set()),
    ],
)
def test_keywords_in_calls_are_keys_of_designators(text, keys):
    told = KnownNames([Text(text)]).keys - KnownNames([]).keys
    assert told == keys - KnownNames([]).keys
