"""The language of .msg, .srv and .action files, the definitions that come with cramhy, and those of a user's own packages."""

import hashlib
import os
from pathlib import Path

import pytest
import recorded_md5sums

from cramhy_runtime.lisp_core.packages import find_package, registered
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.ros import definition_files, definition_text, messages, type_texts
from cramhy_runtime.ros.definition_text import DefinitionError, parse_action, parse_message, parse_service


@pytest.fixture
def lisp(session):
    from cramhy_runtime.repl.session import Session

    here = Session(time="virtual", turtlesim=False)
    return lambda text: " ; ".join(" ".join(prin1_to_string(value).split()) for value in here.evaluate_text(text))


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    """Writes definitions into packages on ROS_PACKAGE_PATH; what was loaded from there is forgotten."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))

    def write(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    before = set(messages._loaded)
    yield write
    for package in set(messages._loaded) - before:
        del messages._loaded[package]
        for table in (messages._messages, messages._services):
            for name in [name for name in table if name.startswith(package + "/")]:
                del table[name]
        messages._forget_lisp_packages(package)


class TestTheLanguage:
    def test_fields_constants_and_comments(self):
        text = "# note\nint32 X=3 # three\nstring S= a # b \nfloat64[36] c\n\tHeader\theader\nPoint[] ps\nbyte MAX = 0x7f\nbool ON=True"
        definition = parse_message(text, "my_msgs")
        assert [repr(field) for field in definition.fields] == ["float64[36] c", "std_msgs/Header header", "my_msgs/Point[] ps"]
        assert definition.constants == {"X": 3, "S": "a # b", "MAX": 127, "ON": True}
        assert definition.lines == ["int32 X=3", "string S=a # b", "byte MAX=0x7f", "bool ON=True", "float64[36] c",
                                    "std_msgs/Header header", "my_msgs/Point[] ps"]  # fmt: skip

    def test_a_service_has_two_halves(self):
        request, response = parse_service("int64 a\n---\nint64 sum", "p")
        assert [len(request.fields), len(response.fields)] == [1, 1]
        assert [len(half.fields) for half in parse_service("---", "p")] == [0, 0]

    def test_an_action_has_three_parts(self):
        assert [[repr(field) for field in part.fields] for part in parse_action("int32 a\n---\n# none\n---\nint32[] b\n", "p")] == [
            ["int32 a"], [], ["int32[] b"],
        ]  # fmt: skip

    @pytest.mark.parametrize(
        "text, problem, hint",
        [
            ("int32", 'here, line 1, column 1: "int32" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).',
             "Write for instance  float64 x  or  uint8 RED=1  ; a comment begins with #."),
            ("int32 a\n  int32 X=", 'here, line 2, column 3: "int32 X=" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).',
             "Write for instance  float64 x  or  uint8 RED=1  ; a comment begins with #."),
            ("int32 my-field", 'here, line 1, column 7: "my-field" is not a name for a field.',
             "A name begins with a letter; letters, digits and underscores follow."),
            ("int32 a b", 'here, line 1, column 7: "a b" is not a name for a field.',
             "A name begins with a letter; letters, digits and underscores follow."),
            ("int32[x] a", 'here, line 1, column 1: "int32[x]" is not a type.',
             "Types are written T, T[] or T[3], those of other packages package/T."),
            ("int32[0] a", 'here, line 1, column 1: "int32[0]" is not a type.',
             "Types are written T, T[] or T[3], those of other packages package/T."),
            ("int32 A=x", "here, line 1, column 9: x is not a int32.", None),
            ("uint8 A = 300", "here, line 1, column 11: 300 is not a uint8.", "Its range is 0 to 255."),
            ("bool A=maybe", "here, line 1, column 8: maybe is not a bool.", "Write True or False."),
            ("time T=3", "here, line 1, column 1: A constant cannot be of type time.",
             "Constants are integers, floats, bools and strings."),
            ("Pose T=3", "here, line 1, column 1: A constant cannot be of type Pose.",
             "Constants are integers, floats, bools and strings."),
            ("int32 a\n\nint8 a", "here, line 3, column 6: There already is a field or constant called a.",
             "Each name can be used once in a message."),
        ],
    )  # fmt: skip
    def test_errors_name_file_line_and_column_and_what_to_try(self, text, problem, hint):
        with pytest.raises(DefinitionError) as error:
            parse_message(text, "p", "here")
        assert (error.value.problem, error.value.hint) == (problem, hint)

    @pytest.mark.parametrize(
        "parse, text, problem",
        [
            (parse_service, "int64 b\n---\nint64 c\n---\nint64\n",
             'here, line 5, column 1: "int64" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).'),
            (parse_action, "int64 a\n",
             "here, line 2, column 1: Lines of three dashes separate goal, result and feedback: there must be 2, not 0."),
            (parse_action, "int64 a\n---\n",
             "here, line 3, column 1: Lines of three dashes separate goal, result and feedback: there must be 2, not 1."),
            (parse_action, "---\n---\nint32\n",
             'here, line 3, column 1: "int32" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).'),
        ],
    )  # fmt: skip
    def test_errors_of_services_and_actions(self, parse, text, problem):
        with pytest.raises(DefinitionError) as error:
            parse(text.replace("a\n---\n---", "int64 a\n---\n---"), "p", "here")
        assert error.value.problem == problem

    def test_what_ros_accepts_is_accepted_and_has_its_sums(self, workspace):
        workspace("p/msg/Thing.msg", "string name\n")
        for number, (text, _) in enumerate(recorded_md5sums.MESSAGES):
            workspace(f"p/msg/M{number}.msg", "").write_bytes(text.encode())
        for number, (text, _) in enumerate(recorded_md5sums.SERVICES):
            workspace(f"p/srv/S{number}.srv", text)
        messages.load_package("p")
        for number, (text, md5) in enumerate(recorded_md5sums.MESSAGES):
            assert type_texts.md5_of(messages.message_class(f"p/M{number}")) == md5, text
        for number, (text, md5) in enumerate(recorded_md5sums.SERVICES):
            assert type_texts.md5_of(messages.service_type(f"p/S{number}")) == md5, text

    @pytest.mark.parametrize(
        "line, value",
        [
            ("string A=", ""),
            ("string A = # no comment", "# no comment"),
            ("string A='#'", "'#'"),
            ("uint8 A=010", 10),
            ("byte A=-1", -1),
            ("byte A=255", 255),
            ("bool A=2", True),
            ("bool A=0.0", None),
            ("bool A=FALSE", None),
            ("\ufeffint8 A=1", 1),
        ],
    )
    def test_values_of_constants(self, line, value):
        assert parse_message(line, "p").constants == {"A": value}

    def test_names_that_messages_have_themselves_are_no_trouble(self):
        assert {name for name in dir(messages.RosMessage) if not name.startswith("_")} <= definition_text.RESERVED
        channel = messages.message_class("sensor_msgs/ChannelFloat32")(values_=[1.0])
        assert channel.values() == ["", [1.0]]


def everything():
    """All message classes and services that come with cramhy."""
    for folder in sorted(definition_files.OURS.iterdir()):
        if folder.is_dir() and not folder.name.startswith("__"):
            classes, services = messages.load_package(folder.name) or ((), ())  # turtle_tf has launch files only
            yield from classes
            yield from services


class TestOurs:
    def test_every_type_can_be_made(self):
        for found in everything():
            for cls in (found,) if isinstance(found, type) else (found.request, found.response):
                assert len(cls().values()) == len(cls.fields)

    def test_their_sums_are_those_of_ros_noetic(self):
        """The table was read from the Python modules that Debian generates from ROS 1's definitions, that of the tutorials' packages
        (turtlesim, actionlib_tutorials, turtle_actionlib, rospy_tutorials, roscpp_tutorials) checked by hand. The sums of control_msgs,
        moveit_msgs, object_recognition_msgs, pr2_controllers_msgs, giskard_msgs, robosherlock_msgs, wiggle_msgs, iai_* and
        json_prolog_msgs are what Debian's genmsg computes, and those of lynxmotion_al5d_description come from the course's files."""
        lines = (Path(__file__).parent / "md5sums.txt").read_text().split("\n")
        expected = sorted(tuple(line.split()) for line in lines if line)
        sums = sorted((found.ros_type if isinstance(found, type) else found.name, type_texts.md5_of(found)) for found in everything())
        assert [entry for entry in sums if not entry[0].startswith(("cramhy_msgs/", "rosapi/"))] == expected

    def test_the_complete_text_has_all_parts_once(self):
        assert type_texts.complete_text(messages.message_class("geometry_msgs/TwistStamped")) == (
            "Header header\nTwist twist\n" + "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n" + "=" * 80 +
            "\nMSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n" + "=" * 80 +
            "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
        )  # fmt: skip

    def test_they_tell_about_themselves_in_lisp(self, lisp):
        assert lisp("(roslisp-msg-protocol:md5sum 'turtlesim-msg:pose)") == '"863b248d5016ca62ea2e895ae5265cf9"'
        assert lisp("(roslisp-msg-protocol:md5sum 'turtlesim-srv:setpen)") == '"9f452acce566bf0c0954594f69a8e41b"'
        assert lisp('(roslisp-msg-protocol:md5sum (make-msg "turtlesim/Color"))'.replace("make-msg", "roslisp:make-msg")) == (
            '"353891e354491c51aabe32df673fb446"'
        )
        assert lisp("(roslisp-msg-protocol:ros-datatype 'turtlesim-srv:spawn)") == '"turtlesim/Spawn"'
        assert lisp("(roslisp-msg-protocol:message-definition 'turtlesim-srv:spawn)") == (
            '"float32 x float32 y float32 theta string name --- string name "'
        )

    def test_nothing_is_read_before_somebody_names_it(self):
        name = "TRAJECTORY_MSGS-MSG"
        if "trajectory_msgs" not in messages._loaded:
            assert registered(name) is None
        assert find_package(name).lookup("JOINTTRAJECTORY")[1] == "external"


def test_a_package_of_messages_is_near_to_a_misspelled_one(lisp, fails):
    assert fails(lisp, "sensor_mgs-msg:imu").hint == "There is no package SENSOR_MGS-MSG. Did you mean SENSOR_MSGS-MSG or SENSOR_MSGS-SRV?"


class TestOnesOwn:
    def test_messages_services_and_actions_of_a_package_on_the_path(self, workspace, lisp):
        workspace("stack/own_msgs/package.xml", "<package><name>own_msgs</name></package>")
        workspace("stack/own_msgs/msg/Thing.msg", "geometry_msgs/Point where\nstring name\nuint8 BIG=7\n")
        workspace("stack/own_msgs/msg/Box.msg", "Thing[] things\nfloat64[2] size\n")
        workspace("stack/own_msgs/srv/Fetch.srv", "Thing thing\n---\nbool done\n")
        workspace("stack/own_msgs/action/Cook.action", "string dish\n---\nbool tasty\n---\nfloat32 percent\n")
        assert lisp('(roslisp:make-msg "own_msgs/Thing" (:x :where) 1 :name "cup")').startswith("[OWN_MSGS-MSG:THING WHERE:")
        assert lisp("(roslisp:symbol-code 'own_msgs-msg:thing :big)") == "7"
        assert lisp("(own_msgs-msg:size (make-instance 'own_msgs-msg:box))") == "#(0.0 0.0)"
        assert lisp("(roslisp:make-request own_msgs-srv:fetch)").startswith("[OWN_MSGS-SRV:FETCH-REQUEST THING: (OWN_MSGS-MSG:THING")
        assert lisp('(own_msgs-msg:dish (own_msgs-msg:goal (roslisp:make-msg "own_msgs/CookActionGoal" (:dish :goal) "soup")))') == '"soup"'
        point = type_texts.md5_of(messages.message_class("geometry_msgs/Point"))
        expected = hashlib.md5(f"uint8 BIG=7\n{point} where\nstring name".encode()).hexdigest()
        assert type_texts.md5_of(messages.message_class("own_msgs/Thing")) == expected

    @pytest.mark.soak(all_but=3)
    @pytest.mark.parametrize(
        "form",
        [
            '(asdf:load-system "own_msgs-msg")',
            '(ros-load:load-system "own_msgs" :own_msgs-msg)',
            "(roslisp:load-message-types own_msgs)",
            '(roslisp:load-message-types "own_msgs")',
            '(roslisp:load-message-types "own_msgs/Thing")',
            '(roslisp:load-msg "own_msgs/Thing")',
        ],
    )
    def test_its_systems_are_loaded_in_all_ways(self, workspace, lisp, form):
        workspace("own_msgs/msg/Thing.msg", "string name\n")
        lisp(form)
        assert "own_msgs" in messages._loaded
        assert lisp("(own_msgs-msg:name (make-instance 'own_msgs-msg:thing))") == '""'

    def test_a_system_may_depend_on_them(self, workspace, lisp):
        workspace("own_msgs/msg/Thing.msg", "string name\n")
        workspace("own_msgs/srv/Fetch.srv", "---\n")
        workspace(
            "own_user/own-user.asd", '(asdf:defsystem own-user :depends-on (roslisp own_msgs-msg own_msgs-srv) :components ((:file "f")))'
        )
        workspace("own_user/f.lisp", "(defpackage own-user (:use :cl :roslisp :own_msgs-msg))\n(in-package :own-user)\n"
                                     '(defun my-name () (name (make-msg "own_msgs/Thing" :name "cup")))')  # fmt: skip
        lisp('(asdf:load-system "own-user")')
        assert lisp("(own-user::my-name)") == '"cup"'

    def test_load_msg_uses_the_package(self, workspace, lisp):
        workspace("own_msgs/msg/Thing.msg", "string marvellous\n")
        assert lisp('(defpackage using-own (:use :cl :roslisp)) (in-package using-own) (load-msg "own_msgs/Thing")'
                    "(marvellous (make-instance 'thing))").endswith('""')  # fmt: skip

    def test_a_missing_system_is_near_to_one_that_is_there(self, workspace, lisp, fails):
        workspace("own_msgs/msg/Thing.msg", "string name\n")
        condition = fails(systems.load_system, "own_msg-msg")
        assert condition.report() == 'Component "own_msg-msg" not found'
        assert condition.hint.endswith("Did you mean own_msgs-msg or nav_msgs-msg?")
        fails(systems.load_system, "own_msgs-srv")

    def test_a_missing_package_is_told_with_the_files_that_are_wanted_of_it(self, workspace, lisp, fails, tmp_path):
        workspace("user/user.asd", '(defsystem user :depends-on (no_such_msgs-msg) :components ((:file "f") (:file "gone")))')
        workspace("user/f.lisp", """
            (advertise "/a" "no_such_msgs/Command") (make-message "no_such_msgs/Command" :width 3)
            (no_such_msgs-msg:width msg) (no_such_msgs-msg::<Grip> x) (make-msg "no_such_msgs/GripActionGoal")
            (call-service "/x" 'no_such_msgs-srv:Open) (xno_such_msgs-msg:y z) "other_msgs/X"
            """)  # fmt: skip
        condition = fails(systems.load_system, "user")
        assert condition.report() == 'Component "no_such_msgs-msg" not found, required by #<SYSTEM "user">'
        assert condition.hint == (
            f"No package no_such_msgs with files msg/*.msg is below ROS_PACKAGE_PATH ({tmp_path}), the current folder and src of the workspace.\n"
            "Wanted of it: msg/Command.msg (f.lisp:2), action/Grip.action (f.lisp:3).\n"
            "Lisp names of it: width (f.lisp:3), <grip> (f.lisp:3), open (f.lisp:4).\n"
            f"user is defined in {tmp_path}/user/user.asd."
        )

    @pytest.mark.soak
    @pytest.mark.parametrize(
        "form, wanted",
        [
            ('(roslisp:make-msg "no_such_msgs/Box")', "a msg/Box.msg"),
            ('(roslisp:advertise "x" "no_such_msgs/CookAction")', "a action/Cook.action"),
            ('(roslisp:call-service "x" "no_such_msgs/Fetch")', "a srv/Fetch.srv"),
            ("no_such_msgs-srv:fetch", "files srv/*.srv"),
            ("(defpackage using-none (:use :no_such_msgs-msg))", "files msg/*.msg"),
        ],
    )
    def test_a_missing_package_is_told_with_the_places_of_the_search(self, workspace, lisp, fails, monkeypatch, form, wanted):
        from cramhy_runtime.languages.commonlisp.tools.advice import explanation

        monkeypatch.setenv("ROS_PACKAGE_PATH", f"/not/there{os.pathsep}{os.getcwd()}")
        lisp('(roslisp:start-ros-node "n")')
        told = explanation(fails(lisp, form))
        there = f"/not/there, which is not a folder, {os.getcwd()}"
        expected = (
            f"No package no_such_msgs with {wanted} is below ROS_PACKAGE_PATH ({there}), the current folder and src of the workspace."
        )
        assert expected.replace(" a action", " an action") in told

    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize(
        "text, line, problem, hint",
        [
            ("string name\nPlaec where", "line 2, column 1", "There is no type Plaec.", "Did you mean Place?"),
            ("double x", "line 1, column 1", "There is no type double.", "Did you mean float64?"),
            ("flaot32 x", "line 1, column 1", "There is no type flaot32.", "Did you mean float32?"),
            ("  geometry_msgs/Piont x", "line 1, column 3", "There is no type geometry_msgs/Piont.", "Did you mean Point?"),
            ("no_such_msgs/X x", "line 1, column 1", "There is no type no_such_msgs/X.",
             "No package no_such_msgs with a msg/X.msg is below ROS_PACKAGE_PATH ({path}), the current folder and src of the workspace."),
            ("geometry_msgs/Zzzzz x", "line 1, column 1", "There is no type geometry_msgs/Zzzzz.",
             "The package geometry_msgs has no msg/Zzzzz.msg in {ours}."),
            ("int32 a\nPlace b\nint32 3", "line 3, column 7", '"3" is not a name for a field.',
             "A name begins with a letter; letters, digits and underscores follow."),
            ("Circle[] inside", "line 1, column 1", "A message cannot contain itself: Circle -> Thing -> Circle.",
             "Refer to the other one by a number or a name."),
        ],
    )  # fmt: skip
    def test_a_broken_definition_is_an_error_and_nothing_is_lost(self, workspace, lisp, fails, text, line, problem, hint):
        path = workspace("own_msgs/msg/Thing.msg", text + "\n")
        workspace("own_msgs/msg/Place.msg", "string name\n")
        workspace("own_msgs/msg/Circle.msg", "Thing other\n" if "Circle" in text else "")
        condition = fails(messages.message_class, "own_msgs/Place")
        assert condition.report() == f"{path}, {line}: {problem}"
        assert condition.hint == hint.format(path=os.environ["ROS_PACKAGE_PATH"], ours=definition_files.OURS / "geometry_msgs")
        fails(lisp, "(own_msgs-msg:name 3)")
        assert lisp("(make-instance 'turtlesim-msg:color)").startswith("[TURTLESIM-MSG:COLOR")
        path.write_text("Place where\n")
        workspace("own_msgs/msg/Circle.msg", "")
        assert lisp('(roslisp:make-msg "own_msgs/Thing" (:name :where) "here")').endswith('(OWN_MSGS-MSG:PLACE (:NAME . "here"))]')

    def test_the_restart_reads_a_corrected_file(self, workspace, lisp):
        path = workspace("own_msgs/msg/Thing.msg", "what?\n")
        assert (
            lisp(f"""(in-package :cl-user) (handler-bind ((error (lambda (c)
                          (with-open-file (out "{path}" :direction :output :if-exists :supersede) (format out "string name"))
                          (invoke-restart (find 'retry (compute-restarts c) :key #'restart-name :test #'string=)))))
                          (roslisp:msg-slot-value (roslisp:make-msg "own_msgs/Thing" :name "cup") "name"))""")
            == '"cup"'
        )

    def test_a_file_with_an_odd_name(self, workspace, fails):
        path = workspace("own_msgs/msg/my-thing.msg", "int32 a")
        condition = fails(messages.message_class, "own_msgs/Thing")
        assert condition.report() == f"{path}: my-thing is not a name for a type."
        assert condition.hint == "Rename the file: letters, digits and underscores, the first one a letter."

    def test_a_file_that_is_no_text(self, workspace, fails, tmp_path):
        workspace("own_msgs/msg/Thing.msg", "").write_bytes(b"# gr\xf6\xdfe\nint32 a\n")
        assert messages.message_class("own_msgs/Thing")().a == 0
        workspace("own2_msgs/msg/Thing.msg", "").write_bytes(bytes(range(256)))
        assert "own2_msgs/msg/Thing.msg, line 1, column" in fails(messages.message_class, "own2_msgs/Thing").report()

    def test_a_folder_named_by_a_program(self, tmp_path, workspace):
        workspace("elsewhere/odd/own3_msgs/msg/Thing.msg", "string name\n")
        definition_files.add_package_directory(tmp_path / "elsewhere" / "odd")
        try:
            assert messages.message_class("own3_msgs/Thing")().name == ""
        finally:
            definition_files.forget_package_directory(tmp_path / "elsewhere" / "odd")
