"""Pathnames are taken apart and put together as in SBCL."""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp.printer.printer import prin1_to_string


@pytest.mark.parametrize(("form", "wanted"), [
    ('#p"/a/b.lisp"', '#P"/a/b.lisp"'), ('(pathname-name "/a/b.lisp")', '"b"'), ('(pathname-type "/a/b.lisp")', '"lisp"'),
    ('(pathname-type "/a/b")', "NIL"), ('(pathname-directory "/a/c/b")', '(:ABSOLUTE "a" "c")'),
    ('(pathname-directory "a/b")', '(:RELATIVE "a")'),
    ('(pathname-directory "b")', "NIL"), ('(directory-namestring "/a/b.c")', '"/a/"'), ('(file-namestring "/a/b.c")', '"b.c"'),
    ('(namestring #p"/a/b.c")', '"/a/b.c"'), ('(merge-pathnames "a.lisp" "/tmp/")', '#P"/tmp/a.lisp"'),
    ('(merge-pathnames "a" "/tmp/x.lisp")', '#P"/tmp/a.lisp"'), ('(merge-pathnames "/a/b" "/tmp/x.lisp")', '#P"/a/b.lisp"'),
    ('(make-pathname :name "a" :type "b" :directory \'(:absolute "tmp"))', '#P"/tmp/a.b"'),
    ('(make-pathname :name "a" :defaults "/tmp/x.lisp")', '#P"/tmp/a.lisp"'), ('(pathnamep "a")', "NIL"), ('(pathnamep #p"a")', "T"),
])
def test_the_answer_is_that_of_sbcl(session, form, wanted):
    assert prin1_to_string(session.evaluate_text(form)[0]) == wanted
