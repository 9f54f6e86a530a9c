"""Programs of ours in odd surroundings: closed and full streams, other encodings, removed folders, small limits.

Each case is a real process started by a shell. Either it works, or one line says what is wrong, the exit status is not 0, and in no case
is there a traceback of Python's or a wait without end.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest


from .conftest import environment
from .terminal import Terminal

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the cases are written for a POSIX shell")
linux = pytest.mark.skipif(sys.platform != "linux", reason="/dev/full and these limits are Linux's")
LIMIT = 120  # s, for a machine that is busy; none of them waits for anything
CRAMHY = f"{shlex.quote(sys.executable)} -m cramhy_runtime.cli"
COMMANDS = {
    "repl": ("echo '(+ 1 2)' | ", "repl", "CL-USER> 3\nCL-USER> "),
    "run": ("", "run good.lisp --time virtual", "3 \n"),
    "eval": ("""echo '{"form": "(+ 1 2)"}' | """, "eval", '{"output": "", "values": ["3"], "error": null}\n'),
    "test": ("", "test tests.lisp", None),
    "ros-shims": ("", "ros-shims", None),
    "rosmsg": ("", "ros rosmsg show std_msgs/String", "string data\n\n"),
    "rospack": ("", "ros rospack find std_msgs", None),
}
"""Name: (what stands before it, its words, what it prints where all is well; ``None``: something)."""
FULL = (
    "cramhy: standard output cannot be written: No space left on device. Later output is lost. Make room there, or send the "
    "output elsewhere.\n"
)
NO_FOLDER = (
    "cramhy: the folder that this program was started in cannot be found (No such file or directory): it has been removed or may "
    "not be entered. Change to another one, with cd, and start again.\n"
)
NO_THREADS = (
    "cramhy: the system gives no more threads, or no memory for their stacks (ulimit -u, ulimit -v). Raise the limit, or end "
    "other programs.\n"
)
NO_FILES = "cramhy: too many files are open (ulimit -n). Raise the limit, or close other programs.\n"


def path_without_ros(folder):
    """A PATH with what the cases need: a machine may have a ROS, of which ros-shims speaks."""
    programs = folder / "programs"
    programs.mkdir(exist_ok=True)
    for name in ("bash", "head", "mkdir", "prlimit", "rmdir", "setpriv", "timeout", "yes"):
        found = shutil.which(name)
        if found and not (programs / name).exists():
            (programs / name).symlink_to(found)
    return str(programs)


@pytest.fixture
def shell(tmp_path):
    """``shell("cramhy repl <&-", X="value")``: the finished process of a command line of bash; a variable that is ``None`` is unset."""
    (tmp_path / "good.lisp").write_text("(princ (+ 1 2)) (terpri)".replace("(terpri)", '(format t " ~%")'))
    (tmp_path / "tests.lisp").write_text("(in-package :lisp-unit)\n(define-test adds (assert-equal 3 (+ 1 2)))\n")
    (tmp_path / "run").mkdir(mode=0o700)

    def shell(line, folder=tmp_path, text=True, **variables):
        surroundings = {
            **environment(),
            "XDG_RUNTIME_DIR": str(tmp_path / "run"),
            "LC_ALL": "C.UTF-8",
            "PATH": path_without_ros(tmp_path),
            **variables,
        }
        surroundings = {name: value for name, value in surroundings.items() if value is not None}
        done = subprocess.run(["bash", "-c", line], cwd=folder, env=surroundings, capture_output=True, timeout=LIMIT)
        if text:
            done.stdout, done.stderr = done.stdout.decode(), done.stderr.decode()
            if "ERROR:root:code for hash" in done.stderr:
                pytest.skip("Python's own hashlib runs out of memory while it is imported, and prints that itself")
            assert "Traceback" not in done.stdout + done.stderr and "Exception ignored" not in done.stderr, done
        return done

    return shell


@pytest.fixture(params=COMMANDS)
def command(request):
    """(what stands before the command, the command, what it prints)."""
    before, words, printed = COMMANDS[request.param]
    return before, f"{CRAMHY} {words}", printed


def works(done, printed):
    assert (done.returncode, done.stderr) == (0, ""), done
    assert done.stdout == printed if printed is not None else done.stdout, done


class TestStreams:
    @pytest.mark.soak(all_but=2)
    def test_where_all_is_well_each_prints_what_it_should(self, shell, command):
        before, words, printed = command
        works(shell(before + words), printed)

    @pytest.mark.soak(all_but=3)
    def test_closed_input_has_ended(self, shell, command):
        before, words, printed = command
        done = shell(f"{words} <&-")
        works(done, {"repl": "CL-USER> ", "eval": ""}.get(words.split()[-1], printed) if before else printed)

    @pytest.mark.soak(all_but=3)
    @pytest.mark.parametrize("closed", ["", "<&- ", "2>&- ", "<&- 2>&- "])
    def test_closed_output_is_dropped(self, shell, command, closed):
        before, words, _ = command
        done = shell(f"{before}{words} {closed}>&-")
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")

    @pytest.mark.soak
    def test_complaints_do_not_come_out_elsewhere_when_their_stream_is_closed(self, shell):
        done = shell(f"{CRAMHY} ros rostopic list 2>&-")
        assert (done.returncode, done.stdout) == (1, "")
        done = shell(f"{CRAMHY} run missing.lisp 2>&-")
        assert (done.returncode, done.stdout) == (1, "")

    @pytest.mark.soak
    def test_a_file_that_is_opened_does_not_take_the_number_of_a_closed_stream(self, shell, tmp_path):
        from cramhy_runtime import chronicle

        line = f"""echo '(format t "out of place")' | {CRAMHY} repl --time virtual --record run.mcap --eval '(warn "out of place")'"""
        for closed in (">&-", "2>&-", ">&- 2>&-"):
            assert shell(f"{line} {closed}").returncode == 0
            recording = chronicle.read(str(tmp_path / "run.mcap"))
            assert not recording.cut and b"out of place" not in (tmp_path / "run.mcap").read_bytes()

    @pytest.mark.soak(all_but=2)
    @linux
    def test_a_full_disk_behind_the_output_is_told_in_one_line(self, shell, command):
        before, words, _ = command
        done = shell(f"{before}{words} >/dev/full")
        assert (done.returncode, done.stderr) == (1, FULL)

    @pytest.mark.soak(all_but=1)
    @linux
    def test_a_full_disk_behind_the_complaints_changes_nothing(self, shell, command):
        before, words, printed = command
        works(shell(f"{before}{words} 2>/dev/full"), printed)

    @linux
    def test_it_is_told_of_help_and_of_wrong_words_too(self, shell):
        done = shell(f"{CRAMHY} --help >/dev/full")
        assert (done.returncode, done.stderr) == (1, FULL)

    @pytest.mark.soak
    @linux
    def test_a_plan_whose_output_is_lost_still_cleans_up(self, shell, tmp_path, backend):
        """The cleanup forms print, too; none of them is broken off by that."""
        (tmp_path / "plan.lisp").write_text("""(in-package :cram-user)
            (top-level (unwind-protect
                (loop (print 1) (finish-output) (sleep 1))
              (print 'stopping) (finish-output)
              (with-open-file (file "cleaned" :direction :output) (print 'stopped file))))
            (with-open-file (file "went-on" :direction :output) (print 'never file))""")
        done = shell(f"{CRAMHY} run plan.lisp --time virtual --backend {backend} >/dev/full")
        assert (done.returncode, done.stderr) == (1, FULL)
        assert (tmp_path / "cleaned").exists() and not (tmp_path / "went-on").exists()

    @pytest.mark.soak
    @linux
    @pytest.mark.parametrize("time", ["virtual", "wall"])
    def test_the_branches_beside_it_are_ended_through_their_cleanup(self, shell, tmp_path, backend, time):
        branch = '(unwind-protect {0} (with-open-file (file "{1}" :direction :output) (print 1 file)))'
        prints, sleeps = branch.format("(loop (print 1) (finish-output) (sleep 0.1))", "one"), branch.format("(sleep 1000)", "other")
        (tmp_path / "plan.lisp").write_text(f"(in-package :cram-user)\n(top-level (par {prints} {sleeps}))")
        done = shell(f"{CRAMHY} run plan.lisp --time {time} --backend {backend} >/dev/full")
        assert (done.returncode, done.stderr) == (1, FULL)
        assert (tmp_path / "one").exists() and (tmp_path / "other").exists()

    @pytest.mark.soak
    @linux
    def test_lost_output_is_no_error_that_a_plan_handles(self, shell, tmp_path):
        (tmp_path / "stubborn.lisp").write_text("(loop (ignore-errors (print 1) (finish-output)))")
        done = shell(f"{CRAMHY} run stubborn.lisp --time virtual >/dev/full")
        assert (done.returncode, done.stderr) == (1, FULL)

    @pytest.mark.soak
    def test_a_reader_that_has_read_enough_ends_it_without_a_word(self, shell):
        for line in ("yes '(print 1)' | %s repl", """yes '{"form": "1"}' | %s eval""", "%s ros rosmsg list"):
            done = shell(f"{line % CRAMHY} | head -n 1; echo ${{PIPESTATUS[@]}} >&2")
            assert done.stdout.count("\n") == 1 and "cramhy" not in done.stderr, done

    @pytest.mark.soak
    def test_the_simulator_needs_no_streams(self, shell):
        done = shell(f"timeout --preserve-status --signal=INT 5 {CRAMHY} turtlesim <&- >&- 2>&-")
        assert done.returncode in (0, 130), done  # it was ended by the signal and by nothing else

    @pytest.mark.soak
    def test_output_that_does_not_wait_is_waited_for(self, shell, tmp_path):
        """A pipe that another program has made one that does not wait, with a slow reader: every line arrives."""
        (tmp_path / "long.lisp").write_text("(dotimes (i 20000) (print i))")
        (tmp_path / "starts.py").write_text(
            "import os, subprocess, sys, time\n"
            "read, write = os.pipe(); os.set_blocking(write, False)\n"
            "child = subprocess.Popen(sys.argv[1:], stdout=write); os.close(write); time.sleep(1)\n"
            "data = open(read).read(); print(len(data.split()), child.wait())\n"
        )
        done = shell(f"{shlex.quote(sys.executable)} starts.py {CRAMHY} run long.lisp --time virtual")
        assert (done.stdout, done.stderr) == ("20000 0\n", "")


class TestSigns:
    """The forms print u with two dots, which Latin-1 has, and an arrow, which only Unicode has."""

    FORM = '(format t "gr~an ~a~%" (code-char 252) (code-char 8594))'
    SHOWN = {"ascii": b"gr\\xfcn \\u2192\n", "latin-1": b"gr\xfcn \\u2192\n", "utf-8": "grün →\n".encode()}

    @pytest.mark.soak
    @pytest.mark.parametrize(
        "encoding, variables",
        [
            ("ascii", {"PYTHONIOENCODING": "ascii"}),
            ("latin-1", {"PYTHONIOENCODING": "latin-1"}),
            ("ascii", {"LC_ALL": "POSIX", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}),
            ("utf-8", {"LC_ALL": "POSIX"}),
            ("utf-8", {"LC_ALL": None, "LANG": "C"}),
            ("utf-8", {"PYTHONIOENCODING": "utf-8:strict"}),
        ],
    )
    def test_signs_that_the_terminal_lacks_are_escaped(self, shell, tmp_path, encoding, variables):
        (tmp_path / "signs.lisp").write_text(self.FORM)
        done = shell(f"{CRAMHY} run signs.lisp --time virtual", text=False, **variables)
        assert (done.returncode, done.stdout, done.stderr) == (0, self.SHOWN[encoding], b"")
        done = shell(f"echo '{self.FORM}' | {CRAMHY} repl", text=False, **variables)
        assert done.returncode == 0 and done.stdout == b"CL-USER> " + self.SHOWN[encoding] + b"NIL\nCL-USER> " and not done.stderr

    @pytest.mark.soak
    def test_answers_as_json_are_the_same_in_every_encoding(self, shell):
        answers = {
            shell(f"echo '{json.dumps({'form': self.FORM})}' | {CRAMHY} eval", PYTHONIOENCODING=encoding).stdout
            for encoding in ("ascii", "latin-1", "utf-8")
        }
        assert [json.loads(answer)["output"] for answer in answers] == ["grün →\n"]

    @pytest.mark.parametrize("variables", [{}, {"LC_ALL": "POSIX"}])
    def test_bytes_that_are_no_text_are_read_and_written_as_they_are(self, shell, variables):
        done = shell("printf '(princ \"\\xff\")\\n' | " + f"{CRAMHY} repl", text=False, **variables)
        assert (done.returncode, done.stderr) == (0, b"") and done.stdout == b'CL-USER> \xff\n"\xff"\nCL-USER> '


class TestFolders:
    @pytest.mark.soak(all_but=3)
    def test_a_folder_that_was_removed(self, shell, command, tmp_path):
        before, words, printed = command
        (tmp_path / "gone").mkdir()
        done = shell(f"rmdir ../gone; {before}{words}", folder=tmp_path / "gone")
        needs = any(f" {word} " in words + " " for word in ("repl", "eval", "run", "test"))
        if "rospack" in words:
            assert (done.returncode, done.stdout, done.stderr) == (1, "", NO_FOLDER.replace("cramhy", "rospack", 1))
        elif needs:
            assert (done.returncode, done.stdout, done.stderr) == (2, "", NO_FOLDER)
        else:
            works(done, printed)

    @pytest.mark.soak(all_but=1)
    @linux  # other systems refuse such names
    def test_names_that_are_no_utf_8(self, shell, command, tmp_path):
        before, words, printed = command
        folder = os.fsencode(tmp_path) + b"/n\xff\xfe"
        os.mkdir(folder)
        for name in ("good.lisp", "tests.lisp"):
            shutil.copy(tmp_path / name, folder + b"/" + name.encode())
        for _ in range(2):  # the second time with the code that was kept
            works(shell(before + words, folder=folder), printed)

    @pytest.mark.soak
    @linux
    def test_a_file_with_such_a_name(self, shell, tmp_path):
        name = os.fsencode(tmp_path) + b"/b\xff.lisp"
        Path(os.fsdecode(name)).write_text("(print 1)\n(car 5)")
        done = shell(f"{CRAMHY} run $'b\\xff.lisp' --time virtual", text=False)
        assert done.returncode == 1 and done.stdout == b"\n1 \n" and b"Traceback" not in done.stderr
        assert b"LIST\n  at b\\udcff.lisp:2:1\n" in done.stderr or b"b\xff.lisp:2:1\n" in done.stderr
        done = shell(f"{CRAMHY} run $'c\\xff.lisp' --time virtual", text=False)
        assert done.returncode == 1 and b"No such file or directory." in done.stderr and b"Traceback" not in done.stderr
        done = shell(f"echo '(+ 1 2)' | {CRAMHY} repl --record $'r\\xff.mcap' --time virtual", text=False)
        assert (done.returncode, done.stderr) == (0, b"") and os.path.getsize(os.fsencode(tmp_path) + b"/r\xff.mcap") > 100

    @pytest.mark.soak(all_but=2)
    @pytest.mark.parametrize("home", [None, "/nonexistent", "/proc"])
    def test_a_home_is_not_needed(self, shell, command, home):
        before, words, printed = command
        works(shell(before + words, HOME=home, XDG_CACHE_HOME=None), printed)


class TestPython:
    @pytest.mark.soak(all_but=4)
    @pytest.mark.parametrize(
        "variables",
        [{"PYTHONOPTIMIZE": "2"}, {"PYTHONHASHSEED": "77"}, {"PYTHONUNBUFFERED": "1"}, {"PYTHONDEVMODE": "1", "PYTHONWARNINGS": "error"}],
    )
    def test_its_variables_change_nothing(self, shell, command, variables):
        before, words, printed = command
        works(shell(before + words, **variables), printed)

    @pytest.mark.soak(all_but=2)
    def test_a_safe_path(self, shell, command):
        before, words, printed = command
        works(shell(before + words, PYTHONSAFEPATH="1"), printed)

    @pytest.mark.soak
    def test_without_greenlet_its_back_end_is_refused(self, shell):
        hidden = "import sys; sys.modules['greenlet'] = None; from cramhy_runtime.cli import main; sys.exit(main(sys.argv[1:]))"
        asked = "from cramhy_runtime.extras import install_command; print(install_command('fast'))"
        wanted = shell(f'{shlex.quote(sys.executable)} -c "{asked}"').stdout  # which pip there is depends on the shell
        for words in ("repl", "eval", "run good.lisp", "test tests.lisp"):
            done = shell(f'{shlex.quote(sys.executable)} -c "{hidden}" {words} --backend greenlet < /dev/null')
            assert (done.returncode, done.stdout) == (2, "")
            assert done.stderr == f"cramhy: --backend greenlet needs greenlet, and greenlet is not installed. Type: {wanted}"


class TestTerminals:
    @pytest.mark.soak
    @pytest.mark.parametrize(
        "variables",
        [
            {"TERM": "dumb"},
            {"TERM": None},
            {"TERM": "no-such-terminal"},
            {"COLUMNS": "0"},
            {"COLUMNS": "1", "LINES": "1"},
            {"COLUMNS": "many"},
        ],
    )
    @pytest.mark.parametrize("editor", [False, True])
    def test_any_terminal_will_do(self, variables, editor):
        if editor:
            pytest.importorskip("prompt_toolkit")
        with Terminal("repl", editor=editor, variables=variables) as terminal:
            terminal.expect("CL-USER>")
            terminal.type("(list 'a (+ 1 2))")
            terminal.expect(r"\(A 3\)")
            terminal.expect("CL-USER>")
            terminal.type("(exit)")  # Ctrl-D would be lost while prompt_toolkit prepares a dumb terminal
            assert terminal.status() == 0
        assert "Traceback" not in terminal.text

    @pytest.mark.soak
    @pytest.mark.parametrize("size", [(1, 1), (0, 0), (24, 1), (24, 5)])
    def test_a_terminal_of_any_size(self, size):
        with Terminal("repl", size=size) as terminal:
            terminal.expect("CL-USER> ")
            terminal.type('(progn (print "a long line of text, far longer than the terminal is wide") (car 5))')
            terminal.expect("0] ")
            terminal.type("abort")
            terminal.expect("CL-USER> ")
            assert terminal.end() == 0
        assert "Traceback" not in terminal.text


class TestHeap:
    LINE = f"{shlex.quote(sys.executable)} -c 'from cramhy_runtime.cli import heap; print(heap.keep_small())'"

    @linux
    def test_it_is_set_up_unless_the_user_did(self, shell):
        libc = os.confstr("CS_GNU_LIBC_VERSION") if "CS_GNU_LIBC_VERSION" in os.confstr_names else None
        if not libc:
            pytest.skip("another C library")
        assert shell(self.LINE).stdout == "True\n"
        assert shell(self.LINE, MALLOC_ARENA_MAX="4").stdout == "False\n"

    def test_where_it_cannot_be_nothing_happens(self, monkeypatch):
        from cramhy_runtime.cli import heap

        monkeypatch.setattr(sys, "platform", "win32")
        assert heap.keep_small() is False
        monkeypatch.setattr(sys, "platform", "linux")
        monkeypatch.setitem(sys.modules, "ctypes", None)
        assert heap.keep_small() is False


@linux
class TestLimits:
    @pytest.mark.soak
    @pytest.mark.parametrize("kilobytes", [25_000, 32_000, 45_000, 60_000, 100_000, 300_000])
    @pytest.mark.parametrize("options", ["", "--serve"])
    def test_little_memory(self, shell, kilobytes, options):
        """How much a Python takes depends on its version, so the line is one of those that may come.

        It is looked for among what Python prints itself, now and then, when it has no memory for an object that it clears away:
        "MemoryError:", "Exception ignored in", "lost sys.stderr", "object address". No program can keep Python from that.
        """
        if options:
            pytest.importorskip("uvicorn")
        python = shell(f"ulimit -v {kilobytes}; {shlex.quote(sys.executable)} -c 'import json, asyncio, hashlib' 2>/dev/null")
        if python.returncode:
            pytest.skip("Python itself does not start with so little")
        line = f"ulimit -v {kilobytes}; ulimit -t 12; echo '(+ 1 2)' | {CRAMHY} repl --time virtual {options}"
        done = shell(line, text=False)
        output, errors = done.stdout.decode(), done.stderr.decode()
        if "ERROR:root:code for hash" in errors:
            pytest.skip("Python's own hashlib runs out of memory while it is imported, and prints that itself")
        if done.returncode in (128 + signal.SIGXCPU, 128 + signal.SIGKILL):
            pytest.skip("Python's importer goes round in a circle without memory, once in a hundred times")
        if done.returncode in (128 + signal.SIGSEGV, 128 + signal.SIGABRT):
            pytest.skip("Python itself breaks down without memory, once in a hundred times")
        if done.returncode == 0:  # where memory ends while a form is evaluated, the debugger says so
            assert output == "CL-USER> 3\nCL-USER> " or "memory" in output
        else:
            assert done.returncode == 1, done
            assert any("cramhy: " in line and "memory" in line for line in errors.splitlines()), done

    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize("files", [6, 8, 10, 16])
    @pytest.mark.parametrize("options", ["", "--serve"])
    def test_few_files(self, shell, files, options):
        if options:
            pytest.importorskip("uvicorn")
        done = shell(f"ulimit -n {files}; echo '(+ 1 2)' | {CRAMHY} repl --time virtual {options}", text=False)
        if done.returncode == 0:
            assert done.stdout == b"CL-USER> 3\nCL-USER> "
        else:
            assert NO_FILES.encode() in done.stderr or b"Too many open files" in done.stderr
            assert options and b"cramhy: " in done.stderr

    @pytest.mark.soak
    @pytest.mark.parametrize("kilobytes", [256, 1024])
    def test_a_small_stack(self, shell, kilobytes):
        works(shell(f"ulimit -s {kilobytes}; echo '(+ 1 2)' | {CRAMHY} repl"), "CL-USER> 3\nCL-USER> ")

    @pytest.mark.soak
    def test_few_processes(self, shell, tmp_path):
        """Root may have as many as it likes, so this is another user's program, who may read everything as root does."""
        if os.geteuid() != 0 or shutil.which("setpriv") is None:
            pytest.skip("only root can become another user, by setpriv")
        pytest.importorskip("uvicorn")
        (tmp_path / "other").mkdir()
        (tmp_path / "other").chmod(0o777)
        other = "setpriv --reuid=65534 --regid=65534 --clear-groups --inh-caps=+dac_read_search --ambient-caps=+dac_read_search"
        if shell(f"{other} {shlex.quote(sys.executable)} -c pass").returncode:
            pytest.skip("another user may not run this Python")
        line = f"ulimit -u 1; exec {CRAMHY} repl --time virtual --serve"
        done = shell(
            f"echo '(+ 1 2)' | {other} bash -c {shlex.quote(line)}",
            HOME=str(tmp_path),
            XDG_RUNTIME_DIR=None,
            TMPDIR=str(tmp_path / "other"),
        )
        assert (done.returncode, done.stdout, done.stderr) == (1, "", NO_THREADS)
