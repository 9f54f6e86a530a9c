"""ROSLISP-MSG-PROTOCOL: messages as bytes; and the internals of roslisp that programs look at (roslisp.md 1, 2.5, 5.6, 15)."""

import pytest

from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.ros.wire import transmit

POSE = """(make-msg "geometry_msgs/PoseStamped" (:frame_id :header) "map" (:stamp :header) 12.5d0 (:seq :header) 7
            (:x :position :pose) -1.5 (:w :orientation :pose) 1)"""
MESSAGES = [
    POSE,
    '(make-msg "std_msgs/String" :data "gr\\"oss")',
    '(make-msg "std_msgs/String" :data "")',
    '(make-msg "std_msgs/Bool" :data t)',
    '(make-msg "std_msgs/Bool" :data nil)',
    '(make-msg "std_msgs/Int8" :data -3)',
    '(make-msg "std_msgs/UInt64" :data 18446744073709551615)',
    '(make-msg "std_msgs/Float32" :data 0.5)',
    '(make-msg "std_msgs/Duration" :data -2.25d0)',
    '(make-msg "std_msgs/Float64MultiArray" :data (vector 1.0d0 2.5d0))',
    '(make-msg "turtlesim/Pose" :x 1.5 :theta -0.25)',
    '(make-msg "tf2_msgs/TFMessage" :transforms (vector (make-msg "geometry_msgs/TransformStamped" :child_frame_id "cup")))',
    '(make-request "turtlesim/Spawn" :x 1 :name "t2")',
]
THROUGH_A_FILE = """
(defun through-a-file (message what)
  (with-open-file (out "{0}" :direction :output :if-exists :supersede :element-type '(unsigned-byte 8))
    (roslisp-msg-protocol:serialize message out))
  (with-open-file (in "{0}" :element-type '(unsigned-byte 8))
    (prog1 (roslisp-msg-protocol:deserialize what in) (note (list (file-length in) (read-byte in nil :end))))))
"""


@pytest.fixture
def bytes_(lisp, tmp_path):
    lisp(THROUGH_A_FILE.format(tmp_path / "message.bin"))
    return lisp


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize("form", MESSAGES)
def test_what_is_written_is_read_again(bytes_, form):
    bytes_(f"(defvar *m* {form}) (defvar *back* (through-a-file *m* (class-name (class-of *m*))))")
    assert bytes_("(eq *m* *back*)") == "NIL"
    sent = transmit(bytes_.value("*m*"))  # what a subscriber would get
    assert princ_to_string(sent) == princ_to_string(bytes_.value("*back*"))
    assert bytes_("(equal (first *notes*) (list (roslisp-msg-protocol:serialization-length *m*) :end))") == "T"


def test_the_bytes_are_those_of_ros(bytes_, tmp_path):
    bytes_('(through-a-file (make-msg "std_msgs/String" :data "ab") \'std_msgs-msg:string)')
    assert (tmp_path / "message.bin").read_bytes() == b"\x02\x00\x00\x00ab"
    assert bytes_('(roslisp-msg-protocol:serialization-length (make-msg "turtlesim/Pose"))') == "20"


def test_a_message_is_filled_and_returned(bytes_):
    bytes_('(defvar *m* (make-msg "turtlesim/Pose"))')
    assert bytes_('(eq *m* (through-a-file (make-msg "turtlesim/Pose" :x 1.5) *m*))') == "T"
    assert bytes_("(turtlesim-msg:x *m*)") == "1.5d0"


def test_a_stream_that_ends_too_early_and_one_of_characters(bytes_):
    bytes_('(defvar *m* (make-msg "std_msgs/String" :data "a"))')
    assert bytes_.error("(through-a-file *m* 'turtlesim-msg:pose)", "end-of-file")
    assert "is not a binary output stream" in bytes_.error("(roslisp-msg-protocol:serialize *m* (make-string-output-stream))")


@pytest.mark.parametrize("call", ["(serialize 3 t)", "(deserialize 3 t)", "(serialization-length nil)", "(service-request-type 4)"])
def test_what_is_no_message_has_no_method(lisp, call):
    assert "There is no applicable method" in lisp.error(call.replace("(", "(roslisp-msg-protocol:", 1))


