"""Making, reading and printing messages (roslisp.md 5; golden/02)."""

import pytest

from cramhy_runtime.lisp_core.condition_types import Error
from cramhy_runtime.lisp_core.data import python_list
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.ros import messages, wire
from cramhy_runtime.ros.message_building import (
    code_symbol,
    code_symbols,
    get_field,
    list_to_ros_message,
    make_message,
    make_request,
    make_response,
    modify_message_copy,
    msg_slot_value,
    ros_datatype,
    ros_message_to_list,
    symbol_code,
    symbol_codes,
)

POSE = """[TURTLESIM-MSG:POSE
   X:
     5.5d0
   Y:
     5
   THETA:
     0.0
   LINEAR_VELOCITY:
     0.0
   ANGULAR_VELOCITY:
     0.0]"""
TWIST = """[GEOMETRY_MSGS-MSG:TWIST
   LINEAR:
     (GEOMETRY_MSGS-MSG:VECTOR3 (:X . 1.5) (:Y . 0.0) (:Z . 0.0))
   ANGULAR:
     (GEOMETRY_MSGS-MSG:VECTOR3 (:X . 0.0) (:Y . 0.0) (:Z . 2))]"""
POSE_STAMPED = """[GEOMETRY_MSGS-MSG:POSESTAMPED
   HEADER:
     (STD_MSGS-MSG:HEADER (:SEQ . 0) (:STAMP . 0) (:FRAME_ID . ""))
   POSE:
     (GEOMETRY_MSGS-MSG:POSE
      (:POSITION
       . [GEOMETRY_MSGS-MSG:POINT
            X:
              0.0
            Y:
              0.0
            Z:
              0.0])
      (:ORIENTATION
       . [GEOMETRY_MSGS-MSG:QUATERNION
            X:
              0.0
            Y:
              0.0
            Z:
              0.0
            W:
              0.0]))]"""


def prin1(obj):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    return prin1_to_string(obj)


def princ(obj):
    from cramhy_runtime.languages.commonlisp.printer.printer import princ_to_string

    return princ_to_string(obj)


class TestMaking:
    def test_defaults(self):
        assert make_message("turtlesim/Pose").values() == [0.0] * 5
        assert make_request(sym("TURTLESIM-SRV::SPAWN")).name == ""
        assert make_message("std_msgs/Header").values() == [0, 0, ""]
        assert make_message("geometry_msgs/PoseWithCovariance").covariance == [0.0] * 36

    def test_paths_are_read_inside_out(self):
        twist = make_message("geometry_msgs/Twist", [(("X", "LINEAR"), 1), (("Z", "ANGULAR"), 2.5)])
        assert twist.linear.values() == [1, 0.0, 0.0]
        assert twist.angular.values() == [0.0, 0.0, 2.5]

    def test_of_two_values_for_one_field_the_first_counts(self):
        assert make_message("turtlesim/Pose", [(("X",), 1), (("X",), 2)]).x == 1

    def test_a_whole_part_given_first_overrides_its_fields_given_later(self):
        part = make_message("geometry_msgs/Vector3", [(("X",), 7)])
        assert make_message("geometry_msgs/Twist", [(("LINEAR",), part), (("X", "LINEAR"), 5)]).linear is part

    def test_a_part_that_was_given_is_never_changed(self):
        part = make_message("geometry_msgs/Vector3", [(("X",), 7)])
        twist = make_message("geometry_msgs/Twist", [(("X", "LINEAR"), 5), (("LINEAR",), part)])
        assert (twist.linear.x, part.x) == (5, 7)

    def test_messages_do_not_share_their_parts(self):
        first, second = make_message("geometry_msgs/Twist"), make_message("geometry_msgs/Twist")
        assert first.linear is not second.linear

    def test_case_does_not_matter_and_a_trailing_val_is_dropped(self):
        assert make_message("TURTLESIM/pose", [(("x-val",), 3)]).x == 3
        assert make_message(sym("TURTLESIM-MSG::POSE")).ros_type == "turtlesim/Pose"
        assert make_message(sym("TURTLESIM-MSG::<POSE>")).ros_type == "turtlesim/Pose"

    def test_nothing_is_checked_when_a_message_is_made(self):
        assert make_message("turtlesim/Pose", [(("X",), "abc")]).x == "abc"

    @pytest.mark.parametrize(
        "type_name, text", [("nope/Nope", "Can't find package NOPE-MSG"), ("turtlesim/Nope", "Can't find class for turtlesim/Nope")]
    )
    def test_unknown_types(self, fails, type_name, text):
        assert fails(make_message, type_name).report() == text

    def test_a_type_that_is_neither_string_nor_symbol(self, fails):
        assert fails(make_message, 3).report().startswith("3 fell through ETYPECASE expression.\nWanted one of (")

    def test_an_unknown_field_names_the_fields_there_are(self, fails):
        text = fails(make_message, "turtlesim/Pose", [(("FOO",), 1)]).report()
        assert " ".join(text.split()) == (
            "Could not find field FOO in (POSE (X . 0.0) (Y . 0.0) (THETA . 0.0) (LINEAR_VELOCITY . 0.0) (ANGULAR_VELOCITY . 0.0))"
        )

    def test_fields_keep_their_underscores(self, fails):
        fails(make_message, "std_msgs/Header", [(("FRAME-ID",), "map")])

    def test_responses_take_keywords(self):
        assert make_response(sym("TURTLESIM-SRV::SPAWN"), sym(":NAME"), "x").name == "x"


