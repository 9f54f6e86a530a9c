"""SB-EXT, SB-MOP and ALEXANDRIA: the names beyond ANSI that programs use."""

import pytest


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(
    "form, value",
    [
        ("(funcall (alexandria:curry #'list 1 2) 3)", "(1 2 3)"),
        ("(funcall (alexandria:rcurry 'list 1 2) 3)", "(3 1 2)"),
        ("(funcall (alexandria:compose #'1+ #'floor #'car) '(7/2))", "4"),
        ("(alexandria:ensure-list nil)", "NIL"),
        ("(alexandria:ensure-list 1)", "(1)"),
        ("(alexandria:flatten '(1 (2 nil (3 . 4)) nil))", "(1 2 3 4)"),
        ("(alexandria:iota 3)", "(0 1 2)"),
        ("(alexandria:iota 3 :start 1 :step 1/2)", "(1 3/2 2)"),
        ("(alexandria:iota 3 :start 1.1 :step .1)", "(1.1 1.2 1.3000001)"),
        ("(alexandria:mappend #'list '(1 2) '(3 4))", "(1 3 2 4)"),
        ('(alexandria:make-keyword "ABC")', ":ABC"),
        ("(let ((h (make-hash-table))) (setf (gethash 1 h) 2) (alexandria:hash-table-alist h))", "((1 . 2))"),
        ("(mapcar #'class-name (sb-mop:class-precedence-list (find-class 'integer)))", "(INTEGER RATIONAL REAL NUMBER T)"),
        ("(eql sb-ext:double-float-positive-infinity (read-from-string (prin1-to-string sb-ext:double-float-positive-infinity)))", "T"),
        ("(= (random 1000 (sb-ext:seed-random-state 7)) (random 1000 (sb-ext:seed-random-state 7)))", "T"),
    ],
)
def test_what_the_names_do(session, form, value):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    (result,) = session.evaluate_text(form, "test")
    assert prin1_to_string(result) == value


def test_time_begins_at_one_moment_for_all(session):
    assert session.evaluate_text("(cut:current-string-timestamp)", "test") == ["20101218161109"]
    (universal,), (ros,) = session.evaluate_text("(get-universal-time)", "test"), session.evaluate_text("(roslisp:ros-time)", "test")
    assert universal - 2208988800 == int(ros) == 1292688669
