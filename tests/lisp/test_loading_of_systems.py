"""How systems are loaded: for SBCL or another Lisp, by methods of ``perform``, as their packages say."""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.compiler import support
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string


def logging(text):
    return f"(push {text} cl-user::*log*)"


AS_ASKED = "#+sbcl (push :as-sbcl cl-user::*log*) #-sbcl (push :as-another cl-user::*log*)"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("#+sbcl (sb-ext:gc)", ":AS-SBCL"),
        (f"'({'(' * 3000}a{')' * 3000}) #+sbcl (sb-ext:gc)", ":AS-SBCL"),
        ("#+sbcl (defun of-kernel () (sb-kernel:no-such-thing))", ":AS-ANOTHER"),
        ("#+sbcl (defun of-kernel () (sb-ext::no-such-thing))", ":AS-ANOTHER"),
        ("#-sbcl (defun of-kernel () (sb-kernel:no-such-thing))", ":AS-SBCL"),
        ("#+(and sbcl no-such) (sb-kernel:no-such-thing)", ":AS-SBCL"),
        ("#+sbcl (defpackage :of-sbcl-1 (:use :cl #+sbcl #:sb-gray))", ":AS-SBCL"),
        ("#+sbcl (defpackage :of-sbcl-2 (:use :cl #+sbcl #:sb-no-such))", ":AS-ANOTHER"),
        ('#+sbcl (defpackage :of-sbcl-3 (:use "CL") (:import-from :sb-ext #:no-such-thing))', ":AS-ANOTHER"),
        ("#+sbcl (defpackage :of-sbcl-4 (:use :cl) (:import-from #:sb-ext #:gc))", ":AS-SBCL"),
        ('#| sb-kernel:no-such |# ; sb-kernel:no-such\n (list "sb-kernel:no-such" \'#.(+ 1 2) #p"x" #xff #c(1 2) \'|sb-x:y|)', ":AS-SBCL"),
        ("#+sbcl (defvar *c* '(#1=(a . #1#) #2=(#2# b) . #3=(:use . #3#)))", ":AS-SBCL"),
        ("#+sbcl (defvar *c* '#1=((:import-from sb-kernel . #2=(no-such . #2#)) . #1#))", ":AS-ANOTHER"),
        ("#+no-such #~what #+sbcl (defun of-kernel () (sb-kernel:no-such-thing))", ":AS-ANOTHER"),
    ],
    ids=lambda value: None,
)
def test_a_file_is_read_for_sbcl_if_it_then_names_only_what_is_here(write, run, text, read):
    """Those before and behind it say nothing of SBCL here, and see no feature."""
    write("for-all.asd", '(defsystem "for-all" :depends-on ("for-one") :components ((:file "for-all-x")))')
    write("for-one.asd", '(defsystem "for-one" :depends-on ("for-first") :components ((:file "for-one-x")))')
    write("for-first.asd", '(defsystem "for-first" :components ((:file "for-first-x")))')
    write("for-one-x.lisp", f"{text}\n{AS_ASKED}")
    for name in ("all", "first"):
        write(
            f"for-{name}-x.lisp",
            f'(push (if (find (format nil "SB~a" :cl) *features* :test #\'string=) :{name}-too :{name}) cl-user::*log*)',
        )
    assert run("(asdf:load-system :for-all) (reverse *log*)") == f"(:FIRST {read} :ALL)"


DEFINITIONS = {
    "components": ('(:file "of-d") #+sbcl (:file "of-a") #-sbcl (:file "of-b")', "", "(:D :A)"),
    "feature of a component": ('(:file "of-d") (:file "of-a" :if-feature :sbcl) (:file "of-b" :if-feature (:not :sbcl))', "", "(:D :A)"),
    "what is not had": ('(:file "of-d") #+sbcl (:file "of-c") #-sbcl (:file "of-b")', "", "(:D :B)"),
    "part that is not had": ('(:file "of-d") #+sbcl (:file "of-a") #-sbcl (:file "of-b")', "#+sbcl :sb-no-such", "(:D :B)"),
    "part that is not had, as a feature": ('(:file "of-d")', "(:feature :sbcl (:require :sb-no-such))", "(:D)"),
}


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("case", DEFINITIONS)
def test_the_definition_of_a_system_is_read_as_its_files_are(write, run, case):
    components, needed, expected = DEFINITIONS[case]
    write("of-sbcl.asd", f'(defsystem "of-sbcl" :depends-on ({needed}) :components ({components}))')
    for name in "abd":
        write(f"of-{name}.lisp", logging(f":{name}"))
    write("of-c.lisp", "(sb-kernel:no-such-thing)")
    assert run("(asdf:load-system :of-sbcl) (reverse *log*)") == expected


