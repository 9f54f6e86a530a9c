"""Names of CFFI that need no C: what ``.asd`` files and readers of C's names ask."""

from __future__ import annotations

import pytest


@pytest.mark.parametrize(
    ("form", "printed"),
    [
        ("(list (cffi-features:cffi-feature-p :unix) (cffi-features:cffi-feature-p :windows))", "(T NIL)"),
        ("(cffi-features:cffi-feature-p '(:and :unix (:not :windows)))", "T"),
        ("(cffi-features:cffi-feature-p '(:or :windows (:and :unix :no-such-feature)))", "NIL"),
        ('(mapcar #\'cffi:canonicalize-symbol-name-case \'("grab-image" "x1" ""))', '("GRAB-IMAGE" "X1" "")'),
        ('(list (cffi-sys:native-namestring #p"/tmp/a b") (cffi:native-namestring "/tmp/a/"))', '("/tmp/a b" "/tmp/a/")'),
        (r'(cffi-sys:native-namestring (make-pathname :directory "tmp" :name "a*b"))', '"/tmp/a*b"'),
    ],
)
def test_a_name_that_asks_about_this_machine_or_about_cases(values, form, printed):
    values('(asdf:load-system "cffi")')
    assert values(form) == printed
