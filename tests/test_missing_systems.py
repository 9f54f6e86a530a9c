"""cramhy works where POSIX is missing: a fresh interpreter from which the modules, calls and signals are hidden that Windows or a browser
do not have. The commands, the lectures and the page run where nobody sees them; the suites of the rooms run where pytest and the libraries
still do, because these know by the name of the system what it has."""

from __future__ import annotations

import json
import os
import re
import runpy
import subprocess
import sys
import urllib.request
from pathlib import Path

import portable
import pytest

ROOT = Path(__file__).parents[1]
MODULES = """crypt curses _curses fcntl grp nis pty pwd readline resource spwd syslog termios tty _posixshmem""".split()
OF_OS = """chown confstr ctermid fchdir fchmod fchown fork forkpty fpathconf fstatvfs getegid geteuid getgid getgroups getloadavg getpgid
    getpgrp getpriority getresgid getresuid getsid getuid initgroups killpg lchown lockf major makedev minor mkfifo mknod nice
    openpty pathconf posix_fadvise posix_fallocate posix_spawn posix_spawnp pread preadv pwrite pwritev readv register_at_fork
    sched_get_priority_max sched_get_priority_min sched_getaffinity sched_getparam sched_getscheduler sched_param
    sched_rr_get_interval sched_setaffinity sched_setparam sched_setscheduler sched_yield sendfile setegid seteuid setgid
    setgroups setpgid setpriority setregid setresgid setresuid setreuid setsid setuid statvfs sync tcgetpgrp tcsetpgrp
    ttyname uname wait wait3 wait4 waitid writev O_CLOEXEC O_DIRECTORY O_NOCTTY O_NOFOLLOW O_NONBLOCK O_SYNC""".split()
"""Without ``sysconf``, which the asyncio of a POSIX build of Python 3.12 and later asks for itself."""
OF_SIGNAL = """SIGALRM SIGBUS SIGCHLD SIGCONT SIGHUP SIGIO SIGKILL SIGPIPE SIGPROF SIGQUIT SIGSTOP SIGSYS SIGTRAP SIGTSTP SIGTTIN SIGTTOU
    SIGURG SIGUSR1 SIGUSR2 SIGVTALRM SIGWINCH ITIMER_PROF ITIMER_REAL ITIMER_VIRTUAL alarm getitimer pause pthread_kill pthread_sigmask
    setitimer siginterrupt sigpending sigtimedwait sigwait sigwaitinfo""".split()
HIDING = f"""
import os, select, signal, sys, time, _thread

class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name in {MODULES!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}} (hidden by a test)", name=name)

sys.meta_path.insert(0, Hidden())
for name in {MODULES!r}:
    sys.modules.pop(name, None)
import posix
for name in {OF_OS!r}:
    for module in (os, posix):
        if hasattr(module, name):
            delattr(module, name)
import _signal
for name in {OF_SIGNAL!r}:
    for module in (signal, _signal):
        if hasattr(module, name):
            delattr(module, name)
for module, name in ((time, "thread_time"), (_thread, "get_native_id"), (select, "epoll"), (select, "poll"), (select, "kqueue")):
    if hasattr(module, name):
        delattr(module, name)

class OfSockets:  # not a function, which `selectors` would make a method of its own
    real = select.select

    def __call__(self, reading, writing, failing, timeout=None):
        import stat

        for one in (*reading, *writing, *failing):
            if not stat.S_ISSOCK(os.fstat(one if isinstance(one, int) else one.fileno()).st_mode):
                raise OSError(10038, "An operation was attempted on something that is not a socket")
        return self.real(reading, writing, failing, timeout)

select.select = OfSockets()
os.environ["CRAMHY_TEST_HIDDEN"] = "yes"
"""
HIDING_FROM_CRAMHY = f"""
import _signal, _thread, builtins, os, select, signal, socket, sys, time

def ours(name):
    return (name or "").partition(".")[0] in ("cramhy_runtime", "cramhy")

def hide(module, *names):
    kept = {{name: module.__dict__.pop(name) for name in names if name in module.__dict__}}

    def __getattr__(name):
        if name in kept and not ours(sys._getframe(1).f_globals.get("__name__")):
            return kept[name]
        raise AttributeError(f"module {{module.__name__!r}} has no attribute {{name!r}}")

    module.__getattr__ = __getattr__

def import_for(name, globals=None, *rest, **named):
    if name in {MODULES!r} and globals and ours(globals.get("__name__")):
        raise ModuleNotFoundError(f"No module named {{name!r}} (hidden by a test)", name=name)
    return imported(name, globals, *rest, **named)

imported, builtins.__import__ = builtins.__import__, import_for
hide(os, *{OF_OS!r}, "sysconf")
hide(signal, *{OF_SIGNAL!r})
hide(time, "thread_time")
hide(_thread, "get_native_id")
hide(select, "epoll", "poll", "kqueue")
hide(socket, "AF_UNIX")
os.environ["CRAMHY_TEST_HIDDEN"] = "yes"
"""