def test_a_system_that_is_only_for_lisps_that_it_knows_is_read_for_sbcl(write, run):
    write("only-known.asd", '#+(or sbcl cmu) (defsystem "only-known" :components ((:file "known-x")))')
    write("known-x.lisp", f"{AS_ASKED} (defun never () #+sbcl (when nil (sb-ext::no-such-thing)))")
    assert run("(asdf:load-system :only-known) *log*") == "(:AS-ANOTHER)"


def test_an_asd_file_may_refuse_lisps_that_it_does_not_know(write, run):
    write("refuses.asd", '#-(or allegro sbcl) (error "Another Lisp, please.") (defsystem "refuses" :components ((:file "refuses-x")))')
    write("refuses-x.lisp", AS_ASKED)
    assert run("(asdf:load-system :refuses) *log*") == "(:AS-SBCL)"


def test_features_that_a_system_read_for_sbcl_adds_stay(write, run):
    write("adds.asd", '(defsystem "adds" :components ((:file "adds-x")))')
    write("adds-x.lisp", "#+sbcl (sb-ext:gc) (pushnew :added-by-adds *features*)")
    assert run("(let ((before *features*)) (asdf:load-system :adds) (equal *features* (cons :added-by-adds before)))") == "T"
    run("(setf *features* (remove :added-by-adds *features*))")


def test_who_asks_for_sbcl_is_told_which_systems_are_read_without_it(write, run, capsys):
    write("without.asd", '(defsystem "without" :components ((:file "without-x")))')
    write("without-x.lisp", f"#+sbcl (list 'sb-kernel::a 'sb-kernel::b 'sb-kernel::c 'sb-kernel::d 'sb-ext:gc) {AS_ASKED}")
    assert run("(let ((*features* (cons :sbcl *features*))) (asdf:load-system :without)) *log*") == "(:AS-ANOTHER)"
    assert capsys.readouterr().err == (
        "; without-x.lisp of the system without is read without the feature SBCL: SB-KERNEL:A, SB-KERNEL:B, SB-KERNEL:C and 1 more"
        " cannot be had here.\n"
    )


