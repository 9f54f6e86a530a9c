"""What a start leaves out. The figures themselves are measured by `make bench`."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

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


@pytest.mark.soak
def test_no_compiled_macro_file_requires_anything_when_it_runs():
    """Hy's `require` looks at the source of every frame of the stack. A dozen files that require took a quarter of a start."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    for _ in ("compiled", "started"):  # the first start may have to compile the files, which requires
        done = subprocess.run([sys.executable, "-c", STARTED], capture_output=True, text=True, timeout=120, env=environment)
        assert done.returncode == 0, done.stderr
    assert done.stdout == "[]\n"


PROMPT = """
import sys
from cramhy_runtime import cli

status = cli.main(["repl", *sys.argv[1:]])
rooms = {"cramhy_runtime.designators", "cramhy_runtime.languages.commonlisp.faces.cpl.package"}
print("rooms:", sorted(rooms & sys.modules.keys()))
sys.exit(status)
"""
LOOK = """(list (mapcar #'package-name (list-all-packages)) (package-use-list :cl-user) (find-symbol "EXIT"))
(list (length (apropos-list "FLUENT")) (gensym) (random 1000) (make-instance 'cpl:task) (cpl:make-fluent))
(defvar *packages* (list-all-packages))
*features*
"""


def prompt(typed, *words):
    """What a prompt printed in a process of its own, with these ``words`` on its command line."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(
        [sys.executable, "-c", PROMPT, "--seed", "3", *words], input=typed, capture_output=True, text=True, timeout=120, env=environment
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.soak
def test_a_prompt_that_waits_has_loaded_common_lisp_only():
    assert prompt("").endswith("CL-USER> rooms: []\n")
    assert prompt("1\n").endswith("rooms: ['cramhy_runtime.designators', 'cramhy_runtime.languages.commonlisp.faces.cpl.package']\n")


@pytest.mark.soak
def test_what_is_typed_finds_what_it_finds_in_a_session_that_was_whole_from_the_beginning():
    late, whole = prompt(LOOK), prompt(LOOK, "--package", "cl-user")
    assert late == whole and "CRAM-LANGUAGE" in late


IMAGE = """
import sys
from cramhy_runtime.lisp_core import packages
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image, boot

session = Session(time="virtual", whole=sys.argv[1] == "whole")
boot()
session.evaluate_text("(defvar *mine* 1)")


def there():
    user = packages.find_package("CL-USER")
    return [sorted(user.internal), [package.name for package in packages.all_packages()], packages.find_package("CPL") in user.use]


with Image():
    Session(time="virtual")
    print(there())
print("*MINE*" in there()[0])
"""


@pytest.mark.soak
def test_a_new_image_of_a_late_session_is_as_one_of_a_whole_session():
    found = [subprocess.run([sys.executable, "-c", IMAGE, how], capture_output=True, text=True, timeout=120) for how in ("whole", "late")]
    assert [done.stderr for done in found] == ["", ""]
    assert found[0].stdout == found[1].stdout and "*MINE*" not in found[0].stdout.splitlines()[0] and found[0].stdout.endswith("True\n")
