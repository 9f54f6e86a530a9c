"""The options that open a session to the outside: what they call, when it is closed, and what they say when it cannot be had."""

from __future__ import annotations

import socket
from contextlib import ExitStack

import pytest

from cramhy_runtime.cli import servers, options
from cramhy_runtime.extras import install_command


def parsed(*words):
    return options.parser().parse_args(words)


class Pace:
    virtual = False


@pytest.fixture
def rooms(monkeypatch):
    """Rooms that only note what is asked of them, in a list."""
    done = []

    class Opened:
        url = "http://127.0.0.1:8080/#token=x"
        address = "ws://127.0.0.1:8080/x"

        def __init__(self, what):
            self.what = what

        def close(self):
            done.append(f"close {self.what}")

    def worker(what):
        def work(*arguments, **keywords):
            done.append(" ".join([what, *map(str, arguments), *(f"{key}={value}" for key, value in keywords.items())]))
            return Opened(what)

        return work

    for name in ("rosbridge.start", "rosbridge.attach", "view.start", "chronicle.record", "turtlesim.pictures.keep_history"):
        monkeypatch.setattr(f"cramhy_runtime.{name}", worker(name))
    monkeypatch.setattr(servers, "find_spec", lambda module: module)
    monkeypatch.setattr("cramhy_runtime.ros_tools.hosting.Host", lambda: done.append("host"))
    monkeypatch.setattr("cramhy_runtime.kernel.pace", lambda: Pace)
    return done


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["repl"], []),
        (["repl", "--serve"], ["rosbridge.start port=None origins=()", "host", "close rosbridge.start"]),
        (["repl", "--serve", "--port", "9090"], ["rosbridge.start port=9090 origins=()", "host", "close rosbridge.start"]),
        (
            ["repl", "--serve", "--origin", "http://a", "--origin", "http://b"],
            ["rosbridge.start port=None origins=('http://a', 'http://b')", "host", "close rosbridge.start"],
        ),
        (
            ["repl", "--view", "--origin", "http://a", "--port", "9"],
            ["rosbridge.start port=9 origins=('http://a',)", "host", "view.start", "close view.start", "close rosbridge.start"],
        ),
        (
            ["eval", "--view", "--serve", "--port", "8080"],
            ["rosbridge.start port=8080 origins=()", "host", "view.start", "close view.start", "close rosbridge.start"],
        ),
        (
            ["run", "x", "--record", "x.mcap", "--ros", "ws://robot:9090"],
            ["chronicle.record x.mcap ['x']", "rosbridge.attach ws://robot:9090", "close rosbridge.attach", "close chronicle.record"],
        ),
        (["run", "x", "--picture", "x.png"], []),
        (["run", "x", "--picture", "x.svg"], []),
        (["run", "x", "--picture", "x.GIF"], ["turtlesim.pictures.keep_history"]),
        (["run", "x", "--picture", "x.replay.svg"], ["turtlesim.pictures.keep_history"]),
    ],
)
def test_an_option_opens_and_the_end_closes_the_last_first(rooms, words, expected):
    given = parsed(*words)
    servers.check(given)
    with ExitStack() as closings:
        servers.open_session(given, closings)
    assert rooms == expected


def test_the_address_of_the_page_is_told(rooms, capsys):
    with ExitStack() as closings:
        servers.open_session(parsed("repl", "--view"), closings)
    assert capsys.readouterr() == ("", "; The page: http://127.0.0.1:8080/#token=x\n")


def test_that_the_page_gives_virtual_time_a_pace_is_told(rooms, capsys, monkeypatch):
    monkeypatch.setattr(Pace, "virtual", True)
    with ExitStack() as closings:
        servers.open_session(parsed("repl", "--view"), closings)
    assert capsys.readouterr().err.splitlines()[1:] == [
        "; Virtual time passes as the wall's does, so that there is something to see; the page can change its speed."
    ]


def test_the_address_for_other_programs_is_told(rooms, capsys):
    with ExitStack() as closings:
        servers.open_session(parsed("repl", "--serve"), closings)
    assert capsys.readouterr() == ("", "; Clients of rosbridge: ws://127.0.0.1:8080/x\n")


