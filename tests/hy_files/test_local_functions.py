"""Functions that an operator gives its body have the names of functions of Lisp; in its body theirs count."""

from __future__ import annotations

import subprocess
import sys


def test_the_answer_of_a_service_is_that_of_the_callback(tmp_path):
    path = tmp_path / "add.hy"
    path.write_text(
        """(require cramhy *)
        (cramhy.time "virtual")
        (start-ros-node "n")
        (def-service-callback roscpp_tutorials-srv:TwoInts [a b] (make-response :sum (+ a b)))
        (register-service "add" roscpp_tutorials-srv:TwoInts)
        (with-fields [sum] (call-service "add" "roscpp_tutorials/TwoInts" :a 3 :b 4) (print "sum" sum))"""
    )
    done = subprocess.run([sys.executable, "-m", "hy", str(path)], capture_output=True, text=True)
    assert done.stdout.endswith("sum 7\n"), done.stdout + done.stderr
