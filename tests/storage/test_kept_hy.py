"""The code of Hy files in the keeper: it follows what the macros depend on, and nothing that happens to a kept file is worse than no file."""

from __future__ import annotations

import importlib.util
import itertools
import marshal
import os
import shutil
import sys
from pathlib import Path

import pytest
from systems import SOAK
from cramhy_runtime.languages.kept_hy import Loader as HyLoader

from cramhy_runtime.languages import kept_hy
from cramhy_runtime.storage import dependency_tracing, kept_code
from cramhy_runtime.storage.checksummed_code import Unusable
from cramhy_runtime.storage.kept_files import kept_path

_ages = itertools.count(1)
USER = "(require kc_macros [answer])\n(setv found (answer))\n"


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write a file that is older than this process, and younger than those written before."""
    kept_hy.watch()
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(dependency_tracing, "_BEGAN", 1 << 62)  # whoever edits a module of tests meanwhile does not matter
    monkeypatch.syspath_prepend(tmp_path)
    tmp_path.chmod(0o755)

    def write(name, text):
        (tmp_path / name).write_text(text)
        os.utime(tmp_path / name, (1e9 + next(_ages), 1e9))
        age = 1e9 + 10 * next(_ages)
        os.utime(tmp_path / name, (age, age))

    yield write
    forget_modules()


def forget_modules():
    for name in [name for name in sys.modules if name.startswith("kc_")]:
        del sys.modules[name]
    importlib.invalidate_caches()


@pytest.fixture
def compiled(monkeypatch):
    """The names of the files that were compiled."""
    names, compiler = [], HyLoader.source_to_code
    monkeypatch.setattr(
        HyLoader,
        "source_to_code",
        lambda self, data, path, **more: (names.append(os.path.basename(path)), compiler(self, data, path, **more))[1],
        raising=False,
    )
    return names


def found(tmp_path, name="kc_user.hy"):
    """What a Hy file finds, in a process that has imported nothing of it."""
    forget_modules()
    path = tmp_path / name
    namespace = {"__name__": "kc_user", "__file__": str(path)}
    exec(HyLoader("kc_user", str(path)).get_code("kc_user"), namespace)
    return namespace["found"]


def place(tmp_path, name="kc_user.hy"):
    return kept_path(tmp_path / f"{name}.module")


CHANGES = {
    "a macro": ({"kc_macros.hy": "(defmacro answer [] 11)"}, {"kc_macros.hy": "(defmacro answer [] 22)"}),
    "a function that a macro calls": (
        {"kc_macros.hy": "(import kc_helper)\n(defmacro answer [] (kc_helper.answer))", "kc_helper.py": "def answer():\n    return 11\n"},
        {"kc_helper.py": "def answer():\n    return 22\n"},
    ),
    "a constant that a macro has from another module": (
        {"kc_macros.hy": "(import kc_helper [ANSWER])\n(defmacro answer [] ANSWER)", "kc_helper.py": "ANSWER = 11\n"},
        {"kc_helper.py": "ANSWER = 22\n"},
    ),
    "a macro in the expansion of a macro": (
        {
            "kc_macros.hy": "(require kc_more [number])\n(defn count [] (number))\n(defmacro answer [] (count))",
            "kc_more.hy": "(defmacro number [] 11)",
        },
        {"kc_more.hy": "(defmacro number [] 22)"},
    ),
    "a file that a macro reads": (
        {"kc_macros.hy": '(defmacro answer [] (int (.read (open (+ (get (.rpartition __file__ "/") 0) "/d.txt")))))', "d.txt": "11"},
        {"d.txt": "22"},
    ),
    "a file that a module of macros reads when it is imported": (
        {
            "kc_macros.hy": '(setv text (.read (open (+ (get (.rpartition __file__ "/") 0) "/d.txt"))))\n(defmacro answer [] (int text))',
            "d.txt": "11",
        },
        {"d.txt": "22"},
    ),
    "a file that a macro of a macro has read": (
        {
            "kc_macros.hy": "(require kc_more [number])\n(defn count [] (number))\n(defmacro answer [] (count))",
            "kc_more.hy": '(defmacro number [] (int (.read (open (+ (get (.rpartition __file__ "/") 0) "/d.txt")))))',
            "d.txt": "11",
        },
        {"d.txt": "22"},
    ),
}


@pytest.mark.soak
@pytest.mark.parametrize("name", CHANGES)
def test_what_has_changed_is_seen_and_what_has_not_is_not_compiled_again(write, compiled, tmp_path, name):
    files, changed = CHANGES[name]
    for file, text in {"kc_user.hy": USER, **files}.items():
        write(file, text)
    assert found(tmp_path) == 11 and "kc_user.hy" in compiled
    compiled.clear()
    assert found(tmp_path) == 11 and compiled == []
    for file, text in changed.items():
        write(file, text)
    assert found(tmp_path) == 22 and "kc_user.hy" in compiled
    shutil.rmtree(tmp_path / "__pycache__")
    assert found(tmp_path) == 22


REASONS = {
    "(time.time-ns)": "it looks at the clock",
    "(str (datetime.datetime.now))": "it looks at the clock",
    "(random.random)": "it depends on chance",
    "(len (os.urandom 3))": "it depends on chance",
    "(str (uuid.uuid4))": "it depends on chance",
    "(os.getpid)": "it looks at the process or the machine",
    '(subprocess.check-output ["true"])': "it starts another process",
    '(do (setv (get os.environ "KC_TEST") "1") 1)': "compiling it changes the environment",
}


@pytest.mark.soak
@pytest.mark.parametrize("asks", REASONS)
def test_what_cannot_be_compared_is_compiled_each_time_and_the_place_is_told(write, compiled, tmp_path, monkeypatch, asks):
    monkeypatch.setenv("KC_TEST", "0")
    told = []
    kept_code.show_refusals(told.append)
    try:
        write(
            "kc_user.hy",
            f"(import time random os uuid subprocess datetime)\n\n(defmacro m []\n  (import time random os uuid subprocess datetime)\n  {asks})\n(setv found (m))\n",
        )
        for _ in range(2):
            found(tmp_path)
    finally:
        kept_code.show_refusals(None)
    assert compiled == ["kc_user.hy"] * 2
    assert told == [f"{tmp_path / 'kc_user.hy'} is compiled anew each time: {REASONS[asks]} (line 6, column 13)"] * 2


@pytest.mark.soak
def test_a_module_that_has_changed_since_it_was_loaded_is_no_base_for_kept_code(write, tmp_path, monkeypatch):
    write("kc_helper.py", "ANSWER = 11\n")
    write("kc_user.hy", "(defmacro m [] (import kc_helper) kc_helper.ANSWER)\n(setv found (m))\n")
    monkeypatch.setattr(dependency_tracing, "may_have_changed", lambda path: path.endswith("kc_helper.py"))
    (tmp_path / "kc_helper.py").write_text("ANSWER = 12\n")
    assert found(tmp_path) == 12
    assert kept_code.not_kept(tmp_path / "kc_user.hy").reason == f"{tmp_path / 'kc_helper.py'} may have changed after it was loaded"


@pytest.fixture
def kept(write, compiled, tmp_path):
    """A Hy file whose code is kept."""
    write("kc_macros.hy", "(defmacro answer [] 11)")
    write("kc_user.hy", USER)
    assert found(tmp_path) == 11
    compiled.clear()
    return place(tmp_path)


def test_every_byte_that_changes_is_noticed(kept, compiled, tmp_path, monkeypatch):
    whole, given, loads = kept.read_bytes(), [], marshal.loads
    monkeypatch.setattr(marshal, "loads", lambda data: (given.append(len(data)), loads(data))[1])
    for number in range(0, len(whole), 97 if SOAK else 997):
        spoiled = bytearray(whole)
        spoiled[number] ^= 0x20
        kept.write_bytes(spoiled)
        with pytest.raises(Unusable):
            kept_code.find(tmp_path / "kc_user.hy.module", kept_hy._label(str(tmp_path / "kc_user.hy"), USER.encode()))
        kept.write_bytes(whole[:number])
        with pytest.raises(Unusable):
            kept_code.find(tmp_path / "kc_user.hy.module", kept_hy._label(str(tmp_path / "kc_user.hy"), USER.encode()))
    assert not given
    assert found(tmp_path) == 11 and compiled == ["kc_user.hy"]
    assert kept.read_bytes()[:20] == whole[:20], "it is made anew"


@pytest.mark.soak
def test_code_of_another_cramhy_or_another_hy_is_made_anew(kept, compiled, tmp_path, monkeypatch):
    monkeypatch.setattr(kept_hy, "stamp", lambda: "of another one")
    assert found(tmp_path) == 11 and "kc_user.hy" in compiled
    compiled.clear()
    assert found(tmp_path) == 11 and compiled == []
    monkeypatch.setattr(kept_hy.hy, "__version__", "99")
    assert found(tmp_path) == 11 and "kc_user.hy" in compiled


@pytest.mark.soak
def test_where_the_folder_cannot_be_written_the_cache_is_used(write, compiled, tmp_path, monkeypatch):
    access = os.access
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(os, "access", lambda path, mode: access(path, mode) and not (mode == os.W_OK and "cache" not in Path(path).parts))
    write("kc_macros.hy", "(defmacro answer [] 11)")
    write("kc_user.hy", USER)
    assert found(tmp_path) == 11
    compiled.clear()
    assert found(tmp_path) == 11 and compiled == []
    assert place(tmp_path).parent == tmp_path / "cache" / "cramhy"


@pytest.mark.soak
def test_where_nothing_can_be_written_it_is_compiled_each_time(write, compiled, tmp_path, monkeypatch):
    def full(*words, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("cramhy_runtime.storage.kept_files.write_whole", full)
    write("kc_macros.hy", "(defmacro answer [] 11)")
    write("kc_user.hy", USER)
    for _ in range(2):
        assert found(tmp_path) == 11
    assert compiled.count("kc_user.hy") == 2


def test_bytecode_of_the_cramhy_before_this_one_runs(write, tmp_path):
    """It was a call with one more word."""
    write("kc_user.hy", "(require cramhy *)\n(setv found 22)\n")
    import cramhy

    namespace = {"__name__": "kc_user"}
    cramhy.kept_code.run(namespace, "a stamp", str(tmp_path / "kc_user.hy"), marshal.dumps(compile("found = 11", "kc_user.hy", "exec")))
    assert namespace["found"] == 22


def test_a_file_that_is_younger_than_this_process_may_have_changed(tmp_path):
    (tmp_path / "x.py").write_text("")
    assert dependency_tracing.may_have_changed(str(tmp_path / "x.py"))
    os.utime(tmp_path / "x.py", (1e9, 1e9))
    assert not dependency_tracing.may_have_changed(str(tmp_path / "x.py"))
