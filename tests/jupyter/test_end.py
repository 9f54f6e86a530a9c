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


@pytest.mark.soak
@pytest.mark.parametrize(
    ("code", "status"),
    [("(progn (print 1) (exit :code 3))", 3), ("%%hy\n(print 1)\n(import sys)\n(sys.exit)", 0)],
    ids=["exit", "sys.exit"],
)
def test_a_cell_that_ends_the_kernel_is_answered_before(tmp_path, code, status):
    notebook = Notebook(tmp_path)
    answer = notebook.run(code)
    assert answer.reply["status"] == "ok" and answer.reply["payload"] == [{"source": "ask_exit", "keepkernel": False}]
    assert "1" in answer.printed and answer.of("status")[-1] == {"execution_state": "idle"}
    assert notebook.manager.provisioner.process.wait(60) == status
    notebook.client.stop_channels()
