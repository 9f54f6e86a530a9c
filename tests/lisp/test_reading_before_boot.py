"""Python code may read Lisp text before there is an image: it reads as later, and spoils nothing for later."""

import subprocess
import sys

FIRST = """
from cramhy_runtime import kernel
kernel.start(clock="virtual")
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.languages.commonlisp.reader.reader_functions import read_from_string
print(list(one(read_from_string('("a;b" 1) ; comment'))))
from cramhy_runtime.repl.session import Session
print(Session(time="virtual", turtlesim=False).evaluate_text("(defpackage first-reading (:use :cl)) (list 1 2)")[0])
"""


def test_reading_needs_no_image():
    done = subprocess.run([sys.executable, "-c", FIRST], capture_output=True, text=True, timeout=120)
    assert (done.stdout, done.returncode) == ("['a;b', 1]\n(1 2)\n", 0), done.stderr