PERFORMED = {
    "after loading a system": (
        '(defsystem "performed" :components ((:file "p-a")))'
        "(defmethod asdf:perform :after ((o asdf:load-op) (c (eql (asdf:find-system :performed)))) (push :after cl-user::*log*))",
        "(:A :AFTER)",
    ),
    "in the definition of a file": (
        '(defsystem "performed" :components ((:file "p-a" :perform (load-op :before (o c) (push (component-name c) cl-user::*log*)))))',
        '("p-a" :A)',
    ),
    "around compiling a class of files": (
        "(defclass own-source (asdf:cl-source-file) ())"
        "(defmethod asdf:perform :around ((o asdf:compile-op) (c own-source))"
        " (let ((*read-base* 16)) (push :around cl-user::*log*) (call-next-method)))"
        '(defsystem "performed" :components ((:own-source "p-number")))',
        "(:AROUND 255)",
    ),
    "instead of compiling": (
        "(defclass not-compiled (asdf:cl-source-file) ()) (defmethod asdf:perform ((o asdf:compile-op) (c not-compiled)) nil)"
        '(defsystem "performed" :default-component-class not-compiled :components ((:file "p-a")))',
        "(:A)",
    ),
    "of data": (
        "(defclass data (asdf:static-file) ())"
        "(defmethod asdf:perform ((o asdf:load-op) (c data)) (push (pathname-type (asdf:component-pathname c)) cl-user::*log*))"
        '(defsystem "performed" :components ((:file "p-a") (:data "x.txt") (:static-file "y.txt")))',
        '(:A "txt")',
    ),
    "where the program puts a class of files": (
        "(defclass in-folder (asdf:cl-source-file) ())"
        "(defmethod asdf:component-pathname ((c in-folder))"
        ' (merge-pathnames (make-pathname :directory (list :relative "there")) (call-next-method)))'
        '(defsystem "performed" :components ((:in-folder "p-there")))',
        "(:THERE)",
    ),
    "with a type of the program": (
        '(defclass cl-file (asdf:cl-source-file) ((type :initform "cl"))) (defsystem "performed" :components ((:cl-file "p-cl")))',
        "(:CL)",
    ),
    "with a type that a method tells": (
        '(defclass typed (asdf:cl-source-file) ()) (defmethod asdf:source-file-type ((c typed) (s asdf:module)) "cl")'
        '(defsystem "performed" :components ((:typed "p-cl")))',
        "(:CL)",
    ),
    "around compiling, by a hook": (
        '(defsystem "performed" :around-compile (lambda (next) (let ((*read-base* 16)) (funcall next))) :components ((:file "p-number")))',
        "(255)",
    ),
    "around compiling, by the name of a hook": (
        "(defun cl-user::hook (next) (push :hook cl-user::*log*) (funcall next))"
        '(defsystem "performed" :components ((:module "m" :pathname "" :around-compile "cl-user::hook" :components ((:file "p-a")))))',
        "(:HOOK :A)",
    ),
    "around compiling, by a hook that checks": (
        "(defun cl-user::checked (file &rest keys) (push (list (pathname-name file) (first keys)) cl-user::*log*))"
        "(defun cl-user::hook (next) (funcall next :compile-check 'cl-user::checked))"
        '(defsystem "performed" :around-compile "cl-user::hook" :components ((:file "p-a")))',
        '(:A ("p-a" :OUTPUT-FILE))',
    ),
    "around compiling, by a hook whose check refuses": (
        "(defun cl-user::hook (next) (handler-case (funcall next :compile-check (constantly nil)) (error () (push :refused cl-user::*log*))))"
        '(defsystem "performed" :around-compile "cl-user::hook" :components ((:file "p-a")))',
        "(:A :REFUSED)",
    ),
}


@pytest.mark.parametrize("case", PERFORMED)
def test_methods_of_perform_take_part_in_loading(write, run, case):
    definition, expected = PERFORMED[case]
    write("performed.asd", definition)
    for name, text in {"a.lisp": ":a", "number.lisp": "FF", "cl.cl": ":cl"}.items():
        write(f"p-{name}", logging(text))
    write("x.txt", "data")
    write("there/p-there.lisp", logging(":there"))
    assert run("(asdf:load-system :performed) (asdf:load-system :performed) (reverse *log*)") == expected


def test_operations_of_the_program(write, run):
    write(
        "operated.asd",
        """(defclass document-op (asdf:operation) ((style :initarg :style :initform :short :accessor style)))
(defsystem "operated" :components ((:file "o-a")))
(defmethod asdf:perform ((o document-op) (c asdf:system)) (push (list (asdf:component-name c) (style o)) cl-user::*log*))""",
    )
    write("o-a.lisp", logging(":a"))
    assert run("(asdf:find-system :operated) (asdf:operate 'asdf-user::document-op :operated) *log*") == '(("operated" :SHORT) :A)'
    assert run("(asdf:oos (asdf:make-operation 'asdf-user::document-op) :operated) (first *log*)") == '("operated" :SHORT)'


