"""Where names are defined and used: the files that are looked into."""

from __future__ import annotations

from cramhy_runtime.ground.packages import intern
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
