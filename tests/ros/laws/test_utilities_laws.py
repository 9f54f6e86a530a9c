"""Invariants 49 and 50 of roslisp.md: roslisp-utilities, as a user types them; and that every export exists."""

import re
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.ros.roslisp import utilities
from cramhy_runtime.turtlesim.node import start_turtlesim

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "roslisp.md"


@pytest.fixture(autouse=True)
def no_registrations():
    yield
    utilities.forget_registrations()


@pytest.mark.law("roslisp", 49)
def test_init_functions_run_by_descending_rank(lisp):
    lisp("""(defun low () (note 'low)) (defun high () (note (list 'high (node-status)))) (defun odd () (note 'odd))
            (register-ros-init-function low) (register-ros-init-function high 5) (register-ros-init-function odd hello)""")
    assert lisp("(list (startup-ros) *notes*)") == "(NIL ((HIGH :RUNNING) LOW ODD))"
    assert [line for line in lisp.printed() if "ROSNODE" in line] == [
        f"[(ROSNODE) INFO] T: ROS init #<FUNCTION {name}>." for name in ("HIGH", "LOW", "ODD")
    ]


@pytest.mark.law("roslisp", 50)
@pytest.mark.parametrize(
    "form, result",
    [
        ('(lispify-ros-name "FooBAR2Baz")', "FOO-BAR2-BAZ"),
        ("(rosify-lisp-name 'hello-world)", '"HelloWorld"'),
        ('(lispify-ros-name "HelloWorld")', "HELLO-WORLD"),
        ('(lispify-ros-name "turtle1Pose")', "TURTLE1-POSE"),
        ('(lispify-ros-name "foo_bar")', "FOO_BAR"),
        ('(lispify-ros-name "fooBar" :keyword)', ":FOO-BAR"),
        ("(rosify-lisp-name :foo-bar2-baz)", '"FooBar2Baz"'),
        ('(lispify-ros-underscore-name "foo_bar_Baz")', "FOO-BAR-BAZ"),
        ('(lispify-ros-underscore-name "a_b" :keyword)', ":A-B"),
        ("(rosify-underscores-lisp-name 'foo-bar)", '"foo_bar"'),
        ("(rosify-underscores-lisp-name '|Foo-bar|)", '"Foo-bar"'),
    ],
)
def test_names_between_ros_and_lisp(lisp, form, result):
    assert lisp(form) == result


def test_the_empty_name_has_no_lisp_name(lisp):
    assert lisp.error('(lispify-ros-name "")').startswith("Invalid index 0 for (SIMPLE-ARRAY CHARACTER (0))")


def test_the_default_name_is_anonymous(lisp):
    assert re.fullmatch(r'"/cram_hl_\d+_\d+"', lisp("(startup-ros) *ros-node-name*"))
    assert (
        lisp(
            '(startup-ros :name "n" :anonymous nil :cmd-line-args "__ns:=x" :master-uri (roslisp:make-uri "localhost" 11311)) '
            "*ros-node-name*"
        )
        == '"/x/n"'
    )


def test_starting_again_cleans_up_first(lisp):
    lisp("""(defun clean () (note (list 'clean (node-status)))) (register-ros-cleanup-function clean)
            (startup-ros :name "a" :anonymous nil)""")
    lisp.printed()
    assert lisp('(startup-ros :name "b" :anonymous nil) (list *notes* *ros-node-name*)') == '(((CLEAN :RUNNING)) "/b")'
    assert lisp.printed()[:2] == ["[(ROSNODE) INFO] T: ROS cleanup #<FUNCTION CLEAN>.", "[(ROSLISP TOP) INFO] T: Shutdown complete"]
    assert lisp.warned() == ""
    assert lisp("(shutdown-ros) (list (length *notes*) (node-status))") == "(2 :SHUTDOWN)"


def test_registration_keeps_the_function_and_replaces_by_name(lisp):
    lisp("(defun init () (note 'old))")
    assert lisp("(register-ros-init-function init 1)") == "#<FUNCTION INIT>"
    lisp("(defun init () (note 'new))")
    assert lisp("(startup-ros) *notes*") == "(OLD)"
    assert lisp("(register-ros-init-function init) (setf *notes* nil) (startup-ros) *notes*") == "(NEW)"


def test_only_functions_can_be_registered(lisp):
    assert "NO-SUCH-FUNCTION is undefined" in lisp.error("(register-ros-init-function no-such-function)")
    assert "NO-SUCH-FUNCTION is undefined" in lisp.error("(register-ros-cleanup-function no-such-function)")


