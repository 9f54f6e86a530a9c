"""Laws 21 to 33 of roslisp.md, and the rest of its section 5: messages as a program makes, prints and sends them."""

import pytest

HEARD = """
(defvar *heard* nil)
(start-ros-node "n")
(defun heard (type message)
  "What a subscriber gets of MESSAGE."
  (let ((topic (string-downcase (symbol-name (gensym "TOPIC")))))
    (setf *heard* nil)
    (subscribe topic type (lambda (m) (setf *heard* m)))
    (publish (advertise topic type) message)
    (roslisp:wait-duration 0.1)
    *heard*))
"""


def shown(lisp, text):
    """What ``text`` prints."""
    lisp.output.take()
    lisp(text)
    return lisp.output.take()


@pytest.mark.law("roslisp", 21)
def test_fresh_messages_have_the_defaults_of_their_fields(lisp):
    assert (
        lisp(
            '(with-fields (x y theta linear_velocity angular_velocity) (make-msg "turtlesim/Pose")'
            "  (every (lambda (v) (eql v 0.0)) (list x y theta linear_velocity angular_velocity)))"
        )
        == "T"
    )
    assert lisp("(turtlesim-srv:name (make-request turtlesim-srv:spawn))") == '""'
    assert lisp('(with-fields (seq stamp frame_id) (make-msg "std_msgs/Header") (list seq stamp frame_id))') == '(0 0 "")'
    assert lisp('(std_msgs-msg:data (make-msg "std_msgs/Bool"))') == "NIL"
    assert lisp('(geometry_msgs-msg:poses (make-msg "geometry_msgs/PoseArray"))') == "#()"
    assert lisp('(length (geometry_msgs-msg:covariance (make-msg "geometry_msgs/PoseWithCovariance")))') == "36"


@pytest.mark.law("roslisp", 22)
def test_field_paths_are_read_inside_out(lisp):
    assert (
        lisp(
            "(with-fields ((a (x linear)) (b (y linear)) (c (z linear)) (d (x angular)) (e (y angular)) (f (z angular)))"
            '    (make-msg "geometry_msgs/Twist" (:x :linear) 1 (:z :angular) 2.5) (list a b c d e f))'
        )
        == "(1 0.0 0.0 0.0 0.0 2.5)"
    )


@pytest.mark.law("roslisp", 23)
def test_of_two_values_for_a_field_the_first_counts(lisp):
    assert lisp('(turtlesim-msg:x (make-msg "turtlesim/Pose" :x 1 :x 2))') == "1"
    assert (
        lisp(
            '(let ((v (make-msg "geometry_msgs/Vector3" :y 7)))'
            '  (eq v (geometry_msgs-msg:linear (make-msg "geometry_msgs/Twist" :linear v (:x :linear) 5))))'
        )
        == "T"
    )


@pytest.mark.law("roslisp", 24)
def test_make_msg_folds_case_and_advertise_does_not(lisp):
    assert lisp('(type-of (make-msg "TURTLESIM/pose"))') == "TURTLESIM-MSG:POSE"
    lisp('(start-ros-node "n")')
    assert lisp.error('(advertise "t" "turtlesim/pose")') == "Case mismatch for message type turtlesim/pose, did you mean turtlesim/Pose?"
    assert lisp.error('(advertise "t" "turtlesim/Nope")') == "No datatype turtlesim/Nope known"


@pytest.mark.law("roslisp", 25)
def test_with_fields_binds_plain_variables(lisp):
    assert (
        lisp(
            '(let ((m (make-msg "geometry_msgs/Twist" (:x :linear) 1 (:z :angular) 2)))'
            "  (list (with-fields ((a (x linear)) (b (:z :angular))) m (setf a 10) (list a b))"
            "        (with-fields ((a (x linear)) linear) m (list a (geometry_msgs-msg:x linear)))))"
        )
        == "((10 2) (1 1))"
    )


@pytest.mark.law("roslisp", 26)
def test_a_modified_copy_shares_what_is_untouched(lisp):
    assert (
        lisp(
            '(let* ((m (make-msg "geometry_msgs/Twist" (:x :linear) 1)) (before (format nil "~s" m))'
            "       (n (modify-message-copy m (:y :linear) 2)))"
            '  (list (eq m n) (string= before (format nil "~s" m)) (eq (geometry_msgs-msg:angular m) (geometry_msgs-msg:angular n))'
            "        (with-fields ((a (x linear)) (b (y linear))) n (list a b))))"
        )
        == "(NIL T T (1 2))"
    )


