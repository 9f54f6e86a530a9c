"""Code that is kept follows all that it depends on: the second run answers as a fresh compilation does, and is not compiled for nothing."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from world_cases import CASES

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.systems import loader
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image
from cramhy_runtime.storage import dependencies, dependency_tracing, kept_code

IN_PROCESS = [name for name, case in CASES.items() if case.command.endswith("main.lisp")]
IN_PROCESSES = [name for name in CASES if name not in IN_PROCESS]
NOT_KEPT = {
    "the clock": "it looks at the clock",
    "chance": "it depends on chance",
    "a counter of a macro": "compiling it changes the value of COMMON-LISP-USER::*COUNT*",
    "a list to which macros add": "compiling it changes the value of COMMON-LISP-USER::*ALL*",
    "a file that is loaded while another is compiled": "compiling it changes the value of COMMON-LISP-USER::*PART*",
    "another process": "it starts another process",
    "the clock in a Hy macro": "it looks at the clock",
}


def write(folder, files):
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if text is None:
            path.unlink()
            continue
        path.write_text(text)
        if path.suffix == ".py":  # Python itself looks at the second of the change
            os.utime(path, (1e9 + len(text), 1e9 + len(text)))


def forget(folder):
    for kept in list(folder.rglob("__pycache__")):
        shutil.rmtree(kept)


@pytest.fixture
def said(tmp_path, monkeypatch, capsys):
    """What the program of a case prints, in an image that knows nothing of before."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(dependency_tracing, "_BEGAN", 1 << 62)  # whoever edits a module of tests meanwhile does not matter

    def said(case, cwd="one", variables=()):
        with Image(), monkeypatch.context() as patch:
            (tmp_path / "one").mkdir(exist_ok=True)
            patch.chdir(tmp_path / cwd)
            patch.setattr(sys, "path", list(sys.path))
            patch.delitem(sys.modules, "helper", raising=False)
            for name, value in dict(variables).items():
                patch.setenv(name, value)
            session = Session(time="virtual", turtlesim=False, seed=1)
            session.evaluate_text(f'(load "{tmp_path / "main.lisp"}")')
            sys.modules.pop("helper", None)
            return capsys.readouterr().out

    yield said
    kernel.stop()


def unused(folder):
    """Why the kept code of the last file of a case was not used."""
    return loader.why_not_kept(folder / ("b.lisp" if (folder / "b.lisp").exists() else "main.lisp"))


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", IN_PROCESS)
def test_the_second_run_answers_as_a_fresh_compilation(said, tmp_path, name):
    case = CASES[name]
    write(tmp_path, case.files)
    there = "two" if case.cwd == "two" else "one"
    first = said(case)
    again = said(case)
    if name in NOT_KEPT:
        file = tmp_path / "main.lisp"
        assert kept_code.not_kept(file).reason == NOT_KEPT[name]
    else:
        assert (again, unused(tmp_path)) == (first, None), "it is compiled again though nothing has changed"
    write(tmp_path, case.change)
    second = said(case, there, case.variables)
    forget(tmp_path)
    fresh = said(case, there, case.variables)
    if case.moves:
        assert second != first != fresh
    else:
        assert second == fresh
        assert name in NOT_KEPT or first != fresh, "the case shows nothing"


@pytest.mark.soak
@pytest.mark.parametrize("name", IN_PROCESSES)
def test_the_second_process_answers_as_a_fresh_compilation(tmp_path, name):
    case = CASES[name]
    write(tmp_path, case.files)

    def said(variables=()):
        word, *words = case.command.split()
        bin_ = Path(sys.executable).parent
        argv = {"run": [bin_ / "cramhy", "run"], "test": [bin_ / "cramhy", "test"], "hy": [bin_ / "hy"], "python": [sys.executable]}
        argv["pytest"] = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
        variables = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"} | dict(variables)
        done = subprocess.run([*map(str, argv[word]), *words], cwd=tmp_path, env=variables, capture_output=True, text=True, timeout=100)
        return re.sub(r"in [0-9.]+ ?s", "", done.stdout)

    first = said()
    write(tmp_path, case.change)
    second = said(case.variables)
    forget(tmp_path)
    fresh = said(case.variables)
    assert first != second and second
    assert case.moves or second == fresh


REASONS = {
    "(get-universal-time)": "it looks at the clock",
    "(nth-value 5 (get-decoded-time))": "it looks at the clock",
    "(get-internal-run-time)": "it looks at the clock",
    '(py:call "time.monotonic")': "it looks at the clock",
    "(random 10)": "it depends on chance",
    "(progn (princ-to-string *random-state*) 1)": "it depends on chance",
    '(py:call "os.getpid")': "it looks at the process or the machine",
    "(progn (gentemp) 1)": "it depends on how many symbols were made before",
    "*gensym-counter*": "it depends on how many symbols were made before",
    "(length (push 1 (get 'f :seen)))": "compiling it changes the properties of COMMON-LISP-USER::F",
    '(with-open-file (s "/dev/zero" :element-type \'(unsigned-byte 8)) (read-byte s))': "/dev/zero is not a file that keeps what is in it",
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("asks", REASONS)
@pytest.mark.parametrize("way", ["(m)", "#.(ask)"], ids=["macro", "reader"])
def test_what_cannot_be_compared_is_compiled_each_time_and_load_says_why(said, tmp_path, capsys, asks, way):
    place, text = tmp_path / "x.lisp", f"(defun ask () {asks})\n(defmacro m () (ask))\n\n  (defun f () {way})\n"
    place.write_text(text)
    with Image():
        session = Session(time="virtual", turtlesim=False, seed=1)
        for _ in range(2):
            session.evaluate_text(f'(load "{place}" :verbose t)')
            lines = capsys.readouterr().out.splitlines()
            line = f";; {place} is compiled anew each time: {REASONS[asks]} (line 4, column "
            assert lines[-1].startswith(line), lines


def test_two_changes_of_a_file_in_one_instant_are_told_apart(tmp_path):
    path = tmp_path / "d.txt"
    path.write_text("11")
    question = {("file", str(path)): dependencies.KINDS["file"].now(str(path))}
    state, status = dependencies.file_state(path), path.stat()
    assert dependencies.holds(question) and dependencies.unchanged(path, state)
    with path.open("r+") as file:
        file.write("22")
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
    assert not dependencies.holds(question) and not dependencies.unchanged(path, state)


def test_an_old_file_is_not_read_again(tmp_path, monkeypatch):
    path = tmp_path / "d.txt"
    path.write_text("11")
    os.utime(path, (1e9, 1e9))
    question, state = {("file", str(path)): dependencies.KINDS["file"].now(str(path))}, dependencies.file_state(path)
    monkeypatch.setattr("builtins.open", None)
    assert dependencies.holds(question) and dependencies.unchanged(path, state)


def test_a_local_macro_asks_nothing_so_that_the_course_loads_as_quickly_as_before(said, tmp_path):
    path, text = tmp_path / "main.lisp", "(defun f () (macrolet ((two (x) `(list ,x 2))) (two 1)))\n(print (f))\n"
    write(tmp_path, {"main.lisp": text})
    assert said(CASES["the clock"]) == "\n(1 2) "
    with Image():
        Session(time="virtual", turtlesim=False)
        forms = loader._kept(path, loader._fingerprint(path, text, "source "), str(path))
    assert [loader._KeptForm(*form).facts for form in forms] == [{}, {}]