def test_every_export_of_roslisp_is_there(lisp):
    listed = set(re.search(r"Full alphabetical export list.*?: `(.*?)`", PAGE.read_text(), re.S).group(1).split())
    package = find_package("ROSLISP")
    exported = (
        {symbol.name.lower() for symbol in package.external.values()}
        if isinstance(package.external, dict)
        else {symbol.name.lower() for symbol in package.external}
    )
    assert len(listed) > 80
    assert listed <= exported, f"missing: {sorted(listed - exported)}"
    assert exported <= listed, f"too many: {sorted(exported - listed)}"
    undefined = {
        "defservice",
        "ros-time-not-yet-received",
        "roslisp",
        "top",
        "tcp",
        "reconnect",
        "service-error",
        "service-call-error",
        "persistent-service",
        "ros-message",
        "*current-ros-package*",
    }
    for name in sorted(listed - undefined):
        known = lisp(f"(let ((s 'roslisp:{name})) (or (boundp s) (fboundp s) (and (macro-function s) t)))")
        assert known not in ("NIL", ""), name
    for name in ("service-error", "service-call-error", "persistent-service", "ros-message"):
        assert lisp(f"(find-class 'roslisp:{name})") != "NIL"


@pytest.mark.parametrize(
    "form, told",
    [("(load-if-necessary foo)", "load-if-necessary deprecated!"), ("(defservice)", "The function ROSLISP:DEFSERVICE is undefined.")],
)
def test_what_is_gone_says_so(lisp, form, told):
    assert lisp.error(form) == told


def test_message_packages_are_loaded_by_their_name(lisp):
    assert lisp(
        '(load-message-types "turtlesim" geometry_msgs) (load-service-types std_srvs) (find-symbol "POSE" "TURTLESIM-MSG")'
    ).startswith("TURTLESIM-MSG:POSE")
    assert lisp.error('(load-message-types "nope_msgs")') == 'Component "nope_msgs-msg" not found'
    assert lisp("""(defpackage user-of-messages (:use :cl :roslisp)) (in-package user-of-messages)
                   (load-msg "turtlesim") (load-srv std_srvs)
                   (list (package-name (symbol-package 'linear_velocity)) (package-name (symbol-package 'setbool)))""") == (
        '("TURTLESIM-MSG" "STD_SRVS-SRV")'
    )


def test_one_may_work_in_the_package_itself(lisp):
    start_turtlesim()
    assert (
        lisp("""(in-package :roslisp) (start-ros-node "n") (defvar *answer* (call-service "clear" 'Empty))
                   (list (first (list *answer*)) (node-status))""")
        == "([STD_SRVS-SRV:EMPTY-RESPONSE] :RUNNING)"
    )
    lisp("(in-package :roslisp-utilities) (defvar *x* (list 1))")


def test_what_ros_load_exports(lisp, tmp_path, monkeypatch):
    (tmp_path / "my_pkg" / "asdf").mkdir(parents=True)
    (tmp_path / "my_pkg" / "package.xml").write_text("<package><name>my_pkg</name></package>")
    (tmp_path / "my_pkg" / "my-system.asd").write_text('(defsystem my-system :components ((:file "code")))')
    (tmp_path / "my_pkg" / "code.lisp").write_text("(defparameter cl-user::*loaded-in* ros-load:*current-ros-package*)")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    monkeypatch.setenv("ROS_HOME", "somewhere")
    folder = f"{tmp_path}/my_pkg"
    assert lisp('(list (ros-load:rospack "find" "my_pkg") (ros-load:ros-package-path "my_pkg"))') == f'(("{folder}") "{folder}/")'
    assert lisp('(list (ros-load:asdf-paths-to-add "my_pkg") (ros-load:ros-home))') == f'(("{folder}/asdf/") "somewhere")'
    assert lisp('(list (ros-load:asdf-ros-search :my-system) (ros-load:asdf-ros-search "nope"))') == f'("{folder}/my-system.asd" NIL)'
    assert lisp('(list (ros-load:load-system "my_pkg" :my-system) cl-user::*loaded-in* ros-load:*current-ros-package*)') == (
        '(T "my_pkg" NIL)'
    )
    assert lisp.error('(ros-load:rospack "find" "nope")') == (
        "rospack find nope returned 1 with stderr '[rospack] Error: package 'nope' not found'"
    )
    assert lisp.error('(ros-load:load-manifest "my_pkg")') == "Load manifest deprecated!"