def test_a_package_inferred_system_loads_the_files_of_its_packages(write, run):
    """ASDF manual, section 6.5: each file is a system of its own, and its ``defpackage`` says what it depends on."""
    write("inferred.asd", '(defsystem "inferred" :class :package-inferred-system :depends-on ("inferred/main"))')
    write("main.lisp", f"(defpackage :inferred/main (:use :cl :inferred/sub/one) (:import-from #:inferred/two)) {logging(':main')}")
    write("sub/one.lisp", f"(uiop:define-package :inferred/sub/one (:mix :cl :other)) {logging(':one')}")
    write("two.lisp", f"(defpackage :inferred/two (:use :cl)) {logging(':two')}")
    write(
        "other-system.asd", '(asdf:register-system-packages "other-system" \'(:other)) (defsystem "other-system" :components ((:file "o")))'
    )
    write("o.lisp", f"(defpackage :other (:use :cl)) {logging(':other')}")
    assert run("(asdf:find-system :other-system) (asdf:load-system :inferred) (reverse *log*)") == "(:OTHER :ONE :TWO :MAIN)"


@pytest.mark.parametrize(
    ("form", "value"),
    [
        ('(asdf:coerce-name "X")', '"X"'),
        ("(asdf:coerce-name :some-name)", '"some-name"'),
        ('(asdf:primary-system-name "a/b/c")', '"a"'),
        ("(asdf:operation-done-p 'asdf:load-op (asdf:find-system :asked))", "NIL"),
        ("(mapcar #'asdf:component-name (asdf:required-components :asked))", '("needed" "asked")'),
        ("(mapcar #'asdf:component-name (mapcar #'cdr (asdf:traverse 'asdf:load-op :asked)))", '("q-a" "q-b")'),
        ("(asdf:component-depends-on (asdf:make-operation 'asdf:load-op) (asdf:find-system :asked))", '((ASDF:LOAD-OP "needed"))'),
        ('(asdf:component-sideway-dependencies (asdf:find-component :asked \'("m" "q-b")))', '("q-a")'),
        ('(asdf:component-find-path (asdf:find-component :asked \'("m" "q-b")))', '("asked" "m" "q-b")'),
        ('(namestring (asdf:component-relative-pathname (asdf:find-component :asked \'("m" "q-b"))))', '"q-b.lisp"'),
        (
            '(pathname-name (first (asdf:input-files (asdf:make-operation \'asdf:compile-op) (asdf:find-component :asked \'("m" "q-b")))))',
            '"q-b"',
        ),
        ('(asdf:source-file-type (asdf:find-component :asked \'("m" "q-b")) (asdf:find-system :asked))', '"lisp"'),
        ("(asdf:system-homepage (asdf:find-system :asked))", '"there"'),
        ("(let ((s (asdf:find-system :asked))) (setf (asdf:component-property s :p) 7) (asdf:component-property s :p))", "7"),
        ("(pathname-name (asdf:system-definition-pathname :asked))", '"asked"'),
        ("(and (asdf:registered-system :asked) (asdf:system-registered-p :no-such-system) t)", "NIL"),
        ('(let (n) (asdf:map-systems (lambda (s) (push (asdf:component-name s) n))) (and (find "asked" n :test #\'string=) t))', "T"),
        ("(handler-case (asdf:find-system :no-such-system) (asdf:system-definition-error () :error))", ":ERROR"),
        ("(subtypep 'asdf:program-op 'asdf:operation)", "T"),
        (
            "(handler-case (asdf:operate 'asdf:program-op :asked) (error (e) (princ-to-string e)))",
            '"PROGRAM-OP of the system asked writes a file of machine code, and cramhy makes none. (asdf:load-system \\"asked\\") loads it."',
        ),
    ],
)
def test_what_asdf_tells_of_systems_and_operations(write, run, form, value):
    write("needed.asd", '(defsystem "needed")')
    write(
        "asked.asd",
        '(defsystem "asked" :depends-on ("needed") :homepage "there" :components'
        ' ((:module "m" :components ((:file "q-a") (:file "q-b" :depends-on ("q-a"))))))',
    )
    write("m/q-a.lisp", "")
    write("m/q-b.lisp", "")
    assert run(f"(asdf:find-system :asked) {form}").replace("\n", " ").replace("  ", " ") == value


@pytest.mark.parametrize(
    "name", ["uiop/package:define-package", "uiop/utility:if-let", "asdf/system:system", "asdf/find-system:find-system"]
)
def test_the_parts_of_asdf_and_uiop_have_packages(run, name):
    assert run(f"(eq '{name} '{name.partition('/')[0]}:{name.partition(':')[2]})") == "T"


