"""Who may connect: clients that say the secret, and nobody else, however fast they come and go."""

from __future__ import annotations

import os
import socket
import stat
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
from systems import linux, posix

from cramhy_runtime import kernel
from cramhy_runtime.swank import secret, server, sockets, wire

from .socket_client import Client
from .socket_client import secret as of_home

AGAIN = "Then start again: a new one is made, which SLIME reads by itself."
PING = wire.frame("(:emacs-rex (swank:ping) nil t 1)")
ONE_CALL = wire.frame('(:emacs-rex (swank:interactive-eval "(setf cl-user::was-here t)") nil t 1)')
not_known = "A client was sent away: its first message is not the secret that stands in ~/.slime-secret."
root = pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give files away, or be somebody else")


@pytest.fixture
def file(home):
    path = home / ".slime-secret"
    path.write_text("open sesame\nmore\n")
    path.chmod(0o600)
    return path


def nothing_ran(session):
    return session.evaluate_text("(boundp 'cl-user::was-here)") == [None]


# ------------------------------------------------------------------------------------------------------------------ the secret


def test_a_secret_is_made_where_there_is_none(serve, home):
    found = serve()
    text = (home / ".slime-secret").read_text()
    assert len(text) == 65 and set(text[:-1]) <= set("0123456789abcdef") and text.endswith("\n")
    if os.name == "posix":
        assert stat.S_IMODE((home / ".slime-secret").stat().st_mode) == 0o600
    assert Client(found.port).call("(swank:ping)") == [":ok", "pong"]
    assert [path.name for path in home.iterdir() if "secret" in path.name] == [".slime-secret"]


def test_the_secret_of_the_next_session_is_the_same(home):
    assert secret.current() == secret.current() == of_home().encode()


def test_sessions_that_start_at_once_agree(home):
    with ThreadPoolExecutor(16) as pool:
        for _ in range(20):
            found = set(pool.map(lambda _: secret.current(), range(16)))
            assert found == {of_home().encode()}
            (home / ".slime-secret").unlink()


def test_the_secret_is_the_first_line_of_the_users_own_file(serve, file):
    found = serve()
    assert Client(found.port, wire.frame("open sesame")).call("(swank:ping)") == [":ok", "pong"]
    assert file.read_text() == "open sesame\nmore\n"


def test_a_file_with_lines_of_dos_is_read_as_emacs_reads_it(serve, file):
    file.write_bytes(b"open sesame\r\nmore\r\n")
    assert Client(serve().port, wire.frame("open sesame")).call("(swank:ping)") == [":ok", "pong"]


def test_a_secret_that_the_user_has_changed_counts_from_then_on(serve, file):
    found = serve()
    file.write_text("another\n")
    assert Client(found.port, wire.frame("open sesame")).hear() is None
    assert Client(found.port, wire.frame("another")).call("(swank:ping)") == [":ok", "pong"]
    file.unlink()
    assert Client(found.port, wire.frame("another")).hear() is None  # that has made a new one
    assert Client(found.port).call("(swank:ping)") == [":ok", "pong"]


def refused(serve):
    with pytest.raises(server.ServerError) as told:
        serve()
    return str(told.value)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "is empty: its first line is the secret. Type: rm"),
        ("\n", "is empty: its first line is the secret. Type: rm"),
        (" \t\r\nmore", "is empty: its first line is the secret. Type: rm"),
        ("x" * 4097, "has a first line of more than 4096 bytes. Type: rm"),
    ],
)
def test_a_secret_that_is_none_is_refused(serve, file, text, why):
    file.write_text(text)
    assert refused(serve) == f"~/.slime-secret, the secret for Emacs, {why} ~/.slime-secret. {AGAIN}"


@posix
@pytest.mark.parametrize("mode", [0o644, 0o640, 0o604, 0o620, 0o602, 0o611])
def test_a_secret_that_others_may_read_or_write_is_refused(serve, file, mode):
    file.chmod(mode)
    assert refused(serve) == (
        "~/.slime-secret, the secret for Emacs, may be read or written by other users, so it is not a secret any more. "
        f"Type: rm ~/.slime-secret. {AGAIN}"
    )


@posix
@pytest.mark.parametrize("end", ["there", "nowhere"])
def test_a_link_is_refused_and_stays(serve, home, end):
    (home / "there").write_text("open sesame\n")
    (home / "there").chmod(0o600)
    (home / ".slime-secret").symlink_to(home / end)
    assert (
        refused(serve) == f"~/.slime-secret, the secret for Emacs, is a link, and not a file of its own. Type: rm ~/.slime-secret. {AGAIN}"
    )
    assert (home / ".slime-secret").is_symlink() and not (home / "nowhere").exists()


@posix
def test_a_pipe_or_a_folder_in_its_place_is_refused(serve, home):
    os.mkfifo(home / ".slime-secret", 0o600)
    told = f"~/.slime-secret, the secret for Emacs, is not a file. Type: rm -r ~/.slime-secret. {AGAIN}"
    assert refused(serve) == told
    (home / ".slime-secret").unlink()
    (home / ".slime-secret").mkdir(0o700)
    assert refused(serve) == told


@root
def test_a_secret_or_a_home_of_another_user_is_refused(serve, file, home):
    os.chown(file, 1234, -1)
    assert refused(serve) == f"~/.slime-secret, the secret for Emacs, belongs to another user, 1234. Type: rm -f ~/.slime-secret. {AGAIN}"
    file.unlink()
    os.chown(home, 1234, -1)
    assert refused(serve) == (
        f"~/.slime-secret, the secret for Emacs, is not made in {home}: that folder belongs to another user, 1234. Set HOME to your own one."
    )
    assert not file.exists()


@posix
def test_a_home_that_is_not_there_is_told(serve, home, monkeypatch):
    monkeypatch.setenv("HOME", str(home / "missing"))
    assert refused(serve) == (
        "~/.slime-secret, the secret for Emacs, cannot be made: No such file or directory. Make its folder first, or choose another one. "
        "Set HOME to a folder of yours, for Emacs and for this session."
    )


def test_a_secret_that_is_spoilt_while_the_session_runs_lets_nobody_in(serve, file):
    found = serve()
    file.write_text("\n")
    for said in ("", "\n", "open sesame"):
        assert Client(found.port, wire.frame(said)).hear() is None
    assert serve.logged == [
        "A client was sent away. ~/.slime-secret, the secret for Emacs, is empty: its first line is the secret. "
        f"Type: rm ~/.slime-secret. {AGAIN}"
    ]


# ---------------------------------------------------------------------------------------------------------------- the handshake


@pytest.mark.parametrize(
    "said",
    [
        wire.frame("close sesame"),
        wire.frame(""),
        wire.frame("open sesame\n"),
        wire.frame("open sesam"),
        wire.frame("OPEN SESAME"),
        wire.frame('"open sesame"'),
        ONE_CALL,
        wire.frame("x" * 5000),
        b"ffffff(",
    ],
    ids=["another", "empty", "with its newline", "a part", "large letters", "a string", "a call", "too long", "16 MB"],
)
@pytest.mark.parametrize("closes", [False, True], ids=["waits", "closes at once"])
def test_a_client_without_the_secret_is_sent_away(serve, session, file, said, closes):
    found = serve()
    client = Client(found.port, said + ONE_CALL)
    if closes:
        client.socket.close()
    else:
        assert client.hear() is None
    assert Client(found.port, wire.frame("open sesame")).call("(swank:ping)") == [":ok", "pong"]
    assert nothing_ran(session) and serve.logged == [not_known]


