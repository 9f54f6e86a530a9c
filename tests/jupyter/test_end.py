"""How a kernel ends: through the cleanup of the plan that runs."""

from __future__ import annotations

import pytest

from .conftest import Notebook


def test_a_kernel_that_is_shut_down_ends_its_plan_through_its_cleanup(tmp_path):
    for module in ("ipykernel", "jupyter_client"):
        pytest.importorskip(module, reason="the extra jupyter is not installed")
    notebook = Notebook(tmp_path, "--time", "wall")
    notebook.client.execute(
        '(unwind-protect (progn (format t "begun~%") (loop (cpl:sleep 1)))'
        ' (with-open-file (file "stopped" :direction :output) (print :stopped file)))'
    )
    while notebook.client.get_iopub_msg(timeout=120)["msg_type"] != "stream":
        pass
    notebook.end()
    assert ":STOPPED" in (tmp_path / "stopped").read_text()
    assert not notebook.manager.is_alive()