@pytest.mark.parametrize(
    ("words", "missing", "message"),
    [
        (
            ["repl", "--serve"],
            {"uvicorn"},
            "--serve needs uvicorn, websockets, and uvicorn is not installed. Type: " + install_command("web"),
        ),
        (
            ["repl", "--view"],
            {"uvicorn", "websockets"},
            "--view needs uvicorn, websockets, and uvicorn, websockets are not installed. Type: " + install_command("web"),
        ),
        (["repl", "--record", "x.mcap"], {"mcap"}, "--record needs mcap, and mcap is not installed. Type: " + install_command("record")),
        (
            ["repl", "--ros", "ws://robot:9090"],
            {"roslibpy"},
            "--ros needs roslibpy, and roslibpy is not installed. Type: " + install_command("ros"),
        ),
    ],
)
def test_an_extra_that_is_missing_is_named(rooms, monkeypatch, words, missing, message):
    monkeypatch.setattr(servers, "find_spec", lambda module: None if module in missing else module)
    with pytest.raises(servers.NotPossible) as caught:
        servers.check(parsed(*words))
    assert str(caught.value) == message and rooms == []


def test_a_replay_needs_two_extras(monkeypatch):
    monkeypatch.setattr(servers, "find_spec", lambda module: None if module == "mcap" else module)
    with pytest.raises(servers.NotPossible) as caught:
        servers.require("replay", "cramhy replay")
    assert str(caught.value) == (
        "cramhy replay needs uvicorn, websockets, mcap, and mcap is not installed. Type: " + install_command("web,record")
    )


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["repl", "--ros", "robot:9090"],
            "--ros robot:9090: that is not an address of a rosbridge server; one looks like ws://robot:9090.",
        ),
        (["repl", "--ros", ""], "--ros is given an empty word. Give it what it needs, or leave it out."),
        (["run", "x", "--record", ""], "--record is given an empty word. Give it what it needs, or leave it out."),
        (["run", "x", "--picture", ""], "--picture is given an empty word. Give it what it needs, or leave it out."),
        (
            ["repl", "--ros", "ws://a:99999"],
            "--ros ws://a:99999: that is not an address of a rosbridge server; one looks like ws://robot:9090.",
        ),
        (["repl", "--ros", "ws://a:b"], "--ros ws://a:b: that is not an address of a rosbridge server; one looks like ws://robot:9090."),
        (["repl", "--ros", "ws://[a"], "--ros ws://[a: that is not an address of a rosbridge server; one looks like ws://robot:9090."),
        (
            ["repl", "--ros", "ws://a:9090/#x"],
            "--ros ws://a:9090/...: that is not an address of a rosbridge server; one looks like ws://robot:9090.",
        ),
        (["repl", "--ros", "ws://"], "--ros ws://: that is not an address of a rosbridge server; one looks like ws://robot:9090."),
        (
            ["run", "x", "--picture", "x.jpg"],
            "--picture x.jpg: a picture is written as .png or .svg; .gif and .replay.svg show the whole way.",
        ),
        (["repl", "--record", "/no/such/folder/x.mcap"], "--record /no/such/folder/x.mcap: there is no folder /no/such/folder."),
        (["repl", "--port", "9090"], "--port says where --serve and --view listen; give one of them, too."),
    ],
)
def test_what_cannot_be_done_is_told_before_anything_begins(cramhy, words, message):
    done = cramhy(*words)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"cramhy: {message}\n")


def test_a_port_is_a_number_of_16_bits(cramhy):
    done = cramhy("repl", "--serve", "--port", "65536")
    assert done.returncode == 2 and done.stderr.endswith("cramhy repl: error: argument --port: invalid port value: '65536'\n")


@pytest.mark.soak
def test_a_picture_of_the_whole_way(cramhy, tmp_path):
    (tmp_path / "plan.lisp").write_text('(roslisp:start-ros-node "x") (turtlesim:press :up) (sleep 1.5)')
    done = cramhy("run", "plan.lisp", "--time", "virtual", "--picture", "way.replay.svg")
    assert done.returncode == 0
    assert (tmp_path / "way.replay.svg").read_text().count("stroke-dashoffset") == 1


@pytest.mark.soak
def test_a_picture_without_a_turtle_is_a_problem_that_is_told(cramhy, tmp_path):
    (tmp_path / "plan.lisp").write_text("(+ 1 2)")
    done = cramhy("run", "plan.lisp", "--time", "virtual", "--picture", "x.png")
    assert (done.returncode, done.stderr) == (
        1,
        "cramhy: SIMPLE-ERROR\n  No turtlesim is running in this process. It starts with "
        '(start-ros-node "name"), or with (turtlesim:start).\n',
    )


@pytest.mark.soak
@pytest.mark.parametrize("words", ["repl --serve", "turtlesim"])
def test_a_port_that_is_taken_ends_the_command_with_the_reason(cramhy, private, words):
    pytest.importorskip("uvicorn")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = cramhy(*words.split(), "--port", str(port))
    assert (done.stdout, done.stderr, done.returncode) == (
        "",
        f"cramhy: The server cannot listen on port {port} of 127.0.0.1: Address already in use. Choose another port, or none for a "
        "free one.\n",
        2,
    )
