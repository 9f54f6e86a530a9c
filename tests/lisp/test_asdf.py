"""ASDF: what ``defsystem`` may say, and what users do with systems by hand."""

from __future__ import annotations

import pytest

from cramhy_runtime.ground.conditions import Condition
from cramhy_runtime.ground.packages import sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.systems import systems


@pytest.fixture
def write(tmp_path, session, monkeypatch):
    """A function: write a file below the folder in which systems are found."""
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(tmp_path)])
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    session.package = "CL-USER"
    before = dict(systems.systems)
    log = sym("CL-USER::*LOG*")
    log.special, log.value = True, None

    def writing(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    yield writing
    for name in set(systems.systems) - set(before):
        systems.forget_system(name)


@pytest.fixture
def run(write, session):
    """A function: the printed value of the last form of a text."""
    return lambda text: prin1_to_string(session.evaluate_text(text, "<test>")[0])


def logging(text):
    return f"(push {text} cl-user::*log*)"


def test_the_tests_of_a_system(write, run):
    write(
        "tested.asd",
        """(in-package :asdf-user)
(defsystem "tested" :components ((:file "tested-a")) :in-order-to ((test-op (test-op "tested/tests"))))
(defsystem "tested/tests" :depends-on ("tested") :components ((:file "tested-b"))
  :perform (test-op (o c) (symbol-call :tested-b :run-them (component-name c)))
  :perform (test-op :after (o c) (push :after cl-user::*log*)))""",
    )
    write("tested-a.lisp", logging(":a"))
    write("tested-b.lisp", "(defpackage :tested-b (:use :cl)) (in-package :tested-b) (defun run-them (x) (push x cl-user::*log*))")
    assert run("(asdf:test-system :tested) (reverse *log*)") == '(:A "tested/tests" :AFTER)'
    assert (
        run('(setf *log* nil) (asdf:operate \'asdf:test-op "tested/tests") (asdf:oos :test-op :tested/tests) (reverse *log*)')
        == '("tested/tests" :AFTER "tested/tests" :AFTER)'
    )


def test_a_method_on_perform(write, run):
    write(
        "performing.asd",
        """(defsystem "performing")
(defmethod asdf:perform ((o asdf:test-op) (s (eql (asdf:find-system "performing")))) (push (asdf:component-name s) cl-user::*log*))""",
    )
    assert run('(asdf:test-system "performing") *log*') == '("performing")'


def test_what_a_system_knows_of_itself(write, run):
    write(
        "known/known.asd",
        """(defsystem "known" :version "1.2.3" :author "A" :maintainer "M" :licence "BSD" :description "d"
  :long-description "ld" :pathname "src" :depends-on ("alexandria")
  :components ((:module "m" :components ((:file "x") (:static-file "y.txt")))))""",
    )
    write("known/src/m/x.lisp", logging(":x"))
    assert (
        run("""(let ((s (asdf:find-system :known)))
      (list (asdf:component-name s) (asdf:component-version s) (asdf:system-author s) (asdf:system-license s) (asdf:system-description s)
            (asdf:system-long-description s) (asdf:system-maintainer s) (asdf:system-depends-on s)))""")
        == '("known" "1.2.3" "A" "BSD" "d" "ld" "M" ("alexandria"))'
    )
    assert run("(asdf:find-system :known)") == '#<ASDF/SYSTEM:SYSTEM "known">'
    assert run("(list (typep (asdf:find-system :known) 'asdf:system) (asdf:component-loaded-p :known))") == "(T NIL)"
    folder = run("(namestring (asdf:system-source-directory :known))").strip('"')
    assert folder.endswith("/known/")
    assert run('(namestring (asdf:system-relative-pathname :known "data/map.yaml"))') == f'"{folder}data/map.yaml"'
    assert run('(namestring (asdf:component-pathname (asdf:find-component :known \'("m" "x"))))') == f'"{folder}src/m/x.lisp"'
    assert run("(namestring (asdf:system-source-file :known))") == f'"{folder}known.asd"'
    assert run("(mapcar #'asdf:component-name (asdf:component-children (asdf:find-component :known :m)))") == '("x" "y.txt")'
    assert run("(asdf:load-system :known) (list *log* (asdf:component-loaded-p :known))") == "((:X) T)"


def test_features_and_versions(write, run):
    write(
        "newer.asd",
        '(defsystem "newer" :version "2.1" :components ((:file "newer-x" :if-feature :cramhy) (:file "no" :if-feature (:not :cramhy))))',
    )
    write("newer-x.lisp", logging(":newer"))
    write(
        "asks.asd",
        '(defsystem "asks" :depends-on ((:version "newer" "2.0.5") (:feature :no-such "nothing") (:version :cram-language "9")))',
    )
    write("too-new.asd", '(defsystem "too-new" :depends-on ((:version "newer" "3")))')
    assert run("(asdf:load-system :asks) *log*") == "(:NEWER)"
    with pytest.raises(Condition) as caught:
        run("(asdf:load-system :too-new)")
    assert caught.value.report() == 'Component "newer" does not match version 3, required by #<SYSTEM "too-new">'
    assert run('(list (asdf:version-satisfies "2.10" "2.9") (asdf:version-satisfies (asdf:find-system :newer) "2.2"))') == "(T NIL)"


def test_an_asd_file_in_the_package_asdf(write, run):
    write(
        "older.asd",
        """(in-package :asdf)
(pushnew :older-system cl:*features*)
(defsystem :older :components ((:file "older-x")))
(defmethod perform ((o test-op) (c (eql (find-system :older)))) (push :tested cl-user::*log*))""",
    )
    write("older-x.lisp", "#+older-system " + logging(":older"))
    assert run("(asdf:oos 'asdf:load-op :older) (asdf:operate 'asdf:test-op :older) (reverse *log*)") == "(:OLDER :TESTED)"


def test_the_version_may_stand_in_a_file(write, run):
    write("filed.asd", '(defsystem "filed" :version (:read-file-form "version.sexp"))')
    write("version.sexp", ';; the version\n"0.7"\n')
    assert run("(asdf:component-version (asdf:find-system :filed))") == '"0.7"'


def test_a_definition_that_depends_on_a_system(write, run):
    write("early.asd", '(defsystem "early" :components ((:file "early-x")))')
    write("early-x.lisp", logging(":early"))
    write("later.asd", '(defsystem "later" :defsystem-depends-on ("early") :components ((:file "later-x")))')
    write("later-x.lisp", logging(":later"))
    assert run("(asdf:load-system :later) (reverse *log*)") == "(:EARLY :LATER)"


def test_the_central_registry_and_load_asd(write, run, tmp_path, monkeypatch):
    write("hidden/CATKIN_IGNORE", "")
    write("hidden/build/registered.asd", '(defsystem "registered" :components ((:file "x")))')
    write("hidden/build/x.lisp", logging(":registered"))
    assert run("(asdf:find-system :registered nil)") == "NIL"
    assert run(f'(push #p"{tmp_path}/hidden/build/" asdf:*central-registry*) (asdf:load-system :registered) *log*') == "(:REGISTERED)"
    run("(pop asdf:*central-registry*)")
    run("(asdf:clear-system :registered)")
    assert run("(asdf:find-system :registered nil)") == "NIL"
    run(f'(asdf:load-asd "{tmp_path}/hidden/build/registered.asd")')
    assert run('(count "registered" (asdf:registered-systems) :test #\'equal)') == "1"


def test_quickload_says_what_it_is(write, run, capsys):
    write("quick.asd", '(defsystem "quick")')
    assert run('(ql:quickload "quick")') == '("quick")'
    assert capsys.readouterr().out.endswith('; Loading "quick" with asdf:load-system; cramhy downloads nothing.\n')


def test_an_asd_file_that_did_not_change_is_not_read_again(write, run):
    path = write("once.asd", '(push :read cl-user::*log*) (defsystem "once")')
    assert run("(asdf:load-system :once) (asdf:load-system :once) *log*") == "(:READ)"
    path.write_text('(push :again cl-user::*log*) (defsystem "once" :version "2")')
    assert run("(asdf:component-version (asdf:find-system :once))") == '"2"'


def test_load_truename_in_an_asd_file(write, run):
    write("place.asd", '(push (pathname-name *load-truename*) cl-user::*log*) (defsystem "place")')
    assert run("(asdf:load-system :place) *log*") == '("place")'


def test_functions_of_uiop(write, run, tmp_path, monkeypatch):
    monkeypatch.setenv("CRAMHY_TEST", "value")
    write("lines.txt", "(a b)\nsecond")
    assert (
        run(
            '(list (uiop:getenv "CRAMHY_TEST") (uiop:getenv "CRAMHY_NO_SUCH") (uiop:split-string "a.b.c" :separator ".")'
            ' (uiop:split-string "a.b.c" :max 2 :separator ".") (uiop:strcat "a" nil "b") (uiop:string-prefix-p "ab" "abc"))'
        )
        == '("value" NIL ("a" "b" "c") ("a.b" "c") "ab" T)'
    )
    path = f"{tmp_path}/lines.txt"
    assert (
        run(f'(list (uiop:read-file-lines "{path}") (uiop:read-file-form "{path}") (uiop:file-exists-p "{path}x"))')
        == '(("(a b)" "second") (A B) NIL)'
    )
    assert run("(uiop:symbol-call :cl :+ 1 2)") == "3"


@pytest.mark.parametrize(
    "asd, text",
    [
        (":perform (test-op)", ":PERFORM is (operation (o c) form ...), not (ASDF:TEST-OP)"),
        (":perform (fly-op (o c) 1)", "unknown operation ASDF-USER::FLY-OP; there are load-op,"),
        (':in-order-to (test-op "x")', ":IN-ORDER-TO is a list of (operation (operation system ...) ...)"),
        (':depends-on ((:versio "x" "1"))', "a system to depend on is a name"),
        (":depends-on (5)", "a system to depend on is a name"),
    ],
)
def test_malformed_options(write, run, asd, text):
    write("malformed.asd", f'(defsystem "malformed" {asd})')
    with pytest.raises(Condition) as caught:
        run("(asdf:load-system :malformed)")
    assert text in caught.value.report()


def test_what_cannot_be_had_says_why(write, run):
    write("wants-c.asd", '(defsystem "wants-c" :depends-on ("osicat"))')
    with pytest.raises(Condition) as caught:
        run("(asdf:load-system :wants-c)")
    assert caught.value.report() == 'Component "osicat" not found, required by #<SYSTEM "wants-c">'
    assert caught.value.hint.startswith("osicat cannot be had in cramhy: it calls functions of C")


@pytest.mark.parametrize("name", sorted(systems.LEFT_OUT))
def test_systems_of_cram_that_are_left_out_are_empty(write, run, name):
    write("lists.asd", f'(defsystem "lists" :depends-on ("{name}"))')
    assert run("(asdf:load-system :lists)") == "T"
    assert run(f'(asdf:system-description (asdf:find-system "{name}" nil))') == f'"{systems.LEFT_OUT[name]}"'


def test_a_system_of_that_name_that_one_has_is_taken_before_the_empty_one(write, run):
    write("cl-glx.asd", '(defsystem "cl-glx" :components ((:file "of-mine")))')
    write("of-mine.lisp", "(defparameter cl-user::*glx* 5)")
    assert run("(progn (asdf:load-system :cl-glx) cl-user::*glx*)") == "5"


def test_a_system_that_is_not_in_its_file(write, run, tmp_path):
    write("primary.asd", '(defsystem "primary") (defsystem "primary/extra")')
    with pytest.raises(Condition) as caught:
        run('(asdf:load-system "primary/extras")')
    assert caught.value.hint.startswith(f"{tmp_path}/primary.asd defines primary, primary/extra.")


def test_an_unknown_operation(run):
    with pytest.raises(Condition) as caught:
        run("(asdf:operate 'test-opp :alexandria)")
    assert caught.value.report() == "There is no operation TEST-OPP for systems; did you mean TEST-OP?"


def test_an_error_in_a_test_leaves_the_system_usable(write, run):
    write("erring.asd", '(defsystem "erring" :perform (test-op (o c) (error "tests failed")))')
    for _ in range(2):
        with pytest.raises(Condition) as caught:
            run("(asdf:test-system :erring)")
        assert caught.value.report() == "tests failed"


def test_systems_that_are_part_of_cramhy_may_be_depended_on(write, run):
    write(
        "leaning.asd",
        """(defsystem "leaning" :depends-on ("asdf" "uiop" (:version "trivial-features" "0.1"))
      :components ((:doc-file "README.md") (:html-file "index.html") (:file "leaning")))""",
    )
    write("leaning.lisp", "(push #+(and (or little-endian big-endian) (or 64-bit 32-bit)) :leaning cl-user::*log*)")
    assert run("(asdf:load-system :leaning) *log*") == "(:LEANING)"
    assert (
        run("""(mapcar (lambda (part) (list (typep part 'asdf:doc-file) (typep part 'asdf:static-file) (typep part 'asdf:html-file)))
                          (asdf:component-children (asdf:find-system :leaning)))""")
        == "((T T NIL) (T T T) (NIL NIL NIL))"
    )


def test_the_arguments_of_the_command_line(run):
    assert run('(let ((uiop:*command-line-arguments* \'("a"))) (uiop:command-line-arguments))') == '("a")'
    assert run("(every #'stringp uiop:*command-line-arguments*)") == "T"


FUNCTIONS_WITH_METHODS = """component-name component-pathname component-version component-parent component-system component-children
    component-loaded-p find-system find-component system-source-file system-description system-author system-license system-depends-on
    version-satisfies""".split()


@pytest.mark.parametrize("name", FUNCTIONS_WITH_METHODS)
def test_the_functions_of_asdf_take_methods(run, name):
    """For a class of the program's own; what they say of systems stays as it was."""
    lambda_list = {"find-component": "((b asdf-thing) path)", "version-satisfies": "((v asdf-thing) wanted)"}.get(name, "((c asdf-thing))")
    if name == "find-system":
        lambda_list = "((c asdf-thing) &optional e)"
    arguments = "(make-instance 'asdf-thing)" + (" nil" if name in ("find-component", "version-satisfies") else "")
    assert (
        run(f"""(defclass asdf-thing () ()) (defmethod asdf:{name} {lambda_list} :mine)
    (prog1 (list (asdf:{name} {arguments}) (asdf:component-name (asdf:find-system :roslisp)))
      (remove-method #'asdf:{name} (find (find-class 'asdf-thing) (sb-mop:generic-function-methods #'asdf:{name})
        :key (lambda (m) (first (sb-mop:method-specializers m))))))""")
        == '(:MINE "roslisp")'
    )


def test_methods_on_operate_and_perform_of_files(write, run):
    write(
        "operated.asd",
        """(defsystem "operated" :components ((:file "operated-x")))
(defmethod asdf:operate :after ((o (eql 'asdf:load-op)) (c (eql :operated)) &key) (push :after cl-user::*log*))""",
    )
    write("operated-x.lisp", logging(":x"))
    assert run("(asdf:find-system :operated) (asdf:operate 'asdf:load-op :operated) (reverse *log*)") == "(:X :AFTER)"


def test_components_of_a_class_of_the_program(write, run):
    write(
        "classed.asd",
        """(defclass own-file (asdf:cl-source-file) ())
(defclass own-data (asdf:static-file) ())
(defsystem "classed" :default-component-class own-file :components ((:file "classed-a") (:own-file "classed-b") (:own-data "d.txt")))""",
    )
    write("classed-a.lisp", logging(":a"))
    write("classed-b.lisp", logging(":b"))
    assert run("(asdf:load-system :classed) (reverse *log*)") == "(:A :B)"
    assert (
        run("(mapcar #'type-of (asdf:component-children (asdf:find-system :classed)))")
        == "(ASDF-USER::OWN-FILE ASDF-USER::OWN-FILE ASDF-USER::OWN-DATA)"
    )


def test_a_link_to_an_asd_file_is_read_where_the_file_lies(write, run, tmp_path):
    """Catkin packages have ``pkg/x.asd -> src/x.asd``, Debian ``systems/x.asd -> ../source/x/x.asd``."""
    write("real/src/linked.asd", '(defsystem "linked" :components ((:file "linked-x")))')
    write("real/src/linked-x.lisp", logging(":linked"))
    (tmp_path / "real" / "linked.asd").symlink_to("src/linked.asd")
    assert run("(asdf:load-system :linked) *log*") == "(:LINKED)"
    assert run("(namestring (asdf:system-source-directory :linked))").endswith('/real/src/"')


def test_others_may_depend_on_a_component_whose_feature_is_missing(write, run):
    write(
        "featured.asd",
        """(defsystem "featured" :components ((:file "f-no" :if-feature :no-such) (:file "f-yes" :depends-on ("f-no"))
  (:module "m" :if-feature :no-such :components ((:file "y"))) (:file "f-last" :depends-on ("m" "f-yes"))))""",
    )
    write("f-yes.lisp", logging(":yes"))
    write("f-last.lisp", logging(":last"))
    assert run("(asdf:load-system :featured) (reverse *log*)") == "(:YES :LAST)"


@pytest.mark.parametrize("name", ["dotted.test", "dotted/test", "net.example.dotted"])
def test_a_system_may_have_a_dot_in_its_name(write, run, name):
    write(
        "dotted.asd",
        '(defsystem "dotted") (defsystem "dotted.test" :components ((:file "dotted-x"))) (defsystem "dotted/test" :components ((:file "dotted-x")))',
    )
    write("net.example.dotted.asd", '(defsystem "net.example.dotted" :components ((:file "dotted-x")))')
    write("dotted-x.lisp", logging(":dotted"))
    assert run(f"(asdf:load-system {name!r}) *log*".replace("'", '"')) == "(:DOTTED)"


AS_ASKED = "#+sbcl (push :as-sbcl cl-user::*log*) #-sbcl (push :as-another cl-user::*log*)"


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("#+sbcl (sb-ext:gc)", ":AS-SBCL"),
        ("#+sbcl (defun of-kernel () (sb-kernel:no-such-thing))", ":AS-ANOTHER"),
        ("#+sbcl (defun of-kernel () (sb-ext::no-such-thing))", ":AS-ANOTHER"),
        ("#-sbcl (defun of-kernel () (sb-kernel:no-such-thing))", ":AS-SBCL"),
        ("#+(and sbcl no-such) (sb-kernel:no-such-thing)", ":AS-SBCL"),
        ("#+sbcl (defpackage :of-sbcl-1 (:use :cl #+sbcl #:sb-gray))", ":AS-SBCL"),
        ("#+sbcl (defpackage :of-sbcl-2 (:use :cl #+sbcl #:sb-no-such))", ":AS-ANOTHER"),
        ('#+sbcl (defpackage :of-sbcl-3 (:use "CL") (:import-from :sb-ext #:no-such-thing))', ":AS-ANOTHER"),
        ("#+sbcl (defpackage :of-sbcl-4 (:use :cl) (:import-from #:sb-ext #:gc))", ":AS-SBCL"),
        ('#| sb-kernel:no-such |# ; sb-kernel:no-such\n (list "sb-kernel:no-such" \'#.(+ 1 2) #p"x" #xff #c(1 2) \'|sb-x:y|)', ":AS-SBCL"),
        ("#+no-such #~what #+sbcl (defun of-kernel () (sb-kernel:no-such-thing))", ":AS-ANOTHER"),
    ],
    ids=lambda value: None,
)
def test_a_system_is_read_for_sbcl_if_it_then_names_only_what_is_here(write, run, text, read):
    """It does so for each system by itself: those before and behind it say nothing of SBCL here, and see no feature."""
    write("for-all.asd", '(defsystem "for-all" :depends-on ("for-one") :components ((:file "for-all-x")))')
    write("for-one.asd", '(defsystem "for-one" :depends-on ("for-first") :components ((:file "for-one-x") (:file "for-one-y")))')
    write("for-first.asd", '(defsystem "for-first" :components ((:file "for-first-x")))')
    write("for-one-x.lisp", text)
    write("for-one-y.lisp", AS_ASKED)
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
        "; The system without is read without the feature SBCL: it would name SB-KERNEL:A, SB-KERNEL:B, SB-KERNEL:C and 1 more, not had here.\n"
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
