"""Attacks on the grader: no submission sees another one, reaches the machine, outlives its end or costs anybody else something."""

from __future__ import annotations

import os
import secrets
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from systems import linux

import cramhy_runtime
from cramhy_runtime.cli import grading_commands
from cramhy_runtime.cli.options import parser
from cramhy_runtime.grading import ExerciseError, Grader, Report, grader, messages
from cramhy_runtime.grading.exercise import Exercise, own_exercises
from cramhy_runtime.grading.processes import ForkServer
from cramhy_runtime.grading.sandbox import bubblewrap, folders, removal

from . import attacks

pytestmark = linux

SANDBOXES = ["bubblewrap", "locks"]
EXERCISE = """
title = "An attack"
submission = ["attack.py"]
before = []
{more}
[limits]
time = {seconds}
memory = 400

[[check]]
title = "This cannot pass, so the report has the output"
ask = [["(+ 1 1)", "{answer}"]]
hint = "{answer}"
"""
ANSWER = "answer" + secrets.token_hex(8)
SECRET = "secret" + secrets.token_hex(8)


@pytest.fixture(scope="module", params=SANDBOXES)
def sandbox(request):
    """The name of the sandbox, where the system has it."""
    why_not = bubblewrap.why_not() if request.param == "bubblewrap" else None
    if why_not is not None:
        pytest.skip(why_not)
    return request.param


class Place:
    """Where attacks happen: a grader with a folder for temporary files, and an exercise."""

    def __init__(self, folder, sandbox):
        self.folder, self.sandbox = folder, sandbox
        self.temporary = folder / "temporary"
        self.temporary.mkdir()
        self.exercise = exercise(folder / "exercise")
        self.outside = folder / "outside"
        self.outside.mkdir()
        (self.outside / "of-others").write_text(ANSWER)
        self.grader = Grader(sandbox=sandbox, as_root=True, at_once=1)

    def attack(self, name, **values):
        """The report of an attack, which has not escaped and has left nothing."""
        mark = "m" + secrets.token_hex(5)
        report = self.grader.grade_texts(self.exercise, {"attack.py": attacks.text(name, MARK=mark, **values)})
        assert report.points == 0
        assert "ESCAPED" not in report.output, report.output
        assert processes_named(mark) == []
        assert [path.name for server in self.temporary.glob("cramhy-*") for path in server.iterdir()] == []
        assert (self.outside / "of-others").read_text() == ANSWER and len(list(self.outside.iterdir())) == 1
        assert self.outside.stat().st_mode & 0o777 == 0o755
        assert ("bubblewrap" in report.held) == (self.sandbox == "bubblewrap")
        assert {"files", "network", "processes", "signals", "time", "memory"} <= set(report.held)
        return report


def exercise(folder, seconds=3, more=""):
    folder.mkdir(parents=True)
    (folder / "exercise.toml").write_text(EXERCISE.format(answer=ANSWER, seconds=seconds, more=more))
    return Exercise.read(folder)