def environment_hiding(factory, program):
    """An environment in which every Python runs the text PROGRAM before any other; ``sitecustomize`` is imported at the start."""
    if not sys.platform.startswith(("linux", "darwin")):
        pytest.skip("here these are missing anyway")
    folder = factory.mktemp("hiding")
    (folder / "sitecustomize.py").write_text(program)
    kept = {key: value for key, value in os.environ.items() if key not in ("ROS_PACKAGE_PATH", "PYTHONPATH")}
    return {
        **kept,
        "PYTHONPATH": os.pathsep.join([str(folder), str(ROOT / "src"), str(ROOT / "hy_src")]),
        "HOME": str(folder),
        "XDG_RUNTIME_DIR": str(factory.mktemp("run")),
    }


@pytest.fixture(scope="module")
def hidden(tmp_path_factory):
    """An environment in which every Python starts without what POSIX alone has."""
    return environment_hiding(tmp_path_factory, HIDING)


@pytest.fixture(scope="module")
def hidden_from_cramhy(tmp_path_factory):
    """An environment in which code of cramhy does not find what POSIX alone has, and all other code does."""
    return environment_hiding(tmp_path_factory, HIDING_FROM_CRAMHY)


@pytest.fixture
def cramhy(hidden, tmp_path):
    """``cramhy("run", "x.lisp")``: the finished process of that command in such an environment."""

    def cramhy(*words, input=""):
        return subprocess.run(
            [sys.executable, "-m", "cramhy_runtime.cli", *words],
            cwd=tmp_path,
            input=input,
            text=True,
            env=hidden,
            capture_output=True,
            timeout=300,
        )

    return cramhy


def python(hidden, program):
    return subprocess.run([sys.executable, "-c", program], text=True, capture_output=True, env=hidden, timeout=300)


@pytest.fixture(params=["threads", "greenlet"])
def backend(request):
    if request.param == "greenlet":
        pytest.importorskip("greenlet")
    return request.param


def test_they_are_hidden_indeed(hidden):
    done = python(
        hidden,
        """
import importlib, os, select, signal, sys
assert os.environ["CRAMHY_TEST_HIDDEN"] == "yes"
for name in ("resource", "termios", "fcntl", "pwd"):
    try:
        importlib.import_module(name)
    except ModuleNotFoundError:
        print(name)
print([name for name in ("uname", "getuid", "fork", "sched_getaffinity") if hasattr(os, name)],
      [name for name in ("SIGHUP", "SIGALRM", "SIGKILL", "setitimer") if hasattr(signal, name)])
try:
    select.select([sys.stdin], [], [], 0)
except OSError as problem:
    print(problem.errno)
""",
    )
    assert (done.stdout, done.stderr) == ("resource\ntermios\nfcntl\npwd\n[] []\n10038\n", "")


@pytest.mark.soak
def test_every_module_can_be_imported(hidden_from_cramhy):
    """numpy, of the extra ``robot``, asks a Linux for ``os.uname``, so that others find everything."""
    source = ROOT / "src"
    names = sorted(
        ".".join(path.relative_to(source).with_suffix("").parts).removesuffix(".__init__")
        for path in (source / "cramhy_runtime").rglob("*.py")
        if path.name != "__main__.py"
    )
    done = python(
        hidden_from_cramhy,
        f"""
import importlib
for name in {names!r}:
    try:
        importlib.import_module(name)
    except Exception as problem:
        print(name, type(problem).__name__, problem)
""",
    )
    assert (done.stdout, done.stderr) == ("", "")


