"""What a start leaves out. The figures themselves are measured by `make bench`."""

from __future__ import annotations

import os
import subprocess
import sys

STARTED = """
import hy.macros

calls, require = [], hy.macros.require


def noting(source, *arguments, **keywords):
    calls.append(source)
    return require(source, *arguments, **keywords)


hy.macros.require = noting

from cramhy_runtime.repl.session import Session

Session(time="virtual").evaluate_text("(+ 1 2)")
print(calls)
"""


def test_no_compiled_macro_file_requires_anything_when_it_runs():
    """Hy's `require` looks at the source of every frame of the stack. A dozen files that require took a quarter of a start."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    for _ in ("compiled", "started"):  # the first start may have to compile the files, which requires
        done = subprocess.run([sys.executable, "-c", STARTED], capture_output=True, text=True, timeout=120, env=environment)
        assert done.returncode == 0, done.stderr
    assert done.stdout == "[]\n"
