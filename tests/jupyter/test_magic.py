"""The cell magic of IPython, in a shell of IPython's without a notebook; and the line that names the extra."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
from IPython.core.interactiveshell import InteractiveShell
from IPython.core import displayhook, displaypub
shell = InteractiveShell.instance()
shown = []
shell.display_pub.publish = lambda data, **more: shown.append(data)
shell.run_line_magic("load_ext", "cramhy_runtime.jupyter")
shell.run_cell_magic("cramhy", "", "(defvar *x* 20) (list *x* 'y)")
shell.run_cell_magic("cramhy", "hy", "[1 2]")
shell.run_cell_magic("cramhy", "", '(car 7)')
shell.run_cell_magic("cramhy", "klingon", "1")
shell.run_cell_magic("cramhy", "", '(roslisp:start-ros-node "n") (cpl:sleep 1)')
print([data["text/plain"] for data in shown])
"""


@pytest.mark.soak
def test_a_cell_of_lisp_or_hy_in_ipython(tmp_path):
    pytest.importorskip("IPython", reason="the extra jupyter is not installed")
    done = subprocess.run([sys.executable, "-c", SCRIPT], cwd=tmp_path, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    assert "['(20 Y)', '[1 2]', " in done.stdout
    assert "TYPE-ERROR" in done.stderr and "is not of type" in done.stderr and "a cell is lisp or hy" in done.stderr


def test_the_extra_is_named_where_it_is_missing(monkeypatch, capsys):
    from cramhy_runtime.cli import main, servers

    monkeypatch.setattr(servers, "find_spec", lambda module: None)
    assert main(["jupyter", "install"]) == 2
    told = capsys.readouterr().err
    assert told.startswith("cramhy jupyter needs") and "[jupyter]" in told and told.count("\n") == 1