def test_setf_msg_replaces_what_a_place_holds(lisp):
    assert lisp('(let* ((m (make-msg "geometry_msgs/Twist")) (places (list m)) (n (setf-msg (first places) (:x :linear) 3)))'
                "  (list (eq n (first places)) (eq m n) (with-fields ((a (x linear))) n a) (with-fields ((a (x linear))) m a)))"
                ) == "(T NIL 3 0.0)"  # fmt: skip


@pytest.mark.law("roslisp", 27)
def test_a_message_is_printed_as_a_block(lisp):
    text = shown(lisp, '(format t "~s" (make-msg "turtlesim/Pose" :x 5.5d0))')
    assert text.startswith("[TURTLESIM-MSG:POSE\n   X:\n     5.5d0\n   Y:\n") and text.endswith("\n   ANGULAR_VELOCITY:\n     0.0]")


@pytest.mark.law("roslisp", 28)
def test_without_escaping_the_package_is_not_shown(lisp):
    fields = "".join(f"\n{' ' * 15}{name}:\n{' ' * 17}{value}" for name, value in zip("RGB", (1, 0, 0)))
    assert shown(lisp, '(format t "Text before ~a" (make-msg "turtlesim/Color" :r 1))') == f"Text before [COLOR{fields}]"


@pytest.mark.law("roslisp", 29)
def test_parts_are_printed_as_lists(lisp):
    assert shown(lisp, '(format t "~s" (make-msg "geometry_msgs/Twist" (:x :linear) 1 (:z :angular) 2.5))') == (
        "[GEOMETRY_MSGS-MSG:TWIST\n   LINEAR:\n     (GEOMETRY_MSGS-MSG:VECTOR3 (:X . 1) (:Y . 0.0) (:Z . 0.0))\n   ANGULAR:\n"
        "     (GEOMETRY_MSGS-MSG:VECTOR3 (:X . 0.0) (:Y . 0.0) (:Z . 2.5))]"
    )
    assert shown(lisp, '(let (*print-pretty*) (prin1 (make-msg "geometry_msgs/Vector3")))').startswith("#<GEOMETRY_MSGS-MSG:VECTOR3 {")


def test_arrays_of_messages_are_blocks_inside_a_vector(lisp):
    assert shown(lisp, '(prin1 (make-msg "geometry_msgs/Polygon" :points (vector (make-msg "geometry_msgs/Point32" :x 1))))') == (
        "[GEOMETRY_MSGS-MSG:POLYGON\n   POINTS:\n     #([GEOMETRY_MSGS-MSG:POINT32\n          X:\n            1\n          Y:\n"
        "            0.0\n          Z:\n            0.0])]"
    )
    assert shown(lisp, '(prin1 (make-msg "std_msgs/Float32MultiArray" :data #(1 2 3.5)))').endswith(
        "   DATA:\n     #(1 2 3.5)]")  # fmt: skip


@pytest.mark.law("roslisp", 30)
def test_a_float32_arrives_as_the_double_nearest_to_the_single(lisp):
    assert lisp(HEARD + '(turtlesim-msg:x (heard "turtlesim/Pose" (make-msg "turtlesim/Pose" :x 5.544445)))') == "5.544445037841797d0"


@pytest.mark.law("roslisp", 31)
def test_a_bool_is_true_for_all_but_nil(lisp):
    lisp(HEARD)
    for value, got in (("0", "T"), ("nil", "NIL"), ("t", "T")):
        assert lisp(f'(std_msgs-msg:data (heard "std_msgs/Bool" (make-msg "std_msgs/Bool" :data {value})))') == got


@pytest.mark.law("roslisp", 32)
def test_integers_keep_their_low_bits_and_floats_are_refused(lisp):
    lisp(HEARD)
    assert lisp('(turtlesim-msg:r (heard "turtlesim/Color" (make-msg "turtlesim/Color" :r 300)))') == "44"
    assert lisp('(turtlesim-msg:r (heard "turtlesim/Color" (make-msg "turtlesim/Color" :r -1)))') == "255"
    assert lisp.error('(heard "turtlesim/Color" (make-msg "turtlesim/Color" :r 3.0))') == "The value 3.0 is not of type INTEGER"
    assert lisp('(turtlesim-msg:r (make-msg "turtlesim/Color" :r 3.0))') == "3.0"  # nobody looks before it is sent


@pytest.mark.law("roslisp", 33)
def test_constants_by_name_and_by_number(lisp):
    assert lisp("(symbol-code 'rosgraph_msgs-msg:Log :warn)") == "4"
    assert lisp("(symbol-codes 'rosgraph_msgs-msg:Log)") == "((:DEBUG . 1) (:INFO . 2) (:WARN . 4) (:ERROR . 8) (:FATAL . 16))"
    assert lisp("(code-symbol (make-instance 'rosgraph_msgs-msg:Log) 8)") == ":ERROR"
    assert lisp.error("(symbol-code 'rosgraph_msgs-msg:Log :nope)") == "Could not get symbol code for NOPE for ROS message type LOG"
    assert lisp.error("(code-symbol 'rosgraph_msgs-msg:Log 5)") == "Could not get code symbol for 5 in ROS message type LOG"