def test_a_class_of_systems_has_options_by_default(write, run):
    write(
        "defaults.asd",
        """(defclass own-file (asdf:cl-source-file) ())
(defclass own-system (asdf:system) ((extra :initarg :extra :initform 1 :accessor extra))
  (:default-initargs :version "2.1" :author "Who" :default-component-class 'own-file :extra 5))
(defsystem "defaults" :class own-system :author "Somebody" :components ((:file "d-a")))""",
    )
    write("d-a.lisp", logging(":a"))
    assert (
        run(
            """(asdf:load-system :defaults) (let ((s (asdf:find-system :defaults)))
          (list (asdf:component-version s) (asdf:system-author s) (asdf-user::extra s) (type-of s) (mapcar #'type-of (asdf:component-children s))))"""
        ).replace("\n ", "")
        == '("2.1" "Somebody" 5 ASDF-USER::OWN-SYSTEM (ASDF-USER::OWN-FILE))'
    )


def test_features_that_only_the_first_reading_of_a_definition_adds_are_gone(write, run):
    write(
        "added-first.asd",
        "#+sbcl (pushnew :first-reading *features*)"
        '(defsystem "added-first" :components (#+first-reading (:file "no-such") #+sbcl (:file "of-c") (:file "f-a")))',
    )
    write("of-c.lisp", "(sb-kernel:no-such-thing)")
    write("f-a.lisp", logging(":a"))
    assert run("(asdf:load-system :added-first) (list *log* (uiop:featurep :first-reading))") == "((:A) NIL)"


def test_the_slot_relative_pathname(write, run):
    write("lies.asd", '(defsystem "lies" :components ((:module "m" :pathname "in/there/" :components ((:file "l-a")))))')
    assert run('(namestring (slot-value (asdf:find-component :lies "m") \'asdf::relative-pathname))') == '"in/there"'
    assert run("(equal (slot-value (asdf:find-system :lies) 'asdf::relative-pathname) (asdf:system-source-directory :lies))") == "T"


def test_sizes_and_the_order_of_bytes_as_sbcl_has_them(run):
    assert (
        run("(list sb-vm:n-word-bits sb-vm:n-byte-bits (constantp 'sb-vm:n-word-bits) sb-c:*backend-byte-order*)")
        == "(64 8 T :LITTLE-ENDIAN)"
    )


def test_the_files_of_a_definition_that_is_read_for_another_lisp_are_so_too(write, run):
    """The file that is only for SBCL is left out, and the others do not count on it."""
    write("both-ways.asd", '(defsystem "both-ways" :components (#+sbcl (:file "of-c") (:file "both-x")))')
    write("of-c.lisp", "(sb-kernel:no-such-thing)")
    write("both-x.lisp", AS_ASKED)
    assert run("(asdf:load-system :both-ways) *log*") == "(:AS-ANOTHER)"


@pytest.mark.parametrize("kind, suffix", [("cl-source-file.cl", "cl"), ("cl-source-file.lsp", "lsp"), ("own-cl", "cl")])
def test_files_of_lisp_may_have_other_suffixes(write, run, kind, suffix):
    write(
        "suffixed.asd",
        f"(defclass own-cl (asdf:cl-source-file.cl) ()) (defsystem suffixed :default-component-class {kind} :components"
        ' ((:file "s-one") (:cl-source-file "s-two")))',
    )
    write(f"s-one.{suffix}", logging(":one"))
    write("s-two.lisp", logging(":two"))
    assert run("(asdf:load-system :suffixed) (reverse *log*)") == "(:ONE :TWO)"


@pytest.mark.parametrize("end", ["", '#-sbcl (error "Only for the Lisps that it knows.")'], ids=["before it", "before and behind it"])
def test_a_definition_that_refuses_other_lisps_is_read_for_sbcl(write, run, end):
    """Its files name what is not here, so it would be read for a Lisp that it does not know, and it signals an error then."""
    text = '(defsystem "known-lisps" :components (#+sbcl (:file "k-sbcl") (:file "k-a")))'
    write("known-lisps.asd", text + end if end else '#-(or ecl sbcl) (error "This is an unsupported Lisp.")' + text)
    write("k-sbcl.lisp", "(when (find-package :no-such-package) (sb-kernel::no-such-thing))" + logging(":sbcl"))
    write("k-a.lisp", logging(":a"))
    assert run("(asdf:load-system :known-lisps) (reverse *log*)") == "(:SBCL :A)"


