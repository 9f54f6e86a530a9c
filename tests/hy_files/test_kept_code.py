"""The bytecode of a Hy file is used again by the cramhy that has compiled it, and made again by another one."""

import os
import stat
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.soak

OLDER = """\
import cramhy, sys
import cramhy_runtime.languages.kept_hy as kept_hy
kept_hy.stamp = lambda: "of an older cramhy"
list(cramhy._hy_macros.keys())
cramhy._hy_macros["seq"] = lambda *forms: "from an older macro"
"""
COUNTS = """\
import hy
from hy import importer
compiler = importer.hy_compile
def hy_compile(tree, module, *more, **options):
    print("compiles", module.__name__)
    return compiler(tree, module, *more, **options)
importer.hy_compile = hy_compile
"""
PLAN = """\
(require cramhy *)
(setv answer (top-level (seq 1 "from this macro")))
(print __name__ answer (in "answer" (globals)))
"""
LISP = """\
(require cramhy *)
(in-package :cram-user)
(format t "from this macro~%")
"""


def bytecode(folder, name="plan"):
    return folder / "__pycache__" / f"{name}.{sys.implementation.cache_tag}.pyc"


def made_by_an_older_one(write, python, tmp_path, text=PLAN):
    write("plan.hy", text)
    done = python("-c", OLDER + "import plan")
    assert done.stdout == "plan from an older macro True\n", done.stderr
    return bytecode(tmp_path)


IMPORTS = ["-c", COUNTS + "import plan"]
RUNS = ["-c", COUNTS + "from hy.cmdline import hy_main; hy_main()", "plan.hy"]
MODULE = ["-c", COUNTS + "from hy.cmdline import hy_main; hy_main()", "-m", "plan"]


@pytest.mark.parametrize(
    ("words", "name"), [(IMPORTS, "plan"), (RUNS, "__main__"), (MODULE, "__main__")], ids=["import", "hy FILE", "hy -m"]
)
def test_what_an_older_cramhy_made_is_compiled_again_once(write, python, tmp_path, words, name):
    made_by_an_older_one(write, python, tmp_path)
    said = f"{name} from this macro True"
    first, then = (python(*words) for _ in range(2))
    assert (first.stdout.splitlines()[-1], then.stdout.splitlines(), first.stderr + then.stderr) == (said, [said], "")
    assert first.stdout.startswith("compiles ")


def test_the_next_one_imports_what_this_one_has_made_again(write, python, tmp_path):
    made_by_an_older_one(write, python, tmp_path)
    write("uses.hy", "(require cramhy *)\n(import plan)\n(print (top-level (seq 1 plan.answer)))\n")
    for _ in range(2):
        done = python("-m", "hy", "uses.hy")
        assert (done.stdout, done.stderr) == ("plan from this macro True\nfrom this macro\n", "")


def test_code_in_common_lisp_is_guarded_too(write, python, tmp_path):
    write("plan.hy", LISP)
    older = "import cramhy\nimport cramhy_runtime.languages.kept_hy as kept_hy\nkept_hy.stamp = lambda: 'older'\nimport plan"
    assert python("-c", older).stdout == "from this macro\n"
    first, then = (python(*IMPORTS).stdout for _ in range(2))
    assert (first, then) == ("compiles plan\nfrom this macro\n", "from this macro\n")


def test_a_folder_that_cannot_be_written_costs_time_only(write, python, tmp_path):
    kept = made_by_an_older_one(write, python, tmp_path)
    if os.geteuid() == 0:
        pytest.skip("nothing is forbidden to root")
    kept.parent.chmod(stat.S_IRUSR | stat.S_IXUSR)
    try:
        for _ in range(2):
            assert python("-c", "import hy, plan").stdout == "plan from this macro True\n"
    finally:
        kept.parent.chmod(stat.S_IRWXU)


def test_nothing_is_written_where_python_shall_write_nothing(write, python, tmp_path):
    kept = made_by_an_older_one(write, python, tmp_path)
    before = kept.read_bytes()
    assert python("-B", "-c", "import hy, plan").stdout == "plan from this macro True\n"
    assert kept.read_bytes() == before


def test_bytecode_without_its_source_runs_as_it_is(write, python, tmp_path):
    kept = made_by_an_older_one(write, python, tmp_path)
    kept.rename(tmp_path / "plan.pyc")
    (tmp_path / "plan.hy").unlink()
    assert python("-c", "import hy, plan").stdout == "plan from an older macro True\n"


def test_a_changed_source_is_compiled_again(write, python, tmp_path):
    path = made_by_an_older_one(write, python, tmp_path)
    assert path.exists()
    write("plan.hy", PLAN.replace("from this macro", "changed, and longer"))
    assert python("-c", "import hy, plan").stdout == "plan changed, and longer True\n"


def test_code_that_no_macro_of_ours_has_seen_is_kept_as_python_keeps_it(write, python, tmp_path):
    write("plan.hy", '(print "Hy alone")\n')
    write("other.py", "print('Python')\n")
    said = "Hy alone\nPython\n"
    assert [python("-c", "import cramhy, plan, other").stdout for _ in range(2)] == [said, said]
    assert b"kept_code" not in bytecode(tmp_path).read_bytes() + bytecode(tmp_path, "other").read_bytes()


@pytest.mark.parametrize("language", ["hy", "python"])
def test_the_traceback_of_kept_code_has_no_frame_of_ours(write, python, tmp_path, language):
    write("plan.hy", "(require cramhy *)\n(defn divide [n]\n  (/ 1 n))\n(divide 0)\n")
    program = "import hy\nimport plan\n"
    write("program.py", program)
    words = {"hy": ["-m", "hy", "plan.hy"], "python": ["program.py"]}[language]
    made, kept = (python(*words).stderr for _ in range(2))
    assert made == kept
    assert "kept_hy" not in kept and "frozen" not in kept
    assert "(divide 0)" in kept


def test_the_tests_of_this_file_know_where_bytecode_is(write, python, tmp_path):
    write("plan.hy", PLAN)
    python("-c", "import hy, plan")
    assert b"kept_code" in Path(bytecode(tmp_path)).read_bytes()