# ------------------------------------------------------------------------------------------------- the rest of section 5


@pytest.mark.parametrize(
    "form, text",
    [
        ('(make-msg "nope/Nope")', "Can't find package NOPE-MSG"),
        ('(make-msg "turtlesim/Nope")', "Can't find class for turtlesim/Nope"),
        ("(make-msg 3)", "3 fell through ETYPECASE expression. Wanted one of (STRING SYMBOL)."),
        ('(make-instance \'turtlesim-msg:pose :foo 1)',
         "Invalid initialization argument: :FOO in call for class #<STANDARD-CLASS TURTLESIM-MSG:POSE>."),
        ("(setf (turtlesim-msg:x (make-instance 'turtlesim-msg:pose)) 1)",
         "The function (COMMON-LISP:SETF TURTLESIM-MSG:X) is undefined."),
    ],
)  # fmt: skip
def test_mistakes(lisp, form, text):
    assert lisp.error(form).removesuffix(" See also: The ANSI Standard, Section 7.1.2") == text


def test_legacy_names_work_with_one_warning(lisp, request):
    field, name = {"threads": ("window_start", "TopicStatistics"), "greenlet": ("window_stop", "Log")}[request.node.callspec.params["lisp"]]
    for form, warning in (
        (f"(rosgraph_msgs-msg:{field}-val (make-instance 'rosgraph_msgs-msg:TopicStatistics))",
         f"Using old-style slot reader rosgraph_msgs-msg:{field}-val is deprecated. Use rosgraph_msgs-msg:{field} instead."),
        (f"(make-msg 'rosgraph_msgs-msg:<{name}>)",
         f"using old message class name rosgraph_msgs-msg:<{name}> is deprecated: use rosgraph_msgs-msg:{name} instead."),
    ):  # fmt: skip
        lisp(form)
        assert warning in lisp.warned().replace("; ", "")
        lisp(form)
        assert lisp.warned() == ""


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize(
    "type_name, value, got",
    [
        ("std_msgs/Time", "12.25", "12.25d0"),
        ("std_msgs/Duration", "-1/2", "-0.5d0"),
        ("std_msgs/Float64", "1/3", "0.3333333333333333d0"),
        ("std_msgs/Float64", "7", "7.0d0"),
        ("std_msgs/String", "nil", '""'),
        ("std_msgs/String", '"größe"', '"größe"'),
        ("std_msgs/String", '"€ 日本"', '"€ 日本"'),  # the original refuses it
        ("std_msgs/Char", "65", "65"),
        ("std_msgs/Byte", "-1", "255"),
        ("std_msgs/Int8", "200", "-56"),
        ("std_msgs/Int64", "(expt 2 63)", "-9223372036854775808"),
        ("std_msgs/UInt8MultiArray", "#(1 300)", "#(1 44)"),
        ("std_msgs/UInt8MultiArray", "nil", "#()"),
    ],
)
def test_what_arrives(lisp, type_name, value, got):
    assert lisp(HEARD + f'(std_msgs-msg:data (heard "{type_name}" (make-msg "{type_name}" :data {value})))') == got


@pytest.mark.parametrize(
    "type_name, value, text",
    [
        ("std_msgs/Float64", '"a"', 'The value "a" is not of type REAL when binding SB-KERNEL::X'),
        ("std_msgs/String", "3", "The value 3 is not of type STRING"),
        ("std_msgs/UInt8", "t", "The value T is not of type INTEGER"),
        ("std_msgs/UInt8MultiArray", '"abc"', "The value #\\a is not of type INTEGER"),
        ("std_msgs/UInt8MultiArray", "3", "The value 3 is not of type VECTOR"),
    ],
)
def test_what_cannot_be_sent(lisp, type_name, value, text):
    assert lisp.error(HEARD + f'(heard "{type_name}" (make-msg "{type_name}" :data {value}))') == text


def test_messages_are_read_in_their_list_form(lisp):
    assert lisp('(ros-message-to-list (make-msg "turtlesim/Color" :r 7))'.replace("ros-m", "roslisp-msg-protocol:ros-m")) == (
        "(TURTLESIM-MSG:COLOR (:R . 7) (:G . 0) (:B . 0))"
    )
    assert (
        lisp(
            '(with-fields ((a (x linear))) (with-input-from-string (in "(geometry_msgs-msg:twist (:linear . (geometry_msgs-msg:vector3 '
            '(:x . 3))))") (read-ros-message in)) a)'
        )
        == "3"
    )