class TestChanging:
    def test_a_modified_copy_shares_what_is_untouched(self):
        original = make_message("geometry_msgs/Twist", [(("X", "LINEAR"), 1)])
        changed = modify_message_copy(original, [(("Y", "LINEAR"), 2)])
        assert changed is not original and changed.angular is original.angular
        assert (original.linear.y, changed.linear.x, changed.linear.y) == (0.0, 1, 2)


class TestReading:
    def test_with_fields_reads_inside_out(self):
        twist = make_message("geometry_msgs/Twist", [(("X", "LINEAR"), 1)])
        assert get_field(twist, ("X", "LINEAR")) == 1
        assert get_field(twist, ("LINEAR",)) is twist.linear

    def test_a_field_that_is_not_there(self, fails):
        vector = make_message("geometry_msgs/Vector3")
        text = " ".join(fails(get_field, vector, ("ZZ",)).report().split())
        assert text.startswith(
            "When attempting to read the slot's value (slot-value), the slot GEOMETRY_MSGS-MSG::ZZ is missing from the object"
        )

    def test_msg_slot_value_takes_strings_keywords_and_symbols(self):
        pose = make_message("turtlesim/Pose", [(("X",), 4)])
        assert [msg_slot_value(pose, slot) for slot in ("x", "X", sym(":X"), sym("CL-USER::X"))] == [4] * 4

    def test_readers_are_shared_within_a_package(self, fails):
        reader = sym("TURTLESIM-MSG::X").function
        assert reader(make_message("turtlesim/Pose", [(("X",), 2)])) == 2
        condition = fails(reader, 3)
        assert isinstance(condition, Error)
        assert condition.report().startswith(
            "There is no applicable method for the generic function\n  #<STANDARD-GENERIC-FUNCTION TURTLESIM-MSG:X (1)>"
            "\nwhen called with arguments\n  (3)."
        )


class TestPrinting:
    def test_a_message_is_a_block(self):
        assert prin1(make_message("turtlesim/Pose", [(("X",), 5.5), (("Y",), 5)])) == POSE

    def test_without_escape_prefixes_and_quotes_go(self):
        assert princ(make_message("turtlesim/Color")) == "[COLOR\n   R:\n     0\n   G:\n     0\n   B:\n     0]"
        assert princ(make_message("std_msgs/String", [(("DATA",), "hello")])) == "[STRING\n   DATA:\n     hello]"

    def test_parts_are_lists_and_their_parts_blocks_again(self):
        assert prin1(make_message("geometry_msgs/Twist", [(("X", "LINEAR"), SingleFloat(1.5)), (("Z", "ANGULAR"), 2)])) == TWIST
        assert prin1(make_message("geometry_msgs/PoseStamped")) == POSE_STAMPED

    def test_an_empty_message(self):
        assert prin1(make_response(sym("STD_SRVS-SRV::EMPTY"))) == "[STD_SRVS-SRV:EMPTY-RESPONSE]"

    def test_without_pretty_printing_it_is_an_object_with_an_address(self):
        with binding(sym("*PRINT-PRETTY*"), None):
            assert prin1(make_message("geometry_msgs/Vector3")).startswith("#<GEOMETRY_MSGS-MSG:VECTOR3 {")

    def test_a_long_part_is_filled(self):
        numbers = [1.123456789012345, -1.123456789012345, 0.0]
        vector = messages.message_class("geometry_msgs/Vector3")(*numbers)
        text = prin1(make_message("geometry_msgs/Twist", [(("LINEAR",), vector)])).splitlines()
        assert text[2:4] == [
            "     (GEOMETRY_MSGS-MSG:VECTOR3 (:X . 1.123456789012345d0)",
            "      (:Y . -1.123456789012345d0) (:Z . 0.0d0))",
        ]


