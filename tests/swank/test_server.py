"""The socket: who may connect, what is done with bytes that are no messages, and how it ends."""

from __future__ import annotations

import os

import pytest
from systems import posix

from cramhy_runtime import kernel
from cramhy_runtime.swank import package, server, slime_version
from cramhy_runtime.swank.wire import Name

from .socket_client import Client, PlainClient, said


def test_forms_over_a_socket(serve):
    client = Client(serve().port)
    assert client.call('(swank:interactive-eval "(+ 1 2)")') == [":ok", "=> 3 (2 bits, #x3, #o3, #b11)"]


def test_it_listens_on_loopback_only(serve):
    assert serve().socket.getsockname()[0] == "127.0.0.1"


def test_the_port_is_written_into_a_file(serve, tmp_path):
    found = serve(port_file=str(tmp_path / "port"))
    assert (tmp_path / "port").read_text() == f"{found.port}\n"
    with pytest.raises(server.ServerError, match="The port cannot be written into /no/such/folder/port: No such file or directory."):
        serve(port_file="/no/such/folder/port")


@posix
def test_a_link_in_the_place_of_the_port_file_is_replaced_and_not_followed(serve, tmp_path):
    (tmp_path / "precious").write_text("precious")
    (tmp_path / "port").symlink_to(tmp_path / "precious")
    found = serve(port_file=str(tmp_path / "port"))
    assert (tmp_path / "precious").read_text() == "precious" and (tmp_path / "port").read_text() == f"{found.port}\n"


def test_a_port_that_is_taken(serve):
    port = serve().port
    with pytest.raises(
        server.ServerError, match=f"The server for Emacs cannot listen on port {port} of 127.0.0.1: Address already in use."
    ):
        serve(port)


def test_two_clients_at_a_time_and_one_after_the_other(serve):
    found = serve()
    one, other = Client(found.port), Client(found.port)
    assert one.call("(swank:ping)") == other.call("(swank:ping)") == [":ok", "pong"]
    one.socket.close()
    assert other.call("(swank:ping)") == [":ok", "pong"]
    assert Client(found.port).call("(swank:ping)") == [":ok", "pong"]


def test_the_end_of_the_session_ends_the_connection(serve, session):
    client = Client(serve().port)
    assert client.call("(swank:ping)") == [":ok", "pong"]
    kernel.stop()
    assert client._message() is None


# ----------------------------------------------------------------------------------------------------------------------- hostile


@pytest.mark.parametrize("data", [b"GET / HTTP/1.1\r\n\r\n", b"zzzzzz(a)", b"\x00" * 6, "０００００３(a)".encode()])
def test_bytes_that_are_no_frame_end_the_connection(serve, data):
    found = serve()
    client, other = Client(found.port), Client(found.port)
    client.socket.sendall(data)
    assert client.hear() is None
    assert len(serve.logged) == 1 and serve.logged[0].startswith("A client was sent away. A frame begins with its length")
    assert other.call("(swank:ping)") == [":ok", "pong"]


def test_half_a_frame_and_no_more(serve):
    found = serve()
    client = Client(found.port)
    client.socket.sendall(b"00ffff(:emacs-rex ")
    client.socket.close()
    assert Client(found.port).call("(swank:ping)") == [":ok", "pong"]
    assert serve.logged == []


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"000003(a)", "There is no message a."),
        (b"000002()", "A message is a list that begins with a name."),
        (b"00000212", "A message is a list that begins with a name."),
        (b"000003\xff\xfe\xfd", "The message is no UTF-8 (byte 0 of 3)."),
        (b"000002((", "The message ends inside of a list."),
        (b"00000e(:emacs-rex 1)", None),
    ],
)
def test_messages_that_are_wrong_are_told_and_the_next_is_read(serve, data, why):
    client = Client(serve().port)
    length = len(data) - 6
    client.socket.sendall(b"%06x" % length + data[6:])
    message = client.hear()
    assert message[0] == ":reader-error" and (why is None or message[2] == why)
    assert len(serve.logged) == 1 and serve.logged[0].startswith("A message of a client was not understood. ")
    assert client.call("(swank:ping)") == [":ok", "pong"]


