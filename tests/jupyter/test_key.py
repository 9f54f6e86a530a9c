"""A kernel that anybody on the machine could use does not start."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest
from systems import posix

pytest.importorskip("ipykernel")
AGAIN = "Let Jupyter write the file, or write one of mode 0600 with a long random key."


@pytest.fixture
def launched(tmp_path):
    """``launched(key, mode)``: how a kernel ends that is told such a connection file: the exit status, and what it says."""

    def launched(key, mode=0o600, **variables):
        path = tmp_path / "connection.json"
        ports = dict.fromkeys(("shell_port", "iopub_port", "stdin_port", "control_port", "hb_port"), 0)
        path.write_text(json.dumps({"transport": "tcp", "ip": "127.0.0.1", "key": key, "signature_scheme": "hmac-sha256", **ports}))
        path.chmod(mode)
        words = [sys.executable, "-m", "cramhy_runtime.cli", "jupyter", "kernel", "--no-turtlesim", "-f", str(path)]
        done = subprocess.run(words, capture_output=True, text=True, timeout=120, cwd=tmp_path, env={**os.environ, **variables})
        return done.returncode, done.stderr.replace(str(path), "FILE")

    return launched


@pytest.mark.soak
@pytest.mark.parametrize(
    ("key", "mode", "why"),
    [
        ("", 0o600, 'has an empty "key", so any user of this machine could run cells.'),
        pytest.param("0123456789abcdef", 0o644, "may be read or written by other users, so they could run cells.", marks=posix),
    ],
    ids=["an empty key", "a file that others read"],
)
def test_a_kernel_without_a_secret_does_not_start(launched, key, mode, why):
    assert launched(key, mode) == (2, f"cramhy: the connection file FILE {why} {AGAIN}\n")