class TestListForm:
    def test_there_and_back(self):
        form = ros_message_to_list(make_message("turtlesim/Color", [(("R",), 7)]))
        assert prin1(form) == "(TURTLESIM-MSG:COLOR (:R . 7) (:G . 0) (:B . 0))"
        assert list_to_ros_message(form).r == 7

    def test_constants(self, fails):
        log = sym("ROSGRAPH_MSGS-MSG::LOG")
        assert [(pair.car.name, pair.cdr) for pair in python_list(symbol_codes(log))] == [
            ("DEBUG", 1),
            ("INFO", 2),
            ("WARN", 4),
            ("ERROR", 8),
            ("FATAL", 16),
        ]
        assert symbol_code(log, sym(":WARN")) == 4
        assert code_symbol(log, 8) is sym(":ERROR")
        assert code_symbols(log, 5) is None
        assert symbol_codes(sym("TURTLESIM-MSG::POSE")) is None
        assert fails(symbol_code, log, sym(":NOPE")).report() == "Could not get symbol code for NOPE for ROS message type LOG"
        assert fails(code_symbol, log, 5).report() == "Could not get code symbol for 5 in ROS message type LOG"

    def test_datatypes(self):
        assert ros_datatype(sym("TURTLESIM-SRV::SPAWN")) == "turtlesim/Spawn"
        assert ros_datatype(sym("TURTLESIM-MSG::POSE")) == "turtlesim/Pose"


class TestTheWire:
    def sent(self, type_name, **fields):
        return wire.transmit(messages.message_class(type_name)(**fields))

    @pytest.mark.parametrize("given, received", [(300, 44), (-1, 255), (0, 0), (255, 255)])
    def test_integers_keep_their_low_bits(self, given, received):
        assert self.sent("turtlesim/Color", r=given).r == received

    def test_signed_integers_wrap_too(self):
        assert self.sent("std_msgs/Int8", data=200).data == -56
        assert self.sent("std_msgs/Byte", data=-1).data == 255

    @pytest.mark.parametrize("value, shown", [(3.0, "3.0d0"), (True, "T"), (None, "NIL"), ("a", '"a"')])
    def test_what_is_no_integer_is_a_type_error(self, fails, value, shown):
        assert fails(self.sent, "turtlesim/Color", r=value).report() == f"The value\n  {shown}\nis not of type\n  INTEGER"

    def test_reals_arrive_as_doubles(self):
        received = self.sent("geometry_msgs/Vector3", x=1, y=0.5)
        assert [type(value) for value in received.values()] == [float] * 3

    def test_float32_is_rounded(self):
        assert prin1(self.sent("turtlesim/Pose", x=5.544445).x) == "5.544445037841797d0"

    @pytest.mark.parametrize("value, shown", [(None, "NIL"), ("a", '"a"')])
    def test_what_is_no_real_is_a_type_error(self, fails, value, shown):
        assert (
            fails(self.sent, "turtlesim/Pose", x=value).report()
            == f"The value\n  {shown}\nis not of type\n  REAL\nwhen binding SB-KERNEL::X"
        )

    @pytest.mark.parametrize("value, received", [(None, False), (False, False), (0, True), ("", True), (True, True)])
    def test_every_value_but_nil_is_true(self, value, received):
        assert self.sent("std_msgs/Bool", data=value).data is received

    def test_strings_are_unicode(self, fails):
        for text in ("é", "€", "日本語", "🤖"):
            assert self.sent("std_msgs/String", data=text).data == text
        assert self.sent("std_msgs/String", data=None).data == ""
        fails(self.sent, "std_msgs/String", data="\ud800")

    def test_infinity_and_not_a_number_arrive_as_symbols(self):
        received = self.sent("geometry_msgs/Vector3", x=float("inf"), y=float("-inf"), z=float("nan"))
        assert [value.name for value in received.values()] == ["POSITIVE-INFINITY", "NEGATIVE-INFINITY", "NOT-A-NUMBER"]

    def test_arrays(self, fails):
        assert self.sent("std_msgs/UInt8MultiArray", data=[1, 300]).data == [1, 44]
        assert self.sent("std_msgs/UInt8MultiArray", data=None).data == []
        assert "36 elements" in fails(self.sent, "geometry_msgs/PoseWithCovariance", covariance=[1.0]).report()

    def test_what_arrives_is_a_fresh_object(self):
        twist = make_message("geometry_msgs/Twist")
        received = wire.transmit(twist)
        assert received is not twist and received.linear is not twist.linear

    def test_another_receiver_gets_another_object_with_the_same_values(self):
        polygon = self.sent("geometry_msgs/PolygonStamped", polygon=messages.message_class("geometry_msgs/Polygon")(
            points=[messages.message_class("geometry_msgs/Point32")(x=1)]))  # fmt: skip
        numbers = self.sent("std_msgs/UInt8MultiArray", data=[1, 2])
        for received, parts in ((polygon, ("header", "polygon")), (numbers, ("layout", "data"))):
            other = wire.fresh(received)
            assert other is not received and repr(other) == repr(received)
            assert all(getattr(other, part) is not getattr(received, part) for part in parts)
        assert wire.fresh(polygon).polygon.points[0] is not polygon.polygon.points[0]

    def test_a_part_of_another_kind_is_an_error(self, fails, printed):
        fails(self.sent, "geometry_msgs/Twist", linear=3)
        assert "Hmm... unexpectedly asked for serialization length of 3." in printed()