def processes_named(mark):
    """The numbers of the processes that have given themselves a name."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            if mark in (place / "comm").read_text() or mark.encode() in (place / "cmdline").read_bytes():
                found.append(int(place.name))
        except OSError:
            continue
    return found


@pytest.fixture(scope="module")
def place(sandbox, tmp_path_factory):
    folder = tmp_path_factory.mktemp(f"in-{sandbox}")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMPDIR", str(folder / "temporary"))
        patch.setattr("tempfile.tempdir", None)
        patch.setenv("SECRET_OF_THE_GRADER", SECRET)
        made = Place(folder, sandbox)
        with made.grader:
            yield made
        assert list(made.temporary.iterdir()) == []


# ------------------------------------------------------------------------------------------------------------------ what is seen


@pytest.mark.soak
def test_a_submission_finds_nothing_of_others_in_its_memory(place):
    mark = "mark" + secrets.token_hex(8)
    other = place.grader.grade_texts(place.exercise, {"attack.py": f"print('{mark}')\nkept = '{mark}' * 10"})
    assert mark in other.output
    reversed_ones = {"MARK": mark[::-1], "ANSWER": ANSWER[::-1], "SECRET": SECRET[::-1]}
    text = attacks.text("reads_memory", **reversed_ones)
    report = place.grader.grade_texts(place.exercise, {"attack.py": text})
    assert "looked at True True" in report.output, report.text()  # it finds what is there
    assert "ESCAPED" not in report.output


@pytest.mark.soak
def test_a_submission_reads_no_file_of_others(place):
    mark = "mark" + secrets.token_hex(8)
    submitted = place.folder / "submitted"
    submitted.mkdir()
    (submitted / "attack.py").write_text(f"# {mark}")
    place.grader.grade(place.exercise, submitted)
    given = [submitted / "attack.py", place.exercise.folder / "exercise.toml", place.outside / "of-others", "/proc/self/cgroup"]
    given += [path for folder in own_exercises().values() for path in folder.rglob("*") if path.is_file()]
    assert len(given) > 30
    words = {"MARK": mark[::-1], "ANSWER": ANSWER[::-1], "SECRET": SECRET[::-1]}
    own = Path(cramhy_runtime.__file__).parent
    roots = [str(place.folder), str(own / "grading"), str(own / "lisp_core")]
    text = attacks.text("reads_files", PLACES=", ".join(repr(str(path)) for path in given), ROOTS=repr(roots), **words)
    report = place.grader.grade_texts(place.exercise, {"attack.py": text})
    assert "looked at True" in report.output, report.text()
    assert "ESCAPED" not in report.output, report.output


@pytest.mark.soak
def test_an_exercise_that_lies_where_modules_are_is_out_of_sight(sandbox, tmp_path, monkeypatch):
    """As in an installed wheel, where exercises lie in a package."""
    package = tmp_path / "site-packages" / "a_course"
    made = exercise(package / "exercises" / "attack")
    (package / "__init__.py").write_text("")
    (package / "part.py").write_text("NUMBER = 4711")
    monkeypatch.setattr(folders, "packages", lambda kept=folders.packages: [*kept(), str(package)])
    words = {"MARK": SECRET[::-1], "ANSWER": ANSWER[::-1], "SECRET": SECRET[::-1]}
    text = attacks.text("reads_files", PLACES=repr(str(made.folder / "exercise.toml")), ROOTS=repr([str(package.parent)]), **words)
    with Grader(sandbox=sandbox, as_root=True) as grader:  # the watcher is another process: PYTHONPATH tells it where the package is
        report = grader.grade_texts(made, {"attack.py": f"from a_course.part import NUMBER\nprint(NUMBER)\n{text}"})
    assert "4711" in report.output and "ESCAPED" not in report.output, report.text()


@pytest.mark.parametrize("hidden", [[], ["/usr/lib/a"], ["/usr/lib/a", "/usr/lib/a/b", "/nowhere"]])
def test_what_is_hidden_is_hidden_once(hidden, tmp_path, monkeypatch):
    shown = tmp_path / "lib"
    (shown / "a" / "b").mkdir(parents=True)
    monkeypatch.setattr(folders, "readable", lambda: [str(shown)])
    monkeypatch.setattr(folders, "exercises", lambda: [])
    words = bubblewrap.arguments("/bin/cat", [each.replace("/usr/lib", str(shown)) for each in hidden])
    assert words.count("--tmpfs") == bool(hidden)


# ---------------------------------------------------------------------------------------------------------------- what is done


def test_a_submission_reaches_no_other_process_and_no_network(place):
    sleeper = subprocess.Popen(["sleep", "100"])
    try:
        server = next(iter(place.grader.fork_servers.values()), None)
        numbers = [sleeper.pid, os.getpid(), *([server.process.pid] if server is not None and server.process is not None else [])]
        before = os.getpriority(os.PRIO_PROCESS, sleeper.pid), os.sched_getaffinity(sleeper.pid)
        report = place.attack("reaches_others", PROCESSES=", ".join(map(str, numbers)), ALL=True)
        assert "went on" in report.output, report.text()
        assert sleeper.poll() is None
        assert (os.getpriority(os.PRIO_PROCESS, sleeper.pid), os.sched_getaffinity(sleeper.pid)) == before
    finally:
        sleeper.kill()
        sleeper.wait()


def test_a_submission_starts_no_process_that_stays(place):
    report = place.attack("starts_processes", STAYS=0)
    assert "went on" in report.output, report.text()


FILLINGS = {
    "unreadable, links, long_names": "went on",
    "deep": "",
    "many": "",
    "unlinked": "",
    "memory_file, shared_memory, limits": "went on",
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("which", FILLINGS, ids=lambda which: which.replace(", ", " "))
def test_a_submission_leaves_no_folder_and_no_megabyte(place, which):
    free = os.statvfs(place.temporary)
    begun = time.monotonic()
    report = place.attack("fills_folders", WHICH=which, OUTSIDE=place.outside, OWN_MEMORY=place.sandbox == "bubblewrap")
    assert time.monotonic() - begun < 60
    assert FILLINGS[which] in report.output or "wrote too many files" in report.text(), report.text()
    after = os.statvfs(place.temporary)
    assert free.f_files - after.f_files < 1000 and (free.f_bfree - after.f_bfree) * free.f_bsize < 500_000_000


TAKING = {
    "threads": ("started too many threads", "used more than"),
    "after_the_main_thread": ("used more than 400 MB",),
    "deaf": ("ended the process before it was over", "signal (kill)"),
    "stopped": ("waited for something",),
    "busy_threads": ("s of processor time",),
}
SHORT = ("threads", "after_the_main_thread", "deaf")


@pytest.mark.soak
@pytest.mark.parametrize("which", [each if each in SHORT else pytest.param(each, marks=pytest.mark.soak) for each in TAKING])
def test_a_submission_takes_no_more_than_it_may_wherever_it_takes_it(place, which):
    report = place.attack("takes_much", WHICH=which)
    assert any(words in report.text() for words in TAKING[which]), report.text()


def test_the_grader_goes_on_after_each_attack(place):
    report = place.grader.grade_texts(place.exercise, {"attack.py": "print('still here')"})
    assert "still here" in report.output


# --------------------------------------------------------------------------------------------------------- the end of the grader

GRADING = """
import sys
from cramhy_runtime.grading import Grader
from cramhy_runtime.grading.exercise import Exercise, own_exercises
with Grader(sandbox=sys.argv[1], as_root=True) as grader:
    grader.grade(Exercise.read(sys.argv[2]), sys.argv[3])