def test_the_classes_of_a_service(lisp):
    assert lisp("(roslisp-msg-protocol:service-request-type 'turtlesim-srv:spawn)") == "TURTLESIM-SRV:SPAWN-REQUEST"
    assert lisp('(roslisp-msg-protocol:service-response-type "turtlesim/Spawn")') == "TURTLESIM-SRV:SPAWN-RESPONSE"


def test_users_may_define_methods(lisp):
    lisp("(defclass mine () ()) (defmethod roslisp-msg-protocol:serialization-length ((m mine)) 42)")
    assert lisp("(list (roslisp-msg-protocol:serialization-length (make-instance 'mine))"
                " (roslisp-msg-protocol:serialization-length (make-msg \"std_msgs/Bool\")))") == "(42 1)"  # fmt: skip


def test_nothing_that_the_packages_export_is_without_a_meaning(lisp):
    for package in ("roslisp-msg-protocol", "roslisp-utils"):
        unbound = lisp(f"""(let (found) (do-external-symbols (s :{package} found)
                             (unless (or (fboundp s) (find-class s nil) (macro-function s)) (push s found))))""")
        assert unbound in ("NIL", "(ROSLISP-UTILS:UNTIL-TIMEOUT)")


def test_tokens(lisp):
    assert lisp('(roslisp-utils:tokens " a bc  d ")') == '("a" "bc" "d")'
    assert lisp('(roslisp-utils:tokens "/a/b" :separators \'(#\\/) :start 1)') == '("a" "b")'


def test_the_state_of_the_node_by_the_internal_variables(lisp):
    assert lisp("roslisp::*node-status*") == ":SHUTDOWN"
    lisp('(start-ros-node "n" :cmd-line-args \'("a:=b" "__ns:=/house"))')
    assert lisp("(list roslisp::*node-status* roslisp::*namespace*)") == '(:RUNNING "/house/")'
    assert lisp('(gethash "/a" roslisp::*remapped-names*)') == '"/b" ; T'
    lisp("(shutdown-ros-node)")
    assert lisp("roslisp::*node-status*") == ":SHUTDOWN"


def test_names_of_the_packages_below_are_there_with_two_colons(lisp):
    for name in "ros-datatype md5sum serialize deserialize serialization-length ros-message-to-list".split():
        assert lisp(f"(eq 'roslisp::{name} 'roslisp-msg-protocol:{name})") == "T"
        assert lisp(f'(nth-value 1 (find-symbol "{name.upper()}" :roslisp))') == ":INTERNAL"


def test_the_topic_of_a_broadcaster(lisp):
    lisp('(start-ros-node "n")')
    assert lisp("(cl-tf:topic (cl-tf:make-transform-broadcaster))") == '"/tf"'
    assert lisp('(cl-tf:topic (cl-tf:make-transform-broadcaster :topic "/tf_projection"))') == '"/tf_projection"'
    assert lisp("(cl-tf:topic (cl-tf2:make-transform-broadcaster))") == '"/tf"'
    assert "no applicable method" in lisp.error("(cl-tf:topic 3)")


def test_a_node_of_a_plan_tree_is_made(lisp):
    assert lisp("(cram-walker:make-plan-tree-node :sexp '(a))") == "#(PLAN-TREE-NODE :SEXP (A) :PATH NIL :CHILDREN NIL)"
    assert (
        lisp("""(let* ((root (walker:make-plan-tree-node)) (child (walker:make-plan-tree-node :parent root :path '((tagged a)))))
                     (list (walker:plan-tree-node-p child) (eq (walker:plan-tree-node-parent (walker:copy-plan-tree-node child)) root)))""")
        == ("(T T)")
    )


def test_the_root_of_all_messages_has_a_name(bytes_):
    bytes_("(defvar *root* (find-class 'roslisp-msg-protocol:ros-message))")
    assert bytes_("(eq (class-name *root*) 'roslisp-msg-protocol:ros-message)") == "T"
    assert bytes_("(equal (sb-mop:class-direct-superclasses (find-class 'turtlesim-msg:pose)) (list *root*))") == "T"
