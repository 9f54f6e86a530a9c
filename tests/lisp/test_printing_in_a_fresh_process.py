"""The first thing that a process prints may be a class: it prints as the hundredth does, as in SBCL."""

import json
import subprocess
import sys

import pytest

pytestmark = pytest.mark.soak

CLASSES = {
    "t": "#<SB-PCL:SYSTEM-CLASS COMMON-LISP:T>",
    "sequence": "#<SB-PCL:SYSTEM-CLASS COMMON-LISP:SEQUENCE>",
    "hash-table": "#<STRUCTURE-CLASS COMMON-LISP:HASH-TABLE>",
    "error": "#<SB-PCL::CONDITION-CLASS COMMON-LISP:ERROR>",
    "class": "#<STANDARD-CLASS COMMON-LISP:CLASS>",
}


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_is_printed_first(name):
    form = json.dumps({"form": f"(find-class '{name})"}) + "\n"
    done = subprocess.run([sys.executable, "-m", "cramhy_runtime.cli", "eval"], input=form, capture_output=True, text=True, timeout=120)
    assert json.loads(done.stdout)["values"] == [CLASSES[name]], done.stderr
