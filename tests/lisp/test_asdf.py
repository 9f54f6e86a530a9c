"""ASDF: what ``defsystem`` may say, and what users do with systems by hand."""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.systems import systems


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


@pytest.mark.soak(all_but=2)
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


def test_the_ending_of_a_bundles_file_is_that_of_sbcl_on_linux(run):
    kinds = '\'(:object :shared-library :static-library :program :fasl :lib :dll :image nil "x")'
    assert run(f"(mapcar #'asdf/bundle:bundle-pathname-type {kinds})") == '("o" "so" "a" NIL "fasl" "a" "so" "image" NIL "x")'
    assert run('(handler-case (asdf:bundle-pathname-type :foo) (error () "refused"))') == '"refused"'