@pytest.mark.soak
def test_the_repl_does_both_lectures_from_a_pipe(cramhy, backend, tmp_path):
    lectures = runpy.run_path(str(ROOT / "tutorials" / "lectures.py"))
    lines = [*lectures["LECTURE_34"], *lectures["LECTURE_38"], "(value *turtle-pose*)", "(car 5)", '(turtlesim:save-paper "paper.png")']
    done = cramhy("repl", "--time", "virtual", "--backend", backend, input="\n".join(lines))
    assert (done.returncode, done.stderr) == (0, "")
    shown = done.stdout
    assert shown.count("Node startup complete") == 2 and shown.count("TurtleSim pen control invoked") == 10
    assert shown.count("debugger invoked") == 1 and "is not of type\n    LIST" in shown and '\n0] "paper.png"' in shown
    x, y = re.findall(r"X:\s+([\d.]+)d0\s+Y:\s+([\d.]+)d0", shown)[-1]
    assert (round(float(x)), round(float(y))) == (9, 9)
    assert (tmp_path / "paper.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.soak
def test_a_file_runs(cramhy, backend, tmp_path):
    (tmp_path / "plan.lisp").write_text(
        "(in-package :cram-user)\n(print (top-level (par (sleep 1) (progn (sleep 2) :done))))\n"
        "(print (top-level (with-failure-handling ((simple-plan-failure (e)\n"
        "        (declare (ignore e)) (return 'caught)))\n"
        '                    (pursue (sleep 9) (fail "Lost.")))))'
    )
    done = cramhy("run", "plan.lisp", "--backend", backend, "--time", "virtual")
    assert (done.returncode, done.stderr) == (0, "") and "CAUGHT" in done.stdout


@pytest.mark.soak
def test_forms_are_evaluated_as_json(cramhy, backend):
    told = ("machine-type", "software-type", "machine-instance", "software-version")
    forms = [
        "(+ 1 2)",
        "(progn (time (loop repeat 10)) 1)",
        *(f"(typep ({name}) '(or null string))" for name in told),
        "(>= (get-internal-run-time) 0)",
        "(progn (room) t)",
        "(cpl:top-level (cpl:par (cpl:sleep 1) (cpl:sleep 2)) 7)",
        "(listen)",
        "(read-line *standard-input* nil)",
    ]
    done = cramhy("eval", "--backend", backend, input="".join(json.dumps({"form": form}) + "\n" for form in forms))
    assert (done.returncode, done.stderr) == (0, "")
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert [answer["error"] for answer in answers] == [None] * len(forms)
    assert [answer["values"] for answer in answers] == [["3"], ["1"], *[["T"]] * 6, ["7"], ["NIL"], ["NIL", "T"]]
    assert "seconds of total run time" in answers[1]["output"]
    assert "Dynamic space usage is:   not told by this system.\n" in answers[7]["output"]


@pytest.mark.soak
def test_the_author_of_a_file_is_not_known(cramhy, tmp_path):
    (tmp_path / "x").write_text("")
    done = cramhy("eval", input=json.dumps({"form": '(file-author "x")'}))
    assert json.loads(done.stdout) == {"output": "", "values": ["NIL"], "error": None}


@pytest.mark.soak
def test_unit_tests_run_without_an_alarm(cramhy, tmp_path):
    (tmp_path / "tests.lisp").write_text("(in-package :cl-user)\n(lisp-unit:define-test adds (lisp-unit:assert-equal 3 (+ 1 2)))")
    done = cramhy("test", "tests.lisp")
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_shims_are_printed(cramhy):
    done = cramhy("ros-shims")
    assert done.returncode == 0 and "rostopic() {" in done.stdout + done.stderr.replace("rostopic stay", "rostopic() {")
    assert "cramhy() {" in done.stdout


@pytest.mark.soak
def test_commands_that_need_no_session(cramhy):
    assert cramhy("ros", "rosversion", "-d").stdout == "noetic\n"
    assert cramhy("ros", "rosmsg", "show", "geometry_msgs/Point").stdout == "float64 x\nfloat64 y\nfloat64 z\n\n"
    assert cramhy("ros", "rostopic", "list").stderr.startswith("ERROR: Unable to communicate with master!\nNo session serves here.")
    assert cramhy("teleop").stderr.startswith("ERROR: Unable to communicate with master!\nNo session serves here.")


@pytest.mark.soak
def test_a_session_serves_and_another_terminal_reaches_it(hidden, cramhy):
    pytest.importorskip("uvicorn")
    process = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--serve"],
        env=hidden,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        process.stdin.write('(roslisp:start-ros-node "a")\n"ready"\n')
        process.stdin.flush()
        shown = ""
        while '"ready"' not in shown:
            line = process.stdout.readline()
            assert line, shown
            shown += line
        assert "/turtle1/pose" in cramhy("ros", "rostopic", "list").stdout
        done = cramhy("ros", "rosservice", "call", "/clear")
        assert (done.returncode, done.stderr) == (0, "")
    finally:
        process.stdin.close()
        process.stdout.read()
        assert process.wait(60) == 0


@pytest.mark.soak
def test_a_prompt_on_a_terminal_reads_lines(hidden):
    """Reading waits where nobody can say whether a line is there; the forms typed are answered."""
    pty = pytest.importorskip("pty")
    master, slave = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--time", "virtual"],
        stdin=slave,
        stdout=slave,
        stderr=slave,
        env={**hidden, "TERM": "dumb"},
    )
    os.close(slave)
    seen = b""
    try:
        for line, answer in ((b"(* 6 7)\n", b"\r\n42"), (b'(progn (sleep 1) "slept")\n', b'\r\n"slept"'), (b"(exit)\n", b"")):
            while not seen.rstrip(b" ").endswith(b"USER>"):
                seen += os.read(master, 4096)
            seen = b""
            os.write(master, line)
            while answer not in seen:
                seen += os.read(master, 4096)
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait()
        os.close(master)