def test_a_client_that_says_the_secret_and_closes_at_once_costs_nothing(serve, session, file):
    found = serve()
    for _ in range(20):
        Client(found.port, wire.frame("open sesame") + PING).socket.close()
    assert Client(found.port, wire.frame("open sesame")).call("(swank:ping)") == [":ok", "pong"]
    assert serve.logged == [] and len(found.connections) == 1


def test_clients_that_say_nothing_make_way(serve, file, monkeypatch):
    monkeypatch.setattr(server, "MOST_STRANGERS", 8)
    found = serve()
    strangers = [Client(found.port, b"00000b"[: number % 7]) for number in range(60)]
    assert Client(found.port, wire.frame("open sesame")).call("(swank:ping)") == [":ok", "pong"]
    assert [stranger.hear() for stranger in strangers[:40]] == [None] * 40
    assert serve.logged == []


def test_a_client_that_says_nothing_is_sent_away_after_a_while(serve, file, monkeypatch):
    monkeypatch.setattr(server, "FIRST_MESSAGE", 0.01)
    assert Client(serve().port, b"00000bopen").hear() is None
    assert serve.logged == ["A client was sent away: it has not said the secret within 0.01 s."]


def test_a_flood_of_clients_is_told_in_one_line(serve, file, monkeypatch):
    found = serve()
    for _ in range(5):
        assert Client(found.port, ONE_CALL).hear() is None
    assert serve.logged == [not_known]
    monkeypatch.setattr(server, "QUIET", 0.0)
    assert Client(found.port, ONE_CALL).hear() is None
    assert serve.logged == [not_known, f"{not_known} So were 4 more since the last line."]


def test_clients_beyond_the_number_are_sent_away_though_they_know_the_secret(serve, file, monkeypatch):
    monkeypatch.setattr(server, "MOST_CLIENTS", 2)
    found = serve()
    clients = [Client(found.port, wire.frame("open sesame")) for _ in range(2)]
    assert [client.call("(swank:ping)") for client in clients] == [[":ok", "pong"]] * 2
    assert Client(found.port, wire.frame("open sesame")).hear() is None
    assert serve.logged == ["A client was sent away: 2 are connected."]


ATTACK = """
import socket, sys
for number in range(int(sys.argv[3])):
    for _ in range(8):
        with socket.socket() as client:
            client.connect(("127.0.0.1", int(sys.argv[1])))
            client.sendall(bytes.fromhex(sys.argv[2]))
"""


@pytest.mark.soak
@linux
@root
def test_another_user_of_the_machine_runs_nothing(serve, session, home):
    """100 rounds of eight connections, each of which sends a call and closes at once; then /proc/net/tcp shows nobody's number."""
    found = serve()
    words = ["setpriv", "--reuid", "1234", "--clear-groups", "/usr/bin/python3", "-c", ATTACK, str(found.port), ONE_CALL.hex(), "100"]
    kernel.run_blocking(lambda: subprocess.run(words, check=True, cwd="/", capture_output=True))
    assert Client(found.port).call("(swank:ping)") == [":ok", "pong"]
    assert nothing_ran(session)


# ------------------------------------------------------------------------------------------------------------------ Unix sockets


@pytest.fixture
def path(tmp_path):
    return str(tmp_path / "socket")


def left_by_a_dead_process(path):
    code = "import socket, sys; s = socket.socket(socket.AF_UNIX); s.bind(sys.argv[1]); s.listen()"
    subprocess.run([sys.executable, "-S", "-c", code, path], check=True)
    assert stat.S_ISSOCK(os.lstat(path).st_mode)


@posix
@pytest.mark.parametrize("umask", [0, 0o022, 0o777])
def test_a_unix_socket_is_its_users_alone_and_asks_for_the_secret(serve, session, home, path, umask):
    secret.current()
    before = os.umask(umask)
    try:
        found = serve(path)
    finally:
        os.umask(before)
    assert stat.S_IMODE(os.stat(path).st_mode) == 0o600 and found.port is None
    assert Client(path).call("(swank:ping)") == [":ok", "pong"]
    assert Client(path, ONE_CALL).hear() is None and nothing_ran(session)
    found.close()
    assert sorted(os.listdir(home)) == [".slime-secret"]


