"""The address and the token of a robot come from options, files and variables, and no token is shown to others."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from contextlib import ExitStack

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.cli.robot_address import ADDRESS, TOKEN, Unusable, chosen
from cramhy_runtime.rosbridge.addresses import shown


@pytest.fixture(autouse=True)
def no_variables(monkeypatch):
    monkeypatch.delenv(ADDRESS, raising=False)
    monkeypatch.delenv(TOKEN, raising=False)


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Writes the file ``name`` in the current folder, for its owner alone; gives the name."""
    monkeypatch.chdir(tmp_path)

    def make(text, name="robot", mode=0o600):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        path.chmod(mode)
        return name

    return make


def test_without_option_and_variable_there_is_no_robot():
    assert chosen(None, None) is None


def test_an_empty_variable_is_none(monkeypatch):
    monkeypatch.setenv(ADDRESS, "")
    assert chosen(None, None) is None


@pytest.mark.parametrize("text", ["ws://robot:9090/secret", "ws://robot:9090/secret\n", "  wss://robot/secret \r\n"])
def test_a_file_holds_the_address(write, text, capsys):
    assert chosen("@" + write(text), None) == text.strip()
    assert capsys.readouterr().err == ""


def test_a_variable_holds_the_address_or_names_its_file(write, monkeypatch):
    monkeypatch.setenv(ADDRESS, "ws://robot:9090/secret")
    assert chosen(None, None) == "ws://robot:9090/secret"
    assert chosen("ws://other:1", None) == "ws://other:1"
    monkeypatch.setenv(ADDRESS, "@" + write("ws://robot:1/x"))
    assert chosen(None, None) == "ws://robot:1/x"


def test_a_token_comes_from_a_file_or_a_variable(write, monkeypatch):
    assert chosen("ws://robot:9090", write("secret\n")) == "ws://robot:9090/secret"
    assert chosen("ws://robot:9090/", write("secret\n")) == "ws://robot:9090/secret"
    monkeypatch.setenv(TOKEN, "other")
    assert chosen("ws://robot:9090", None) == "ws://robot:9090/other"
    assert chosen("ws://robot:9090", "robot") == "ws://robot:9090/secret"
    monkeypatch.setenv(ADDRESS, "ws://robot:9090")
    assert chosen(None, None) == "ws://robot:9090/other"


def test_an_address_with_a_token_among_the_arguments_is_warned_of_and_taken(capsys):
    assert chosen("ws://robot:9090/secret", None) == "ws://robot:9090/secret"
    assert capsys.readouterr().err == (
        "; Every user of this machine can see the token in --ros ws://robot:9090/.... Write the address into a file: --ros @FILE\n"
    )
    assert chosen("ws://robot:9090", None) == "ws://robot:9090"
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("option, token_file, message", [
    ("@missing", None, "--ros @missing: the file cannot be read: No such file or directory."),
    ("@", None, "--ros @: the file cannot be read: No such file or directory."),
    ("@.", None, "--ros @.: the file cannot be read: Is a directory."),
    ("@empty", None, "--ros @empty: the file must hold one line, the address of a rosbridge server, such as ws://robot:9090."),
    ("@two", None, "--ros @two: the file must hold one line, the address of a rosbridge server, such as ws://robot:9090."),
    ("@bytes", None, "--ros @bytes: the file must hold one line, the address of a rosbridge server, such as ws://robot:9090."),
    ("@word", None, "--ros @word: what the file holds is not an address of a rosbridge server; one looks like ws://robot:9090."),
    ("@open", None, "--ros @open: others than you can read this file, and it holds a token. Type: chmod 600 open"),
    ("robot:9090/secret", None, "--ros robot:9090/...: that is not an address of a rosbridge server; one looks like ws://robot:9090."),
    ("http://robot:9090/secret", None,
     "--ros http://robot:9090/...: that is not an address of a rosbridge server; one looks like ws://robot:9090."),
    ("ws://robot:9090", "missing", "--ros-token missing: the file cannot be read: No such file or directory."),
    ("ws://robot:9090", "empty", "--ros-token empty: the file must hold one line, a token."),
    ("ws://robot:9090", "wordopen", "--ros-token wordopen: others than you can read this file, and it holds a token. "
     "Type: chmod 600 wordopen"),
    ("ws://robot:9090/x", "word", "--ros-token word: the address ws://robot:9090/... has a token already. Leave one of them out."),
    ("ws://robot:9090", "strange", "--ros-token strange: this is not a token; one is a word of letters, digits, - and _."),
    (None, "word", "--ros-token is the token for a robot; give its address with --ros, too."),
])  # fmt: skip
def test_what_is_wrong_is_told(write, option, token_file, message):
    for name, text, mode in (
        ("empty", "\n", 0o600),
        ("two", "ws://a\nws://b\n", 0o600),
        ("bytes", b"\xff\xfe", 0o600),
        ("word", "secret", 0o600),
        ("wordopen", "secret", 0o644),
        ("open", "ws://robot:9090/secret", 0o640),
        ("strange", "a#b", 0o600),
    ):
        write(text, name, mode)
    with pytest.raises(Unusable) as caught:
        chosen(option, token_file)
    assert str(caught.value) == message


