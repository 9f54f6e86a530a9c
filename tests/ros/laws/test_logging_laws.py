"""Invariants 13 to 20 of roslisp.md: the log, as a user types it."""

import pytest

from cramhy_runtime.ros import graph
from cramhy_runtime.ros.message_json import to_json
from cramhy_runtime.ros.messages import message_class


@pytest.mark.law("roslisp", 13)
@pytest.mark.parametrize("topic", ["(a b)", "(:a b)", '("A" "B")', '(a "B")'])
def test_a_line_has_topic_level_time_and_text(lisp, topic):
    assert lisp(f'(ros-info {topic} "hello ~a" 3)') == "NIL"
    assert lisp.printed() == ["[(A B) INFO] T: hello 3"]


@pytest.mark.law("roslisp", 14)
def test_the_root_and_a_symbol_as_topics(lisp):
    lisp('(ros-warn nil "x") (ros-info a "x") (ros-error (a) "y") (ros-fatal () "z") (ros-info (roslisp top) "t")')
    assert lisp.printed() == ["[NIL WARN] T: x", "[(A) INFO] T: x", "[(A) ERROR] T: y", "[NIL FATAL] T: z", "[(ROSLISP TOP) INFO] T: t"]


@pytest.mark.law("roslisp", 15)
def test_what_is_not_printed_is_not_evaluated(lisp):
    assert lisp('(ros-debug (a) "x ~a" (note 1)) (ros-debug (a) (note 2) "x") *notes*') == "NIL"
    assert lisp.printed() == []


@pytest.mark.law("roslisp", 16)
def test_a_level_counts_for_the_topics_below(lisp):
    lisp("(set-debug-levels (a) :debug (a b) :error)")
    lisp('(ros-debug (a) "1") (ros-debug (a x) "2") (ros-warn (a b) "3") (ros-error (a b c) "4") (ros-debug (z) "5")')
    assert lisp.printed() == ["[(A) DEBUG] T: 1", "[(A X) DEBUG] T: 2", "[(A B C) ERROR] T: 4"]


@pytest.mark.law("roslisp", 17)
def test_a_condition_that_is_false_prints_nothing(lisp):
    assert lisp('(ros-info (t) (= 1 2) "never ~a" (note 1)) (ros-info (t) (= 1 1) "always") *notes*') == "NIL"
    assert lisp.printed() == ["[(T) INFO] T: always"]


@pytest.mark.law("roslisp", 18)
def test_a_level_becomes_a_parameter_of_the_node(node):
    assert node("(set-debug-level '(foo bar) :debug)") == "0"
    assert node('(list (get-param "~debug/foo/bar/level") (list-params "~debug"))') == '("debug" ("/n/debug/foo/bar/level"))'
    assert node('(set-debug-level nil :warn) (get-param "~debug/level")') == '"warn"'


@pytest.mark.law("roslisp", 19)
def test_levels_are_read_again_on_request(node):
    node("""(set-param "~debug/foo/level" "bogus") (set-param "~debug/bar/level" "debug") (set-param "~debug/other" 3)
            (call-service "~reset_debug_levels" 'std_srvs-srv:Empty)
            (ros-debug (bar) "heard")""")
    assert node.printed() == [
        "[(ROSLISP ROSOUT) WARN] T: Skipping setting debug level of /n/debug/foo/level to unknown level BOGUS",
        "[(BAR) DEBUG] T: heard",
    ]


@pytest.mark.law("roslisp", 20)
def test_rosout_carries_level_name_and_text(node):
    received = []
    graph.active().node("listener").subscribe("/rosout", message_class("rosgraph_msgs/Log"), received.append)
    node('(ros-debug (a) "no") (ros-info (a) "i") (ros-warn (a) "w") (ros-error (a) "e") (ros-fatal (a) "f ~a" 1)')
    assert [(log.level, log.name, log.msg, log.header.stamp, log.file, log.line, log.topics) for log in received] == [
        (level, "/n", text, 0, "", 0, []) for level, text in ((2, "i"), (4, "w"), (8, "e"), (16, "f 1"))
    ]


def test_a_text_beyond_latin_leaves_as_it_was_logged(node):
    received = []
    graph.active().node("listener").subscribe("/rosout", message_class("rosgraph_msgs/Log"), received.append)
    node('(ros-info (a) "Schildkröte") (ros-info (a) "Schildkröte 🐢")')
    assert [to_json(log)["msg"] for log in received] == ["Schildkröte", "Schildkröte 🐢"]


