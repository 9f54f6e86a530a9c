"""Programs in the manner of "The Art of the Metaobject Protocol", with the answers of SBCL 2.2.9 beside: ``metaclasses.lisp``."""

import re
from pathlib import Path

import pytest

SHOW = '(defun show (&rest l) (format t "~{~s~^ ~}~%" l))'
PROGRAMS = {}
for part in (Path(__file__).parent / "metaclasses.lisp").read_text().split(";;;; ")[1:]:
    name, _, text = part.partition("\n")
    PROGRAMS[name] = text


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_metaclass_does_what_it_does_on_sbcl(session, name, capsys):
    package = "MOP-" + re.sub("[^A-Z]", "-", name.upper())
    session.evaluate_text(f"(defpackage {package} (:use :cl))")
    session.package = package
    session.evaluate_text(SHOW)
    capsys.readouterr()
    session.evaluate_text(PROGRAMS[name])
    session.package = "CL-USER"
    told = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines() if line.strip()]
    assert " ".join(told) == " ".join(re.findall("^;=> *(.*)$", PROGRAMS[name], re.MULTILINE))