"""
ENDS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]


def session_of(leader):
    """The numbers of the processes whose session, or that of a parent, is that of the children of ``leader``."""
    parents = {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            parents[int(place.name)] = int((place / "stat").read_text().rpartition(")")[2].split()[1])
        except OSError:
            continue
    found, before = {leader}, set()
    while found != before:
        before = found
        found = found | {each for each, parent in parents.items() if parent in found}
    return found - {leader}


@pytest.mark.soak
@pytest.mark.parametrize("end", [each if each == signal.SIGKILL else pytest.param(each, marks=pytest.mark.soak) for each in ENDS])
@pytest.mark.parametrize("stays", [1, pytest.param(2, marks=pytest.mark.soak)], ids=["sleeping", "awake"])
def test_nothing_is_left_when_the_grader_is_ended(sandbox, tmp_path, end, stays):
    mark = "m" + secrets.token_hex(5)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    (tmp_path / "attack.py").write_text(attacks.text("starts_processes", MARK=mark, STAYS=stays))
    exercise(tmp_path / "exercise")
    words = [sys.executable, "-c", GRADING, sandbox, str(tmp_path / "exercise"), str(tmp_path / "attack.py")]
    grading = subprocess.Popen(words, env={**os.environ, "TMPDIR": str(temporary)}, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    try:
        assert soon(lambda: processes_named(mark))
        everything = session_of(grading.pid)
        assert len(everything) >= 4
        grading.send_signal(end)
        grading.wait(30)
        assert soon(lambda: not any(Path(f"/proc/{number}").exists() for number in everything))
        assert processes_named(mark) == []
        assert soon(lambda: not list(temporary.iterdir()))
    finally:
        grading.kill()
        grading.wait()


@pytest.mark.soak
@pytest.mark.parametrize("whom", ["watcher", "fork server"])
def test_nothing_but_a_folder_is_left_when_a_part_of_the_grader_is_killed(place, tmp_path, whom):
    """As the kernel does it when the machine's memory is over."""
    mark = "m" + secrets.token_hex(5)
    (tmp_path / "attack.py").write_text(attacks.text("starts_processes", MARK=mark, STAYS=1))
    exercise(tmp_path / "exercise")
    words = [sys.executable, "-c", GRADING, place.sandbox, str(tmp_path / "exercise"), str(tmp_path / "attack.py")]
    grading = subprocess.Popen(words, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    try:
        assert soon(lambda: processes_named(mark))
        everything = session_of(grading.pid)
        victim = next(each for each in everything if f"grading.{whom.replace(' ', '_')}" in command_of(each))
        os.kill(victim, signal.SIGKILL)
        grading.wait(60)
        assert soon(lambda: not any(Path(f"/proc/{number}").exists() for number in everything))
        assert processes_named(mark) == []
    finally:
        grading.kill()
        grading.wait()


def command_of(process):
    try:
        return Path(f"/proc/{process}/cmdline").read_text()
    except OSError:
        return ""


def soon(is_so, seconds=60.0):
    """Whether something is so within a time that no busy machine needs."""
    latest = time.monotonic() + seconds
    while not (found := is_so()) and time.monotonic() < latest:
        time.sleep(0.02)
    return bool(found)


# ------------------------------------------------------------------------------------------------------------ which sandbox, who


def test_root_is_refused_unless_he_means_it(monkeypatch, tmp_path):
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.delenv("CRAMHY_AS_ROOT", raising=False)
    with pytest.raises(ExerciseError) as problem:
        Grader()
    assert str(problem.value) == (
        "You are root, so a gap in the sandbox would give this machine to whoever hands in. Grade as another user. If this is a container "
        "that has nothing else in it, say --as-root, Grader(as_root=True) or CRAMHY_AS_ROOT=yes."
    )
    Grader(apart=False)
    Grader(as_root=True)
    monkeypatch.setenv("CRAMHY_AS_ROOT", "yes")
    Grader()
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    monkeypatch.delenv("CRAMHY_AS_ROOT")
    Grader()


def test_where_bubblewrap_is_not_installed_it_is_said_and_the_locks_hold(monkeypatch):
    monkeypatch.setattr(bubblewrap, "WHERE", "/nowhere")
    assert bubblewrap.why_not() == ("bubblewrap is not installed. Debian, Ubuntu, Fedora and Arch have it as the package bubblewrap.")


def test_where_bubblewrap_is_forbidden_it_is_said_why(monkeypatch, tmp_path):
    program = tmp_path / "bwrap"
    program.write_text("#!/bin/sh\necho 'bwrap: No permissions to create new namespace' >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(bubblewrap, "WHERE", f"{tmp_path}:/usr/bin:/bin")
    assert bubblewrap.why_not() == "bubblewrap does not work here: bwrap: No permissions to create new namespace."


def test_who_wants_bubblewrap_gets_no_points_without_it(monkeypatch, tmp_path):
    server = ForkServer(["lisp-unit"], "bubblewrap")
    monkeypatch.setattr(server, "_received", lambda: {"bubblewrap": "bubblewrap does not work here: bwrap: No permissions."})
    server.ask({"wall": 1})
    with pytest.raises(ExerciseError) as problem:
        server.take()
    assert str(problem.value) == "Submissions shall run in bubblewrap, and cannot: bubblewrap does not work here: bwrap: No permissions."
    assert server.process is None


def options(*words):
    return parser().parse_args(["grade", "square", "square.lisp", *words])


def test_the_command_says_why_it_grades_nothing_or_not_in_bubblewrap(monkeypatch, capsys):
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.delenv("CRAMHY_AS_ROOT", raising=False)
    assert grading_commands.grade(options()) == 2
    assert capsys.readouterr().err == f"cramhy: {grader.AS_ROOT}\n"
    held = ["time", "memory", "file size", "files", "network", "processes", "signals"]
    asked = []
    monkeypatch.setattr(grader, "grade", lambda *words: asked.append(words) or Report("A square", [], "", held))
    monkeypatch.setattr(bubblewrap, "why_not", lambda: "bubblewrap is not installed.")
    assert grading_commands.grade(options("--as-root", "--seeds", "2")) == 0
    assert capsys.readouterr().err == "cramhy: the submission ran behind cramhy's own locks. bubblewrap is not installed.\n"
    assert grading_commands.grade(options("--sandbox", "locks")) == 0
    assert capsys.readouterr().err == ""
    held[3:] = ["bubblewrap"]
    assert grading_commands.grade(options()) == 0
    missing = "files, network, processes, signals"
    assert capsys.readouterr().err == f"cramhy: this system has no lock for {missing}. docs/how-to/grading.md says what that means.\n"
    assert asked == [
        ("square", "square.lisp", 2, None, True),
        ("square", "square.lisp", None, "locks", False),
        ("square", "square.lisp", None, None, False),
    ]


# ------------------------------------------------------------------------------------------------------------------- the parts


@pytest.mark.soak
def test_a_folder_is_removed_whatever_is_in_it(tmp_path):
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "file").write_text("stays")
    folder = tmp_path / "folder"
    folder.mkdir()
    text = attacks.text("fills_folders", WHICH="unreadable, links, long_names, deep", OUTSIDE=outside, OWN_MEMORY=True)
    text = text.replace("4000", "1100")  # deeper than functions may call each other; some file systems take milliseconds for each
    done = subprocess.run([sys.executable, "-c", text], cwd=folder, capture_output=True, text=True)
    assert done.stdout.endswith("went on\n"), done.stderr
    folder.chmod(0o300)
    removal.remove(str(folder))
    assert [path.name for path in tmp_path.iterdir()] == ["outside"] and (outside / "file").read_text() == "stays"
    removal.remove(str(folder))


def test_a_folder_is_over_if_it_has_too_much_or_cannot_be_counted(tmp_path):
    for number in range(3):
        (tmp_path / f"{number}").mkdir()
        (tmp_path / f"{number}" / "file").write_bytes(b"x" * 100)
    os.symlink("/", tmp_path / "link")
    assert not removal.is_over(str(tmp_path), 1000, 7)
    assert removal.is_over(str(tmp_path), 250, 7)
    assert removal.is_over(str(tmp_path), 1000, 6)
    assert not removal.is_over(str(tmp_path / "nothing"), 0, 0)
    place = tmp_path
    for _ in range(removal.DEEPEST + 1):
        place = place / "a"
        place.mkdir()
    assert removal.is_over(str(tmp_path), 10**9, 10**9)


def test_a_message_comes_as_it_was_sent_and_an_end_is_an_end():
    source, sink = os.pipe()
    for message in ({"text": "ä\ud800"}, [], {"long": "x" * 50_000}):
        messages.send(sink, message)
        assert messages.receive(source) == message
    os.write(sink, b"\0\0\0\0\0\0\0\5{}")
    os.close(sink)
    assert messages.receive(source) is None
    os.close(source)
