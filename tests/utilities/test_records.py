"""Records are what `dataclasses` makes, as far as the compiler needs it."""

from __future__ import annotations

import dataclasses
import subprocess
import sys

import pytest

from cramhy_runtime.utilities import records


def classes(module):
    """The same two classes, made by ``module``."""

    @module.dataclass
    class Point:
        x: int
        y: int = 2
        kind = "not a field"

    @module.dataclass
    class Named(Point):
        names: list = module.field(default_factory=list)
        y: int = 5
        last: object = None

    return Point, Named


@pytest.fixture(params=[records, dataclasses], ids=lambda module: module.__name__)
def made(request):
    return classes(request.param)


def test_fields_are_given_in_order_or_by_name(made):
    Point, Named = made
    assert vars(Point(1)) == {"x": 1, "y": 2} and vars(Point(y=3, x=4)) == {"x": 4, "y": 3}
    assert vars(Named(1)) == {"x": 1, "y": 5, "names": [], "last": None}
    assert vars(Named(1, 2, ["a"], last=3)) == {"x": 1, "y": 2, "names": ["a"], "last": 3}
    assert Point(1).kind == "not a field" and Point.y == 2
    first, second = Named(1), Named(1)
    first.names.append(3)
    assert second.names == [] and not hasattr(Named, "names")


@pytest.mark.parametrize("values, named", [((), {}), ((1, 2, 3), {}), ((1,), {"x": 2}), ((1,), {"z": 2})])
def test_what_is_no_field_is_an_error(made, values, named):
    for _ in range(2):
        with pytest.raises(TypeError, match=r"__init__\(\)"):
            made[0](*values, **named)


def test_records_are_equal_by_their_fields_and_have_no_hash(made):
    Point, Named = made
    assert Point(1) == Point(1, 2) != Point(2) and Point(1) != Named(1) and Point(1) != (1, 2)
    assert repr(Point(1)).endswith("Point(x=1, y=2)")
    with pytest.raises(TypeError):
        hash(Point(1))


def test_fields_tell_their_names():
    for mine, theirs in zip(classes(records), classes(dataclasses)):
        assert [each.name for each in records.fields(mine)] == [each.name for each in dataclasses.fields(theirs)]


@pytest.mark.soak
def test_a_prompt_starts_without_what_inspects_classes():
    script = (
        "import sys\nfrom cramhy_runtime.repl.session import Session\nSession(time='virtual').evaluate_text('1')\n"
        "print([name for name in ('dataclasses', 'inspect', 'typing', 'json', 'traceback', 'shutil', 'hy') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-S", "-c", f"import sys; sys.path[:] = {sys.path}\n{script}"], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("[]\n", "")