def test_babel_is_loaded_when_a_user_of_cffi_names_it(write, run, session):
    """The original's CFFI depends on it, so its users do not name the system."""
    write("babel.asd", '(defsystem "babel" :components ((:file "strings")))')
    write("strings.lisp", "(defpackage :babel (:use :cl) (:export #:octets)) (defun babel:octets (text) (map 'list #'char-code text))")
    write("calls-c.asd", '(defsystem "calls-c" :depends-on ("cffi") :components ((:file "c-a")))')
    write("c-a.lisp", f"(defun text-for-c (text) (babel:octets text)) {logging('(text-for-c ' + chr(34) + 'ab' + chr(34) + ')')}")
    assert run("(asdf:load-system :calls-c) *log*") == "((97 98))"
    session.evaluate_text("(delete-package :babel)", "<test>")


def test_babel_that_is_nowhere(run):
    assert run('(handler-case (read-from-string "babel:octets") (error (c) (princ-to-string c)))') == '"Package BABEL does not exist."'


@pytest.mark.parametrize("name", ["ASDF-UTILS", "ASDF-DRIVER"])
def test_what_uiop_was_called_once(run, name):
    """Under these names ASDF 2.27 to 3.1 had it, and files of that time call functions in it."""
    assert run(f"(eq (find-package :{name}) (find-package :uiop))") == "T"


def test_the_file_of_a_system_is_compiled_where_it_lies(write, run):
    """Programs ask so for files beside theirs, when they are read, when macros are expanded, or when they run."""
    write("beside.asd", '(defsystem "beside" :components ((:file "b-a")))')
    asked = "(defmacro here () (file-namestring *compile-file-pathname*))" + logging("#.(pathname-name *compile-file-truename*)")
    path = write("b-a.lisp", asked + logging("(here)") + logging("(equal *compile-file-truename* (or *load-truename* 1))"))
    assert run("(asdf:load-system :beside) (reverse *log*)") == '("b-a" "b-a.lisp" T)'
    assert run("(list *compile-file-truename* *compile-file-pathname*)") == "(NIL NIL)"
    assert run(f'(setf *log* nil) (handler-case (load "{path}") (error () :not-compiled))') == ":NOT-COMPILED"


def test_a_kept_call_of_a_standard_function_that_is_generic_by_now(session):
    """CLOSE with a keyword is called as Python's function when nobody has methods on it. Code that was kept so meets a generic function."""
    close = sym("CLOSE")
    assert support.python_function(close) is close.function.python
    made = GenericFunction(close, "(stream &key abort)")
    made.method(None)(lambda stream, *, abort=None: lisp_list(stream, abort))
    known, close.function = close.function, made
    try:
        assert prin1_to_string(support.python_function(close)(sym(":BOX"), abort=True)) == "(:BOX T)"
    finally:
        close.function = known


def test_methods_on_functions_of_streams_before_anybody_names_sb_gray(session):
    """The first of them brings SB-GRAY, which says how these functions are opened."""
    text = """(defclass cl-user::lamp () ())
      (defmethod close ((s cl-user::lamp) &key abort) (list :off abort))
      (defmethod stream-element-type ((s cl-user::lamp)) 'cl-user::photon)
      (defmethod open-stream-p ((s cl-user::lamp)) :lit)
      (let ((l (make-instance 'cl-user::lamp)) (s (make-string-input-stream "")))
        (list (close l :abort t) (stream-element-type l) (open-stream-p l) (open-stream-p s) (close s :abort t) (typep #'close 'generic-function)))"""
    session.package = "CL-USER"
    assert prin1_to_string(session.evaluate_text(text, "<test>")[0]) == "((:OFF T) PHOTON :LIT T T T)"