@pytest.mark.parametrize(
    ("form", "why"),
    [
        ("(swank:no-such-call 1)", "cramhy does not know the call swank:no-such-call."),
        ("(swank:interactive-eval)", "interactive-eval takes 1 argument, and 0 came."),
        ("(swank:interactive-eval 1 2 3)", "interactive-eval takes 1 argument, and 3 came."),
        ("(swank:operator-arglist)", "operator-arglist takes 1 to 2 arguments, and 0 came."),
        ("(swank:interactive-eval 5)", "An argument must be a string."),
        ('(swank:interactive-eval (cl:delete-file "x"))', "cramhy evaluates no calls in the arguments of a call, such as cl:delete-file."),
        ('(cl:delete-file "x")', "cramhy does not know the call cl:delete-file."),
        ("12", "A call of Emacs is a list that begins with a name."),
        ('(cl:mapc "x" \'(1))', "cramhy does not know the call cl:mapc."),
    ],
)
def test_calls_that_are_wrong_are_refused(serve, form, why):
    client = Client(serve().port)
    assert client.call(form) == [":abort", why]
    assert client.call("(swank:ping)") == [":ok", "pong"]


def test_a_client_that_reads_nothing_is_sent_away(serve, monkeypatch):
    monkeypatch.setattr(server, "MOST_UNREAD", 100_000)
    found = serve()
    client = Client(found.port)
    client.send('(:emacs-rex (swank-repl:listener-eval "(loop (princ (make-string 50000)) (sleep 0.001))") nil :repl-thread 1)')
    for _ in range(20_000):
        if serve.logged and not found.connections:
            break
        kernel.run_blocking(lambda: None)
        kernel.sleep(0.01)
    assert serve.logged == ["A client was sent away: it does not read what it is sent."]
    assert Client(found.port).call("(swank:ping)") == [":ok", "pong"]


def test_too_many_calls_at_a_time(emacs):
    from cramhy_runtime.swank.connection import MOST_REQUESTS

    for _ in range(MOST_REQUESTS):
        emacs.rex('(swank:interactive-eval "(sleep 1000)")')
    assert emacs.refused("(swank:ping)") == f"{MOST_REQUESTS} calls of this client have not ended."


def test_a_long_answer_and_a_long_question(serve):
    client = Client(serve().port)
    answer = client.call('(swank:eval-and-grab-output "(dotimes (i 20000) (print i))")')
    assert answer[0] == ":ok" and len(answer[1][0]) > 100_000
    text = '(length \\"' + "x" * 200_000 + '\\")'
    assert client.call(f'(swank:interactive-eval "{text}")')[1].startswith("=> 200000 ")


# ------------------------------------------------------------------------------------------------------------------------- SWANK


def test_slime_starts_the_server_by_the_form_that_it_types(session, home, tmp_path):
    from cramhy_runtime.cli import offer_swank

    offer_swank(session, None)
    loader, port_file = tmp_path / "slime" / "swank-loader.lisp", tmp_path / "port"
    loader.parent.mkdir()
    (loader.parent / "slime.el").write_text(";;; slime.el\n;; Version: 2.99\n")
    [port] = session.evaluate_text(
        f'(progn (load "{loader}" :verbose t) (funcall (read-from-string "swank-loader:init") :from-emacs t)'
        f' (funcall (read-from-string "swank:start-server") "{port_file}"))'
    )
    assert port_file.read_text() == f"{port}\n"
    client = Client(port)
    info = client.call("(swank:connection-info)")[1]
    assert info[info.index(Name(":version")) + 1] == "2.99"
    slime_version._said.clear()
    assert session.evaluate_text(f"(swank:stop-server {port})") == [True]
    assert session.evaluate_text("(swank:stop-server)") == [None]


def test_a_server_at_the_prompt(session, home):
    from cramhy_runtime.cli import offer_swank

    offer_swank(session, None)
    [port] = session.evaluate_text("(swank:create-server :port 0 :dont-close t)")
    assert Client(port).call("(slynk:ping)") == [":ok", "pong"]
    assert package.stop_server() is True


def test_every_call_of_the_table_is_in_a_test():
    from pathlib import Path

    from cramhy_runtime.swank.rpcs import known

    texts = "".join(path.read_text() for path in Path(__file__).parent.glob("*.*"))
    assert [name for name in known() if name not in texts] == []


