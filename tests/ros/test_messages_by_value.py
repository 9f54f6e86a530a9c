"""Messages compare by value, and can be copied and pickled."""

import copy
import pickle

import numpy as np
import pytest

from cramhy_runtime.ros import messages
from cramhy_runtime.ros.python import message_class, service_type

Twist, Vector3 = message_class("geometry_msgs/Twist"), message_class("geometry_msgs/Vector3")
Path, PoseStamped = message_class("nav_msgs/Path"), message_class("geometry_msgs/PoseStamped")


def test_messages_with_the_same_values_are_equal():
    assert Twist(angular=Vector3(z=0.5)) == Twist(angular=Vector3(z=0.5))
    assert not Twist(angular=Vector3(z=0.5)) != Twist(angular=Vector3(z=0.5))
    assert Twist() != Twist(angular=Vector3(z=0.5))
    assert Vector3() != Twist() and Twist() != 3 and Twist() != None  # noqa: E711
    assert Path(poses=[PoseStamped()]) == Path(poses=[PoseStamped()]) != Path()
    assert Twist() in [Twist()]


@pytest.mark.parametrize("other", [(1, 2), [1, 2], np.array([1, 2]), bytes([1, 2])])
def test_arrays_are_equal_in_all_their_forms(other):
    octets = message_class("std_msgs/UInt8MultiArray")
    assert octets(data=[1, 2]) == octets(data=other) == octets(data=[1, 2])
    assert octets(data=[1, 3]) != octets(data=other)


def test_false_and_nil_are_one_truth_value():
    assert message_class("std_msgs/Bool")(data=None) == message_class("std_msgs/Bool")(data=False)
    assert message_class("std_msgs/Bool")(data=None) != message_class("std_msgs/Bool")(data=True)


@pytest.mark.parametrize("message", [Twist(angular=Vector3(z=0.5)), Path(poses=[PoseStamped()]), service_type("turtlesim/Spawn").request(x=3),
                                     service_type("std_srvs/SetBool").response(message="ö")])  # fmt: skip
def test_copies_are_equal_and_deep_ones_share_nothing(message):
    for other in (copy.copy(message), copy.deepcopy(message), pickle.loads(pickle.dumps(message))):
        assert other == message and other is not message and type(other) is type(message)
    if isinstance(message, Twist):
        deep = copy.deepcopy(message)
        deep.angular.z = 9.0
        assert message.angular.z == 0.5 and copy.copy(message).angular is message.angular


def test_a_pickled_message_of_a_package_that_is_not_there_says_so():
    with pytest.raises(TypeError, match="There is no message type nowhere_msgs/Thing. Is its package on ROS_PACKAGE_PATH?"):
        messages._restored("nowhere_msgs/Thing", [])