@pytest.mark.parametrize("make, hint", [
    (lambda: make_request("turtlesim/Spawn", [(("WHY",), 1)]), "turtlesim/Spawn has the fields x y theta name."),
    (lambda: make_response("turtlesim/Spawn", sym(":WHY"), 1), "The response of turtlesim/Spawn has the field name."),
    (lambda: make_response("std_srvs/Empty", sym(":WHY"), 1), "The response of std_srvs/Empty has no fields."),
    (lambda: make_message("geometry_msgs/Twist", [(("WHY",), 1)]), "geometry_msgs/Twist has the fields linear angular."),
    (lambda: make_message("geometry_msgs/Twist", [(("Q", "LINEAR"), 1)]), "geometry_msgs/Vector3 has the fields x y z."),
    (lambda: make_message("turtle_actionlib/ShapeGoal", [(("EDGE",), 1)]), "turtle_actionlib/ShapeGoal has the fields edges radius."),
])  # fmt: skip
def test_a_wrong_field_has_those_of_the_type_for_a_hint(make, hint):
    with pytest.raises(Error) as caught:
        make()
    assert caught.value.hint == hint


@pytest.mark.parametrize("name, specs, hint", [
    ("geometry_msgs/Twist", [(("X", "LINEAR"), "fast")], 'geometry_msgs/Twist: linear.x holds "fast", which is no float64.'),
    ("geometry_msgs/Twist", [(("LINEAR",), 3)], "geometry_msgs/Twist: linear holds 3, which is no geometry_msgs/Vector3."),
    ("turtlesim/Color", [(("G",), 1.5)], "turtlesim/Color: g holds 1.5, which is no uint8."),
    ("std_msgs/UInt8MultiArray", [(("DATA",), 3)], "std_msgs/UInt8MultiArray: data holds 3, which is no uint8[]."),
    ("std_msgs/UInt8MultiArray", [(("DATA",), [1, "a"])], 'std_msgs/UInt8MultiArray: data[1] holds "a", which is no uint8.'),
    ("geometry_msgs/PoseWithCovariance", [(("COVARIANCE",), [None])],
     "geometry_msgs/PoseWithCovariance: covariance[0] holds NIL, which is no float64."),
    ("std_msgs/String", [(("DATA",), "\ud800")],
     'std_msgs/String: data holds "\ud800", which has half of a surrogate pair, which is no character.'),
    ("std_msgs/Int8", [(("DATA",), "x" * 100)], f'std_msgs/Int8: data holds "{"x" * 59}..., which is no int8.'),
])  # fmt: skip
def test_a_wrong_value_has_its_place_for_a_hint(name, specs, hint):
    with pytest.raises(Error) as caught:
        wire.transmit(make_message(name, specs))
    assert caught.value.hint == hint


def test_the_place_of_a_wrong_value_in_a_list_of_parts():
    polygon = make_message("geometry_msgs/Polygon", [(("POINTS",), [make_message("geometry_msgs/Point32", [(("Y",), "no")])])])
    with pytest.raises(Error) as caught:
        wire.transmit(make_message("geometry_msgs/PolygonStamped", [(("POLYGON",), polygon)]))
    assert caught.value.hint == 'geometry_msgs/PolygonStamped: polygon.points[0].y holds "no", which is no float32.'
