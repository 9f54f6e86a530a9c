"""Parameters come back to Python and Hy as they went in, and Lisp sees its own values of them."""

import hy
import numpy as np
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros.python import get_param, has_param, ros_node, set_param
from cramhy_runtime.ros.roslisp import parameters
from cramhy_runtime.session import Image

VALUES = [
    False, True, 0, 1, -(2**31), 0.0, 1.5, "", "Grüße", [], [False, []], ["a", 1, [2.5, True]], {}, {"a": {"b": False, "c": []}},
]  # fmt: skip


@pytest.fixture(autouse=True)
def node(session):
    with Image(as_now=True):
        kernel.start(clock="virtual", time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_a_value_comes_back_as_it_went_in(value):
    set_param("value", value)
    assert repr(get_param("value")) == repr(value)
    assert repr(get_param("value", 7)) == repr(value)
    assert has_param("value") is True
    module = {"__name__": "program"}
    program = '(require cramhy *) (set-param "other" value) #((get-param "other") (has-param "other"))'
    module["value"] = value
    assert repr(hy.eval(hy.read_many(program), module)) == repr((value, True))


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("value", [False, None, [], {}, (), ""], ids=repr)
def test_a_default_is_returned_as_it_is(value):
    assert get_param("missing", value) is value
    assert has_param("missing") is False


def test_a_dict_can_be_read_by_its_names():
    set_param("arm", {"speed": 0.5})
    assert get_param("arm/speed") == 0.5


@pytest.mark.parametrize(
    "given, kept", [((1, 2), [1, 2]), (np.float64(1.5), 1.5), (np.int64(3), 3), (np.bool_(False), False), (np.array([[1, 2]]), [[1, 2]])]
)
def test_values_of_libraries_become_plain(given, kept):
    set_param("value", given)
    assert repr(get_param("value")) == repr(kept)


@pytest.mark.parametrize(
    "value, text",
    [
        (None, "The parameter value cannot be None: ROS has no such value. Write False or an empty text, or call delete_param."),
        ([1, None], "The parameter value cannot be None"),
        ({1: 2}, "The parameter value has the name 1 in a dict. The names of parameters are texts: '1'."),
    ],
)
def test_what_ros_cannot_keep_is_refused(value, text):
    with pytest.raises(TypeError) as caught:
        set_param("value", value)
    assert str(caught.value).startswith(text)


def test_changing_a_value_that_was_read_changes_no_parameter():
    set_param("names", ["a"])
    get_param("names").append("b")
    assert get_param("names") == ["a"]


def test_lisp_sees_nil_for_false():
    set_param("use", False)
    assert parameters.get_param("use") is None
    assert parameters.has_param("use") is True
