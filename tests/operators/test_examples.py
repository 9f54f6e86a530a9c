"""Every operator of the tables, written in Lisp, in plain Hy and in Python, does the same, on both back ends."""

import pytest
from examples import EXAMPLES, hy_of
from harness import in_hy, in_lisp, in_python

from cramhy_runtime.languages.operators import OPERATORS


def test_every_operator_has_an_example():
    assert sorted(EXAMPLES) == sorted(name.lower() for _, name in OPERATORS)


def test_an_example_without_python_says_why():
    assert [name for name, example in EXAMPLES.items() if bool(example.python) == bool(example.only)] == []


def test_four_operators_have_no_python_way():
    """A figure that may only fall. What Python's own statements do is written with them."""
    assert [name for name, example in EXAMPLES.items() if not example.python] == [
        "with-offline-episode-knowledge",
        "defstore-episode-knowledge-backend",
        "defrestore-episode-knowledge-backend",
        "load-if-necessary",
    ]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", EXAMPLES)
def test_hy_does_what_lisp_does(name, backend):
    example = EXAMPLES[name]
    assert in_hy(hy_of(example), backend) == in_lisp(example.lisp, backend)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", [name for name, example in EXAMPLES.items() if example.python])
def test_python_does_what_lisp_does(name, backend):
    example = EXAMPLES[name]
    assert in_python(example.python, backend) == in_lisp(example.lisp, backend)