def test_the_version_is_that_of_the_slime_that_is_installed(tmp_path, monkeypatch):
    """Debian's SLIME names a swank-loader.lisp that is not there, so slime.el is not beside it."""
    installed = tmp_path / "elpa" / "slime-2.31" / "slime.el"
    installed.parent.mkdir(parents=True)
    installed.write_text(";;; slime.el --- x\n;; Version: 2.31\n")
    monkeypatch.setattr(slime_version, "PLACES", [str(tmp_path / "elpa" / "slime-*" / "slime.el")])
    monkeypatch.setattr(slime_version, "_said", [])
    slime_version.started_from(str(tmp_path / "no-such-folder" / "swank-loader.lisp"))
    assert slime_version.slime_version() == "2.31"
    own = tmp_path / "own"
    own.mkdir()
    (own / "slime.el").write_text(";; Version: 2.28\n")
    slime_version.started_from(str(own / "swank-loader.lisp"))
    assert slime_version.slime_version() == "2.28"


# ------------------------------------------------------------------------------------------------------------------ command line


class Process:
    """``cramhy ...`` in a process of its own, with a port file."""

    def __init__(self, folder, *words, text=None):
        import subprocess
        import sys
        from pathlib import Path

        root = Path(__file__).parents[2]
        environ = {**os.environ, "HOME": str(folder), "PYTHONPATH": f"{root / 'src'}{os.pathsep}{root / 'hy_src'}", "CRAMHY_VIEW": "no"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "cramhy_runtime.cli", *words],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder, env=environ,
        )  # fmt: skip

    def port(self):
        line = self.process.stderr.readline()
        assert line.startswith("; Emacs connects by M-x slime-connect RET 127.0.0.1 RET "), line + self.process.stderr.read()
        return int(line.split()[-2])

    def end(self):
        out, err = self.process.communicate(timeout=60)
        return self.process.returncode, out, err


@pytest.mark.soak
@posix
@pytest.mark.parametrize("ending", ["quit-lisp", "SIGTERM", "SIGINT"])
def test_a_session_for_emacs_alone(tmp_path, ending):
    import signal

    process = Process(tmp_path, "swank", "--port", "0", "--port-file", "port", "--time", "virtual", "--no-turtlesim")
    port = process.port()
    assert (tmp_path / "port").read_text() == f"{port}\n"
    client = PlainClient(port, said(tmp_path))
    assert client.call('(swank:interactive-eval "(progn (sleep 500) 7)")') == [":ok", "=> 7 (3 bits, #x7, #o7, #b111)"]
    client.send('(:emacs-rex (swank-repl:listener-eval "(unwind-protect (read-line) (princ :cleaned))") nil :repl-thread 2)')
    while client.hear()[0] != ":read-string":
        pass
    if ending == "quit-lisp":
        client.send("(:emacs-rex (swank:quit-lisp) nil t 3)")
    else:
        process.process.send_signal(getattr(signal, ending))
    heard = []
    while (message := client.hear()) is not None:
        heard.append(message)
    assert [":write-string", "CLEANED"] in heard
    status, out, err = process.end()
    assert (status, out, err) == (130 if ending == "SIGINT" else 143, "", "")


@pytest.mark.soak
def test_emacs_beside_a_prompt_in_virtual_time(tmp_path):
    process = Process(tmp_path, "repl", "--swank", "--time", "virtual", "--no-turtlesim")
    client = PlainClient(process.port(), said(tmp_path))
    assert client.call('(swank:interactive-eval "(progn (sleep 500) (setf from-emacs 7))")')[0] == ":ok"
    process.process.stdin.write("(list from-emacs (car 5))\n0\n(progn (sleep 100) 8)\n")
    process.process.stdin.flush()
    status, out, err = process.end()
    assert status == 0 and "debugger invoked on a TYPE-ERROR" in out and out.endswith("CL-USER> 8\nCL-USER> ") and err == ""


@pytest.mark.soak
@pytest.mark.parametrize(
    ("words", "why"),
    [
        (
            ["swank", "--port-file", "/no/such/folder/port"],
            "The port cannot be written into /no/such/folder/port: No such file or directory.",
        ),
        (["swank", "--socket", "/no/such/folder/socket"], "The server for Emacs cannot listen on /no/such/folder/socket: No such file"),
    ],
)
def test_what_keeps_it_from_listening_is_told(tmp_path, words, why):
    status, out, err = Process(tmp_path, *words).end()
    assert status == 2 and out == "" and err.startswith(f"cramhy: {why}")