def test_a_file_that_others_may_read_is_no_matter_without_a_token(write):
    assert chosen("@" + write("ws://robot:9090", mode=0o644), None) == "ws://robot:9090"


def test_a_wrong_variable_is_named(monkeypatch):
    monkeypatch.setenv(ADDRESS, "robot")
    with pytest.raises(Unusable) as caught:
        chosen(None, None)
    assert str(caught.value) == "CRAMHY_ROS robot: that is not an address of a rosbridge server; one looks like ws://robot:9090."


@pytest.mark.parametrize("url, seen", [
    ("ws://robot:9090", "ws://robot:9090"), ("ws://robot:9090/", "ws://robot:9090/"), ("ws://robot:9090/secret", "ws://robot:9090/..."),
    ("wss://robot/?token=secret", "wss://robot/..."), ("ws://me:secret@robot:9090", "ws://robot:9090/..."),
])  # fmt: skip
def test_an_address_is_shown_without_its_token(url, seen):
    assert shown(url) == seen


@pytest.mark.soak
@pytest.mark.parametrize("ways", ["@file", "token file", "CRAMHY_ROS", "CRAMHY_ROS_TOKEN"])
def test_a_session_joins_another_one_and_no_argument_of_a_process_has_the_token(tmp_path, monkeypatch, ways):
    pytest.importorskip("roslibpy")
    pytest.importorskip("uvicorn")
    from cramhy_runtime import rosbridge
    from cramhy_runtime.session import boot
    from cramhy_runtime.turtlesim.node import start_turtlesim

    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    kernel.start(clock="wall")
    with ExitStack() as closings:
        closings.callback(kernel.stop)
        boot()
        start_turtlesim()
        address = rosbridge.start().address
        place, token = address.rpartition("/")[0], address.rpartition("/")[2]
        file = tmp_path / "secret"
        file.write_text(address if ways == "@file" else token)
        file.chmod(stat.S_IRUSR)
        words, variables = {
            "@file": (["--ros", f"@{file}"], {}),
            "token file": (["--ros", place, "--ros-token", str(file)], {}),
            "CRAMHY_ROS": ([], {ADDRESS: address}),
            "CRAMHY_ROS_TOKEN": (["--ros", place], {TOKEN: token}),
        }[ways]
        child = subprocess.Popen(
            [sys.executable, "-m", "cramhy_runtime.cli", "repl", *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, **variables},
        )
        closings.callback(child.kill)

        def talk():
            answer, _ = child.communicate(
                '(roslisp:start-ros-node "x")\n(roslisp:get-param "/turtlesim/background_b")\n'
                '(with-open-file (s "/proc/self/cmdline") (read-line s))\n',
                timeout=90,
            )
            return answer

        answer = kernel.run_blocking(talk)
        assert "255" in answer and token not in answer
        if os.path.exists("/proc/self/cmdline"):
            assert "cramhy_runtime.cli" in answer
        assert child.returncode == 0