def test_the_page_of_a_session_is_served(hidden, tmp_path):
    pytest.importorskip("uvicorn")
    process = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--view", "--time", "virtual"],
        env={**hidden, "DISPLAY": "", "WAYLAND_DISPLAY": ""},
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        address = next(line for line in process.stderr if "http://" in line).split()[-1].partition("#")[0]
        for path, part in (("", "<!doctype html>"), ("app.js", "import"), ("shapes.json", "{")):
            with urllib.request.urlopen(address + path, timeout=60) as answer:
                assert part in answer.read().decode()
        output, _ = process.communicate('(top-level (par (sleep 1) (sleep 2)) "done")\n', timeout=120)
        assert process.returncode == 0 and '"done"' in output
    finally:
        process.kill()
        process.communicate()


def test_they_are_hidden_from_cramhy_alone(hidden_from_cramhy):
    done = python(
        hidden_from_cramhy,
        """
import os, pty, signal, termios
asked = "import os, signal; print(hasattr(os, 'getuid'), hasattr(signal, 'SIGKILL'))\\ntry:\\n    import termios\\nexcept ImportError as problem:\\n    print(problem)"
for name in ("cramhy_runtime.kernel.anything", "pytest"):
    exec(asked, {"__name__": name})
""",
    )
    assert (done.stdout, done.stderr) == ("False False\nNo module named 'termios' (hidden by a test)\nTrue True\n", "")


@pytest.mark.soak
@pytest.mark.parametrize(
    "room", [room if room in ("kernel", "cpl") else pytest.param(room, marks=pytest.mark.soak) for room in portable.SUITES]
)
def test_the_suite_of_a_room_passes(hidden_from_cramhy, room):
    options = ["-q", "--no-header", "-p", "no:cacheprovider", "-p", "no:xdist", "--tb=short"]
    environment = {key: value for key, value in hidden_from_cramhy.items() if not key.startswith("PYTEST_")}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *portable.files(room)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=500,
    )
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr
