"""Where names are defined and used: the files that are looked into."""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import find_package, intern
from cramhy_runtime.session import lookup
from cramhy_runtime.session.lookup import known_files


def test_files_stand_in_the_order_of_their_last_load_whatever_lives_on_of_earlier_ones(session, tmp_path):
    one, two = tmp_path / "one.lisp", tmp_path / "two.lisp"
    one.write_text("(defun looked-up-one () 1)\n")
    two.write_text("(defun looked-up-two () 2)\n")
    session.load(str(two))
    lives_on = intern("LOOKED-UP-TWO", session.package).function
    session.load(str(one))
    session.load(str(two))
    assert lives_on() == 2
    assert [name for name in known_files() if name in (str(one), str(two))] == [str(one), str(two)]


TWINS = """(defpackage :kitchen (:use :cl) (:export #:open-door))
(defpackage :garage (:use :cl))
(defpackage :hall (:use :cl) (:import-from :kitchen #:open-door))
(in-package :kitchen)
(defun open-door (x) x)
(defun enter () (open-door 1))
(in-package :garage)
(defun open-door (x) (list x))
(defun enter () (open-door 2) (kitchen:open-door 3))
(in-package :hall)
(defun enter () (open-door 4))
"""


def test_two_symbols_of_one_name_are_found_apart(session, tmp_path):
    file = tmp_path / "twins.lisp"
    file.write_text(TWINS, encoding="utf-8")
    session.evaluate_text(f'(load "{file}")')
    lines = {}
    for name in ("KITCHEN", "GARAGE", "HALL"):
        package = find_package(name)
        symbol = package.lookup("OPEN-DOOR")[0]
        lines[name] = (
            [each.line for each in lookup.definitions("open-door", package)],
            [each.line for each in lookup.uses("OPEN-DOOR", calls=True, symbol=symbol)],
        )
    assert lines == {"KITCHEN": ([5], [6, 9, 11]), "GARAGE": ([8], [9]), "HALL": ([5], [6, 9, 11])}
