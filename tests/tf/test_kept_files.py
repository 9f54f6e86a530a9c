"""A compiled file that was kept makes the packages of tf when it is loaded, though their names stood only in macros."""

import subprocess
import sys


def test_a_file_with_nothing_but_the_macro_runs_again(tmp_path):
    (tmp_path / "frames.lisp").write_text(
        "(defun f (broadcaster) (cl-tf:with-tf-broadcasting (broadcaster) 3))\n"
        '(handler-case (f nil) (undefined-function () (format t "undefined")) (error () (format t "found")))\n'
    )
    for _ in range(2):
        run = [sys.executable, "-m", "cramhy_runtime.cli", "run", str(tmp_path / "frames.lisp"), "--time", "virtual"]
        assert subprocess.run(run, capture_output=True, text=True, timeout=120).stdout.strip() == "found"
