"""Ctrl-C and the signals that end a process, in the middle of a plan in a ``.hy`` file: cleanup runs, and the status is a command's."""

import signal
import subprocess
import sys

import pytest

from .conftest import PROGRAMS, environment

TEXTS = {
    "Hy": """\
(require cramhy *)
(cramhy.time "wall")
(import cramhy_runtime.cpl *)
(top-level
  (try
    (par (do (print "begun" :flush True) (sleep 100)) (sleep 200))
    (finally (print "cleaned up"))))
""",
    "Common Lisp": """\
(require cramhy *)
(in-package :cram-user)
(cramhy:time "wall")
(top-level
  (unwind-protect
      (par (progn (format t "begun~%") (finish-output) (sleep 100)) (sleep 200))
    (format t "cleaned up~%")))
""",
}


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
@pytest.mark.parametrize("language", TEXTS)
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_the_plan_is_cleaned_up(write, tmp_path, way, language, number, status):
    write("plan.hy", TEXTS[language])
    command = [sys.executable, "-m", *PROGRAMS[way], "plan.hy"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment()) as process:
        assert process.stdout.readline() == "begun\n"
        process.send_signal(number)
        printed, told = process.communicate(timeout=60)
    assert (process.returncode, printed, told) == (status, "cleaned up\n", "")
