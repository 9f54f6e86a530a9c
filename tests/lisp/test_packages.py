"""Packages beyond what ``symbols/packages.txt`` records: the restarts of conflicts and locks, and what a user sees."""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp_core import packages
from cramhy_runtime.lisp_core.conditions import restart_case
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import Package
from cramhy_runtime.languages.commonlisp.packages.package_errors import NameConflict, PackageLockedError, check_package, unlocked


@pytest.fixture
def lisp(session):
    """``lisp(text)``: the value of ``text`` in CL-USER; packages that it makes are gone afterwards."""
    before = set(packages.all_packages())
    session.package = "COMMON-LISP-USER"
    session.evaluate_text("(defpackage :ta (:use) (:export #:x #:y)) (defpackage :tb (:use) (:export #:x #:z))")
    yield lambda text: session.evaluate_text(text)[0]
    for package in packages.all_packages():
        if package not in before:
            for user in list(package.used_by):
                user.unuse_package(package)
            packages.delete_package(package)


RESTARTED = "(handler-bind ((error (lambda (e) (invoke-restart {})))) {})"


@pytest.mark.parametrize(
    ("restart", "home"),
    [
        ("'sb-impl::keep-old", "TA"),
        ("'sb-impl::take-new", "TB"),
        ("'sb-impl::resolve-conflict 'tb:x", "TB"),
        ("'sb-impl::resolve-conflict 'ta:x", "TA"),
    ],
)
def test_a_conflict_of_inherited_names_is_resolved_as_the_user_says(lisp, restart, home):
    lisp("(make-package :tc :use '(:ta))")
    assert lisp(RESTARTED.format(restart, "(use-package :tb :tc)")) is True
    assert lisp('(package-name (symbol-package (find-symbol "X" :tc)))') == home
    assert lisp('(package-name (symbol-package (find-symbol "Z" :tc)))') == "TB"


@pytest.mark.parametrize(("restart", "home"), [("'sb-impl::keep-old", "TA"), ("'sb-impl::take-new", "TD")])
def test_a_conflict_of_an_export_is_resolved_in_the_package_that_uses_it(lisp, restart, home):
    lisp("(progn (make-package :td) (make-package :te :use '(:ta :td)))")
    assert lisp(RESTARTED.format(restart, '(export (intern "X" :td) :td)')) is True
    assert lisp('(package-name (symbol-package (find-symbol "X" :te)))') == home
    assert lisp('(nth-value 1 (find-symbol "X" :td))').name == "EXTERNAL"


def test_the_conflict_says_what_to_do(lisp, session):
    with pytest.raises(NameConflict) as caught:
        lisp("(defpackage :tf (:use :ta :tb))")
    assert " ".join(str(caught.value).split()) == (
        'USE-PACKAGE #<PACKAGE "TB"> causes name-conflicts in #<PACKAGE "TF"> between the following symbols: TB:X, TA:X'
    )
    assert caught.value.hint == (
        "Choose with a restart, or say in the package definition which one is meant, with :shadow or :shadowing-import-from."
    )
    assert lisp("(package-name (defpackage :tf (:use :ta :tb) (:shadowing-import-from :ta #:x)))") == "TF"


def test_a_restart_of_a_lock_goes_on_once_or_for_ever():
    package = Package("LOCKED-IN-A-TEST")
    package.locked = True
    with pytest.raises(PackageLockedError):
        check_package(package, "interning ~A", "X")
    with unlocked([package]):
        check_package(package, "interning ~A", "X")
    with pytest.raises(PackageLockedError):
        check_package(package, "interning ~A", "X")
    assert restart_case([(Symbol("OTHER"), lambda: 1)], lambda: package.locked)


def test_unlocking_by_a_restart(lisp):
    lisp("(progn (make-package :tl) (sb-ext:lock-package :tl))")
    assert lisp(RESTARTED.format("'sb-ext:unlock-package", '(symbol-name (intern "A" :tl))')) == "A"
    assert lisp("(sb-ext:package-locked-p :tl)") is None


def test_reading_a_new_symbol_of_a_locked_package_shows_its_place(session):
    with pytest.raises(PackageLockedError) as caught:
        session.evaluate_text("(list\n  cl::mapcarr)")
    assert caught.value.position[1:] == (2, 3)
    assert caught.value.hint == "COMMON-LISP has no symbol MAPCARR. Did you mean MAPCAR or MAPCAN?"


def test_a_missing_package_may_be_replaced(lisp):
    assert lisp(RESTARTED.format("'use-value :ta", '(package-name (symbol-package (intern "X" :no-such)))')) == "TA"
    assert lisp(RESTARTED.format("'continue", "(package-name (package-name :no-such))")) == "COMMON-LISP-USER"


def test_the_symbols_of_a_deleted_package_print_without_home(lisp):
    assert lisp('(let* ((p (make-package :tg)) (s (intern "S" p))) (delete-package p) (prin1-to-string s))') == "#:S"


def test_local_nicknames_hold_in_their_package_only(lisp):
    lisp("(defpackage :th (:use :cl) (:local-nicknames (:geometry :ta)))")
    assert lisp('(let ((*package* (find-package :th))) (package-name (symbol-package (read-from-string "geometry:x"))))') == "TA"
    assert lisp("(find-package :geometry)") is None


@pytest.mark.parametrize(
    "form",
    [
        "(deftype of-lock () 'integer)",
        "(defun of-lock ())",
        "(defmacro of-lock ())",
        "(defvar of-lock)",
        "(defclass of-lock () ())",
        "of-new",
    ],
)
def test_a_lock_does_not_hold_in_the_package_itself(lisp, form):
    """Real SBCL 2.2.9 defines each of them without a word, and refuses them from another package."""
    lisp("(progn (when (find-package :own) (sb-ext:unlock-package :own) (delete-package :own)) (make-package :own :use '(:cl))"
         " (intern \"OF-LOCK\" :own) (sb-ext:lock-package :own))")  # fmt: skip
    refused = f'(handler-case (eval (read-from-string "{form.replace("of-", "own::of-")}")) (package-error () :refused))'
    assert lisp(refused) is lisp(":refused")
    assert lisp(
        f'(let ((*package* (find-package :own))) (eval \'(quote #.(let ((*package* (find-package :own))) (read-from-string "(progn {form.replace("of-new", "nil")})")))) :done)'
    ) is lisp(":done")