def test_the_value_is_the_number_of_listeners_to_rosout(node):
    assert node('(ros-info (a) "x")') == "0"
    assert node('(wait-duration 0.1) (ros-info (a) "x")') == "1"  # the collector has connected
    assert node('(ros-debug (a) "x")') == "NIL"
    assert node('(shutdown-ros-node) (ros-info (a) "x")') == "NIL"


def test_the_topic_prints_as_it_is_written(lisp):
    lisp('(ros-info (foo-bar :baz "qux") "x") (ros-info |Low| "x")')
    assert lisp.printed() == ["[(FOO-BAR BAZ qux) INFO] T: x", "[(Low) INFO] T: x"]


def test_the_text_is_formatted_first_and_has_lines_of_its_own(lisp):
    lisp('(format t "abc") (ros-info (a) "one~%  two") (format t "def")')
    assert lisp.printed() == ["abc", "[(A) INFO] T: one", "  two", "def"]


def test_control_directives_in_arguments_are_text(lisp):
    lisp('(ros-info (a) "~a~%" "~s ~a")')
    assert lisp.printed() == ["[(A) INFO] T: ~s ~a"]


def test_too_few_arguments_are_told_by_format(lisp):
    lisp('(ros-info (a) "x ~a")')  # the line is logged with what is wrong in it, and does not end the plan: differences.md
    assert "No more arguments" in "\n".join(lisp.printed())


def test_a_string_in_a_variable_is_taken_for_a_condition(lisp):
    told = lisp.error('(let ((text "x")) (ros-info (a) text))')
    assert "ROS-INFO" in told and "text" in told.lower()


@pytest.mark.parametrize("level, name", [(":bogus", "BOGUS"), ('"debug"', "NIL")])
def test_a_level_that_is_none(lisp, level, name):
    assert lisp.error(f"(set-debug-level '(a) {level})") == f"Could not get symbol code for {name} for ROS message type <LOG>"


def test_levels_are_symbols_numbers_and_upper_case_strings(lisp):
    lisp("(set-debug-level 'a \"DEBUG\") (set-debug-level '(b) 4) (set-debug-levels c (if t :error :info))")
    lisp('(ros-debug (a) "1") (ros-info (b) "2") (ros-warn (b) "3") (ros-warn (c) "4")')
    assert lisp.printed() == ["[(A) DEBUG] T: 1", "[(B) WARN] T: 3"]
    assert lisp("(list (debug-level '(:a)) (debug-level '(:b)) (debug-level '(:z :c)) (debug-level '(:c :z)))") == "(1 4 8 2)"


def test_the_table_of_levels_shows_topics_reversed(lisp):
    lisp("(set-debug-levels (a) :debug (a b) :error) (print-debug-levels)")
    assert lisp.printed() == ["[NIL : INFO", " (A) : DEBUG", " (B A) : ERROR]"]


def test_levels_outlive_the_node(node):
    node('(set-debug-level \'(a) :debug) (shutdown-ros-node) (start-ros-node "m")')
    node.printed()
    node('(ros-debug (a) "x")')
    assert node.printed() == ["[(A) DEBUG] T: x"]


def test_levels_are_read_when_a_node_starts(lisp):
    lisp("""(start-ros-node "n") (set-param "/m/debug/a/level" "DEBUG") (set-param "/m/debug/level" 4) (start-ros-node "m")""")
    lisp.printed()
    lisp('(ros-debug (a) "x")')
    assert lisp.printed() == ["[(A) DEBUG] T: x"]


class TestLogFile:
    def lines(self, folder):
        return {path.name: [line.split("]")[0] + "]" for line in path.read_text().splitlines()] for path in folder.rglob("*.log")}

    def test_the_command_line_names_it(self, lisp, tmp_path):
        lisp(f'(start-ros-node "n" :cmd-line-args "__log:={tmp_path}/deep/x.log") (shutdown-ros-node) (ros-info (a) "later")')
        assert self.lines(tmp_path) == {"x.log": ["[(ROSLISP TOP) INFO]"] * 7}

    def test_the_environment_names_its_folder(self, lisp, tmp_path, monkeypatch):
        monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
        lisp('(start-ros-node "n" :cmd-line-args "__name:=other") (shutdown-ros-node)')
        assert self.lines(tmp_path) == {"n-1292688669.log": ["[(ROSLISP TOP) INFO]"] * 7}

    def test_one_that_cannot_be_written_is_told(self, lisp, tmp_path):
        (tmp_path / "file").touch()
        assert lisp.error(f'(start-ros-node "n" :cmd-line-args "__log:={tmp_path}/file/x.log")') == (
            f"Could not open the log file {tmp_path}/file/x.log: File exists. Choose another one with __log:=FILE."
        )
        assert lisp("(node-status)") == ":SHUTDOWN"
