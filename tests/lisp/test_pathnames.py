"""Pathnames are taken apart and put together as in SBCL."""

from __future__ import annotations

import ntpath

import pytest

from cramhy_runtime.languages.commonlisp.pathnames import namestrings
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string


@pytest.mark.parametrize(
    ("form", "wanted"),
    [
        ('#p"/a/b.lisp"', '#P"/a/b.lisp"'),
        ('(pathname-name "/a/b.lisp")', '"b"'),
        ('(pathname-type "/a/b.lisp")', '"lisp"'),
        ('(pathname-type "/a/b")', "NIL"),
        ('(pathname-directory "/a/c/b")', '(:ABSOLUTE "a" "c")'),
        ('(pathname-directory "a/b")', '(:RELATIVE "a")'),
        ('(pathname-directory "b")', "NIL"),
        ('(directory-namestring "/a/b.c")', '"/a/"'),
        ('(file-namestring "/a/b.c")', '"b.c"'),
        ('(namestring #p"/a/b.c")', '"/a/b.c"'),
        ('(merge-pathnames "a.lisp" "/tmp/")', '#P"/tmp/a.lisp"'),
        ('(merge-pathnames "a" "/tmp/x.lisp")', '#P"/tmp/a.lisp"'),
        ('(merge-pathnames "/a/b" "/tmp/x.lisp")', '#P"/a/b.lisp"'),
        ('(make-pathname :name "a" :type "b" :directory \'(:absolute "tmp"))', '#P"/tmp/a.b"'),
        ('(make-pathname :name "a" :defaults "/tmp/x.lisp")', '#P"/tmp/a.lisp"'),
        ('(pathnamep "a")', "NIL"),
        ('(pathnamep #p"a")', "T"),
    ],
)
def test_the_answer_is_that_of_sbcl(session, form, wanted):
    assert prin1_to_string(session.evaluate_text(form)[0]) == wanted


@pytest.fixture
def windows(session, monkeypatch):
    """A session whose pathnames are written as on Windows, in the folder ``D:\\course``."""
    monkeypatch.setattr(namestrings, "WRITING", namestrings.Writing(drives=True))
    monkeypatch.setattr(DEFAULTS, "value", namestrings.parse_native("D:\\course/"))
    return session


@pytest.mark.parametrize(
    ("form", "wanted"),
    [
        ('#p"C:/a/b.lisp"', '#P"C:/a/b.lisp"'),
        (r'#p"c:\\a\\b.lisp"', '#P"C:/a/b.lisp"'),
        ('(pathname-device "C:/a/b.lisp")', '"C"'),
        ('(pathname-device "/a/b.lisp")', "NIL"),
        ('(pathname-directory "C:/a/c/b")', '(:ABSOLUTE "a" "c")'),
        ('(pathname-directory "C:a/b")', '(:RELATIVE "a")'),
        ('(merge-pathnames "plans/a.lisp")', '#P"D:/course/plans/a.lisp"'),
        ('(merge-pathnames "/plans/a.lisp")', '#P"D:/plans/a.lisp"'),
        ('(merge-pathnames "C:/plans/a.lisp")', '#P"C:/plans/a.lisp"'),
        ('(directory-namestring "C:/a/b.c")', '"C:/a/"'),
        ('(file-namestring "C:/a/b.c")', '"b.c"'),
        ('(sb-ext:native-namestring "C:/a/b.c")', '"C:/a/b.c"'),
        (r'#p"\\\\server\\share\\a\\b.c"', '#P"//server/share/a/b.c"'),
        ('(pathname-device #p"//server/share/a/b.c")', '"//server/share"'),
        ('(sb-ext:native-namestring (sb-ext:parse-native-namestring "C:/a/x[1].c"))', '"C:/a/x[1].c"'),
        ('(namestring (sb-ext:parse-native-namestring "C:/a/x[1].c"))', '"C:/a/x^[1].c"'),
        ('(pathname-name #p"C:/a/x^[1].c")', '"x[1]"'),
        ('(make-pathname :name "n" :defaults #p"C:/a/b.c")', '#P"C:/a/n.c"'),
        ('(enough-namestring "D:/course/a/b.c")', '"a/b.c"'),
        ('(enough-namestring "C:/course/a/b.c")', '"C:/course/a/b.c"'),
        ('(wild-pathname-p "C:/a/*.lisp")', "T"),
        ('(pathname-match-p "C:/a/b.lisp" "C:/a/*.lisp")', "T"),
        ('(pathname-match-p "D:/a/b.lisp" "C:/a/*.lisp")', "NIL"),
        ('(namestring #p"~/a.lisp")', '"~/a.lisp"'),
    ],
)
def test_names_of_windows_have_drives_and_both_slashes(windows, form, wanted):
    assert prin1_to_string(windows.evaluate_text(form)[0]) == wanted


@pytest.mark.parametrize("name", ["C:\\Users\\me\\a.lisp", "D:\\a b\\", "\\\\server\\share\\x.y", "C:\\x[1]^2.txt", "a\\b", "C:\\..\\x"])
def test_a_name_that_windows_gives_is_the_same_file_again(windows, name):
    again = namestrings.native_namestring(namestrings.parse_native(name))
    assert ntpath.normpath(again) == ntpath.normpath(name)
    read = windows.evaluate_text(prin1_to_string(namestrings.parse_native(name)))[0]
    assert ntpath.normpath(namestrings.native_namestring(read)) == ntpath.normpath(name)