@posix
def test_a_socket_of_a_dead_process_is_removed(serve, path):
    left_by_a_dead_process(path)
    serve(path)
    assert Client(path).call("(swank:ping)") == [":ok", "pong"]


@posix
def test_a_socket_of_a_living_session_is_refused_and_stays(serve, path):
    serve(path)
    with pytest.raises(server.ServerError) as told:
        serve(path)
    assert str(told.value) == f"Another session listens on {path}. Connect to that one, end it, or choose another place for this one."
    assert Client(path).call("(swank:ping)") == [":ok", "pong"]


@posix
@pytest.mark.parametrize("make", [lambda path: open(path, "w").close(), os.mkdir, lambda path: os.symlink("/nowhere", path)])
def test_what_is_no_socket_is_refused_and_stays(serve, path, make):
    make(path)
    with pytest.raises(server.ServerError) as told:
        serve(path)
    assert str(told.value) == f"The server for Emacs cannot listen on {path}: there is something else of that name. Choose another one."
    assert os.path.lexists(path)


@root
def test_a_socket_of_another_user_is_refused_and_stays(serve, path):
    left_by_a_dead_process(path)
    os.chown(path, 1234, -1)
    with pytest.raises(server.ServerError) as told:
        serve(path)
    assert (
        str(told.value) == f"The server for Emacs cannot listen on {path}: a socket of another user, 1234, is there. Choose another place."
    )
    assert os.path.lexists(path)


@posix
def test_a_folder_in_which_others_could_replace_the_socket_is_refused(serve, tmp_path, monkeypatch):
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    folder = tmp_path / "open"
    folder.mkdir()
    folder.chmod(0o777)
    with pytest.raises(server.ServerError) as told:
        serve(str(folder / "socket"))
    assert str(told.value) == (
        f"{folder} is a folder in which other users could replace the socket for Emacs. Choose one of your own, such as ~, "
        f"or type: chmod go-w {folder}"
    )
    folder.chmod(0o1777)  # as /tmp is
    serve(str(folder / "socket"))


@posix
def test_the_end_of_a_session_leaves_the_socket_of_another(path):
    first = sockets.Listening(path)
    os.unlink(path)
    second = sockets.Listening(path)
    first.close()
    assert os.path.exists(path)
    second.close()
    assert not os.path.exists(path)


@posix
def test_of_sessions_that_start_at_once_one_gets_the_socket_that_a_dead_one_left(path):
    def start(_):
        try:
            return sockets.Listening(path)
        except server.ServerError as problem:
            return str(problem)

    with ThreadPoolExecutor(8) as pool:
        for _ in range(10):
            left_by_a_dead_process(path)
            found = list(pool.map(start, range(8)))
            living = [each for each in found if not isinstance(each, str)]
            assert len(living) == 1, found
            with socket.socket(socket.AF_UNIX) as client:
                client.connect(path)
            living[0].close()
            assert os.listdir(os.path.dirname(path)) == []


@posix
def test_a_session_that_comes_while_another_puts_its_socket_in_the_place_of_a_dead_one_is_refused(path, monkeypatch):
    """The order in which two once came to live at one path: the first looks, the second looks and removes, the first removes."""
    left_by_a_dead_process(path)
    looks, found = sockets._refuses, []

    def another_comes(path):
        monkeypatch.setattr(sockets, "_refuses", looks)
        with ThreadPoolExecutor(1) as pool:
            found.append(pool.submit(sockets.Listening, path))
        return looks(path)

    monkeypatch.setattr(sockets, "PATIENCE", 0.1)
    monkeypatch.setattr(sockets, "_refuses", another_comes)
    first = sockets.Listening(path)
    with pytest.raises(server.ServerError, match="at the same time"):
        found[0].result()
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(path)
    first.close()
