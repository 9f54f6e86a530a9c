"""SBCL's packages and the libraries on them: what they do beyond what SBCL's recorded answers say (``symbols/sbcl-packages.txt``): virtual time,
tasks of plans, names that come late, features, kept code, refusals."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string


@pytest.fixture
def lisp(session):
    """A function: the printed values of the last form of a text."""
    session.package = "CL-USER"
    return lambda text: " ".join(prin1_to_string(value) for value in session.evaluate_text(text, "<test>"))


@pytest.mark.parametrize("lisp_time", ["with-timeout 3600", "sb-sys:with-deadline (:seconds 3600)"])
def test_timeouts_are_of_virtual_time(lisp, lisp_time):
    form = lisp_time if lisp_time.startswith("sb-") else f"sb-ext:{lisp_time}"
    assert lisp(f"(handler-case ({form} (sleep 100000)) (sb-ext:timeout () :over))") == ":OVER"
    assert kernel.now() == 3600


def test_the_same_seed_gives_the_same_order_of_threads(lisp):
    program = """(let ((log '()) (m (sb-thread:make-mutex)))
      (mapc #'sb-thread:join-thread
            (loop for i below 4 collect (let ((i i)) (sb-thread:make-thread (lambda ()
              (dotimes (k 3) (sb-thread:with-mutex (m) (sb-thread:thread-yield) (push i log))))))))
      (reverse log))"""
    assert lisp(program) == lisp(program) == "(0 1 2 3 0 1 2 3 0 1 2 3)"


def test_a_thread_of_a_task_ends_with_it_and_releases_its_mutex(lisp):
    assert (
        lisp("""(let ((m (sb-thread:make-mutex)) (thread nil))
      (cpl:top-level (cpl:pursue (progn (setf thread (sb-thread:make-thread (lambda () (sb-thread:with-mutex (m) (sleep 100))))) (sleep 50))
                         (sleep 1)))
      (list (sb-thread:thread-alive-p thread) (sb-thread:mutex-owner m)))""")
        == "(NIL NIL)"
    )
    assert kernel.now() == 1


def test_an_evaporated_branch_gives_its_mutex_up(lisp):
    assert (
        lisp("""(let ((m (sb-thread:make-mutex)) (q (sb-thread:make-waitqueue)))
      (cpl:top-level (cpl:pursue (sb-thread:with-mutex (m) (sb-thread:condition-wait q m)) (sb-thread:with-mutex (m) (sleep 2)) (sleep 1)))
      (sb-thread:mutex-owner m))""")
        == "NIL"
    )


@pytest.mark.parametrize(
    ("handler", "answers"),
    [("", "(:REACHED (T))"), ("(sb-sys:defer-deadline 5 c)", "((:WOKE T T) (T))"), ("(sb-sys:cancel-deadline c)", "((:WOKE T T) (T))")],
)
@pytest.mark.parametrize("timeout", ["", ":timeout 9"])
def test_a_deadline_of_a_condition_wait_is_signalled_with_the_mutex(lisp, handler, answers, timeout):
    """As by SBCL, where the wait is over then: code tests its condition again."""
    form = f"""(let ((m (sb-thread:make-mutex)) (q (sb-thread:make-waitqueue)) (held '()))
      (list (handler-case
              (handler-bind ((sb-sys:deadline-timeout (lambda (c) (push (sb-thread:holding-mutex-p m) held) c {handler})))
                (sb-thread:with-mutex (m)
                  (sb-sys:with-deadline (:seconds 1) (list :woke (sb-thread:condition-wait q m {timeout}) (sb-thread:holding-mutex-p m)))))
              (sb-sys:deadline-timeout () :reached))
            held))"""
    assert lisp(form) == answers
    assert kernel.now() == 1


def test_a_deadline_of_a_condition_wait_comes_while_another_thread_has_the_mutex(lisp):
    """Then it is signalled without the mutex, and the wait for the mutex goes on when it is deferred. The answer is SBCL's."""
    form = """(let* ((m (sb-thread:make-mutex)) (q (sb-thread:make-waitqueue)) (held '()) (thread nil))
      (handler-bind ((sb-sys:deadline-timeout (lambda (c) (push (sb-thread:holding-mutex-p m) held) (sb-sys:defer-deadline 50 c))))
        (sb-thread:with-mutex (m)
          (setf thread (sb-thread:make-thread (lambda () (sb-thread:with-mutex (m) (sleep 5)))))
          (sb-sys:with-deadline (:seconds 1) (push (sb-thread:condition-wait q m) held))
          (push (sb-thread:holding-mutex-p m) held)))
      (sb-thread:join-thread thread)
      (reverse held))"""
    assert lisp(form) == "(NIL T T)"
    assert kernel.now() == 5


@pytest.mark.parametrize("wait", ["(sb-thread:with-mutex (m) (push :late log))", "(progn (sb-thread:grab-mutex m) (push :late log))"])
def test_who_handles_a_deadline_does_not_stand_in_line_for_the_mutex(lisp, wait):
    """The mutex is released meanwhile, and a thread that asks later gets it first."""
    form = f"""(let* ((m (sb-thread:make-mutex)) (log '()) (first nil) (second nil))
      (setf first (sb-thread:make-thread (lambda () (sb-thread:with-mutex (m) (sleep 3)) (push :released log))))
      (setf second (sb-thread:make-thread (lambda () (sleep 4) (sb-thread:with-mutex (m) (push :second log) (sleep 5)))))
      (sleep 0.5)
      (handler-bind ((sb-sys:deadline-timeout (lambda (c) (push :deadline log) (sleep 5) (sb-sys:defer-deadline 50 c))))
        (sb-sys:with-deadline (:seconds 1) {wait}))
      (mapc #'sb-thread:join-thread (list first second))
      (reverse log))"""
    assert lisp(form) == "(:DEADLINE :RELEASED :SECOND :LATE)"
    assert kernel.now() == 9


def test_a_deadline_does_not_reach_the_cleanup(lisp):
    assert (
        lisp("""(let ((log '()))
      (handler-case (sb-sys:with-deadline (:seconds 1) (unwind-protect (sleep 5) (sleep 3) (push :clean log)))
        (sb-sys:deadline-timeout () log)))""")
        == "(:CLEAN)"
    )
    assert kernel.now() == 4


def test_waiting_for_a_mutex_that_nobody_gives_back_is_told(lisp):
    with pytest.raises(BaseException) as caught:
        lisp("""(let ((m (sb-thread:make-mutex :name "door")))
          (sb-thread:join-thread (sb-thread:make-thread (lambda () (sb-thread:grab-mutex m))))
          (sb-thread:grab-mutex m))""")
    assert "the mutex door" in str(getattr(caught.value, "report", lambda: caught.value)())


def test_the_text_of_a_deadlock_names_threads_and_mutexes(lisp):
    text = lisp("""(let ((a (sb-thread:make-mutex :name "a")) (b (sb-thread:make-mutex :name "b")))
      (flet ((both (one two) (sb-thread:with-mutex (one) (sleep 1)
                               (handler-case (sb-thread:with-mutex (two) :both) (sb-thread:thread-deadlock (c) (princ-to-string c))))))
        (let ((threads (list (sb-thread:make-thread #'both :name "t1" :arguments (list a b))
                             (sb-thread:make-thread #'both :name "t2" :arguments (list b a)))))
          (find-if #'stringp (mapcar #'sb-thread:join-thread threads)))))""")
    assert text.startswith('"Deadlock cycle detected:') and text.count("waited for:") == 2
    assert all(name in text for name in ('\\"t1\\"', '\\"t2\\"', '\\"a\\"', '\\"b\\"'))


def test_a_finalizer_runs_in_a_thread_of_its_own(lisp):
    lisp("(defclass gone-thing () ()) (defvar *gone* nil) (setf *gone* nil)")
    lisp("(defun lose-one () (tg:make-weak-pointer (tg:finalize (make-instance 'gone-thing) (lambda () (sleep 1) (push :gone *gone*)))))")
    assert lisp("(let ((pointer (lose-one))) (tg:gc :full t) (sleep 2) (list *gone* (tg:weak-pointer-value pointer)))") == "((:GONE) NIL)"
    lisp("(setf *gone* nil)")
    lisp("(defun keep-one () (tg:cancel-finalization (tg:finalize (make-instance 'gone-thing) (lambda () (push :gone *gone*)))) nil)")
    assert lisp("(progn (keep-one) (tg:gc :full t) (sleep 2) *gone*)") == "NIL"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(bt:join-thread (bt:make-thread (lambda () (list *print-base* (bt:thread-name (bt:current-thread)))) :name \"n\" "
         ":initial-bindings '((*print-base* . (+ 1 1)))))", '(2 "n")'),
        ("(let ((l (bt:make-lock))) (list (bt:acquire-lock l) (bt:lockp l) (bt:lockp 3) (eq l (bt:release-lock l))))", "(T T NIL T)"),
        ("(let ((l (bt:make-lock))) (bt:with-lock-held (l) (bt:join-thread (bt:make-thread (lambda () (bt:acquire-lock l nil))))))", "NIL"),
        ("(let ((l (bt:make-recursive-lock))) (bt:with-recursive-lock-held (l) (bt:with-recursive-lock-held (l) :twice)))", ":TWICE"),
        ("(let ((l (bt2:make-lock)) (cv (bt2:make-condition-variable))) "
         "(bt2:with-lock-held (l) (list (bt2:condition-wait cv l :timeout 1) (sb-thread:holding-mutex-p l))))", "(NIL T)"),
        ("(let ((s (bt2:make-semaphore))) (list (bt2:wait-on-semaphore s :timeout 1) (bt2:signal-semaphore s) (bt2:wait-on-semaphore s)))",
         "(NIL T T)"),
        ("(let ((a (bt2:make-atomic-integer))) (list (bt2:atomic-integer-incf a 3) (bt2:atomic-integer-value a)))", "(3 3)"),
        ("(handler-case (bt2:join-thread (bt2:make-thread (lambda () (error \"bad\")) :trap-conditions t)) "
         "(bt2:abnormal-exit (c) (princ-to-string (bt2:abnormal-exit-condition c))))", '"bad"'),
        ("(handler-case (bt:with-timeout (1) (sleep 2)) (bt:timeout () :over))", ":OVER"),
        ("(list (not (null (member :bordeaux-threads *features*))) bt:*supports-threads-p*)", "(T T)"),
        ("(let ((h (tg:make-weak-hash-table :weakness :key :test 'eq))) (setf (gethash 'car h) 1) (list (tg:hash-table-weakness h) (gethash 'car h)))",
         "(:KEY 1)"),
        ("(progn (defclass point-2d () (x y)) (mapcar #'c2mop:slot-definition-name (c2mop:class-slots (c2mop:ensure-finalized (find-class 'point-2d)))))",
         "(X Y)"),
        ("(list (c2mop:classp (find-class 'integer)) (c2mop:subclassp 'integer 'number) (eq 'c2cl:defclass 'cl:defclass))", "(T T T)"),
        ("(progn (cffi:defcenum colour :white (:red 4) :blue) (list (cffi:foreign-enum-value 'colour :blue) (cffi:foreign-enum-keyword 'colour 4)))",
         "(5 :RED)"),
        ("(progn (cffi:defbitfield flags :read :write (:all 7)) (list (cffi:foreign-bitfield-value 'flags '(:read :write)) "
         "(cffi:foreign-bitfield-symbols 'flags 2)))", "(3 (:WRITE))"),
        ("(cffi:translate-name-from-foreign \"some_function\" *package*)", "SOME-FUNCTION NIL"),
    ],
)  # fmt: skip
def test_what_the_libraries_answer(lisp, form, value):
    assert lisp(form) == value


def test_the_calls_that_run_are_listed_and_printed(tmp_path, lisp):
    (tmp_path / "calls.lisp").write_text("""(defun calls () (mapcar (lambda (call) (symbol-name (first call))) (sb-debug:list-backtrace)))
(defun outer () (let ((found (calls))) (append found nil)))
(defun show () (let ((text (with-output-to-string (s) (sb-debug:print-backtrace :stream s :count 1 :print-thread nil)))) (princ text) text))
""")
    lisp(f'(load "{tmp_path}/calls.lisp")')
    assert lisp("(subseq (outer) 0 2)") == '("CALLS" "OUTER")'
    assert lisp("(show)").startswith('"0: (SHOW) at ') and "calls.lisp:3:" in lisp("(show)")


@pytest.mark.parametrize(
    ("form", "text"),
    [
        ('(cffi:defcfun ("cos" c-cos) :double (x :double)) (c-cos 1d0)', 'C-COS cannot be called: cramhy calls no functions of C (here "cos").'),
        ('(cffi:defcfun "strlen" :int (s :string)) (strlen "a")', 'STRLEN cannot be called: cramhy calls no functions of C (here "strlen").'),
        ('(cffi:foreign-funcall "getpid" :int)', 'FOREIGN-FUNCALL cannot be called: cramhy calls no functions of C (here "getpid").'),
        ("(cffi:with-foreign-object (p :int) (setf (cffi:mem-ref p :int) 1))", "WITH-FOREIGN-OBJECT cannot be called: cramhy calls no functions of C."),
        ('(sb-ext:run-program "/bin/echo" \'("hi") :search t :output t)', 'Cannot run "/bin/echo": cramhy runs no other programs from Lisp.'),
        ('(sb-ext:save-lisp-and-die "x.core")', 'Cannot save "x.core": cramhy has no images on disk.'),
        ("(sb-thread:make-thread 5)", "The value\n  5\nis not of type\n  (OR FUNCTION SYMBOL)"),
        ("(bt:destroy-thread (bt:current-thread))", "Cannot destroy the current thread."),
        ("(sb-ext:with-timeout :soon (sleep 1))", "The value\n  :SOON\nis not of type\n  REAL"),
        ("(sb-ext:define-hash-table-test no-such-function)", "The DEFINE-HASH-TABLE-TEST form (SB-EXT:DEFINE-HASH-TABLE-TEST NO-SUCH-FUNCTION) is malformed"),
    ],
)  # fmt: skip
def test_a_refusal_names_what_was_called(lisp, form, text):
    with pytest.raises(Condition) as caught:
        lisp(form)
    assert caught.value.report().startswith(text)


def test_cffi_declarations_load_and_do_nothing(lisp):
    assert (
        lisp("""(cffi:define-foreign-library libx (:unix (:or "libx.so.1" "libx.so")) (t (:default "libx")))
      (cffi:use-foreign-library libx) (cffi:defctype handle :pointer) (cffi:defcstruct image (width :int))
      (cffi:defcvar "errno" :int) (cffi:defcallback on-image :void ((x :int)) x)
      (list (cffi:foreign-library-loaded-p 'libx) (null (cffi:list-foreign-libraries)) (cffi:pointerp 4))""")
        == "(NIL NIL NIL)"
    )


def test_sequence_functions_of_trivial_gray_streams_are_called(lisp):
    assert (
        lisp("""(defclass counting (trivial-gray-streams:trivial-gray-stream-mixin trivial-gray-streams:fundamental-character-output-stream)
                  ((n :initform 0 :accessor n)))
      (defmethod trivial-gray-streams:stream-write-char ((s counting) c) (incf (n s)) c)
      (defmethod trivial-gray-streams:stream-write-sequence ((s counting) seq start end &key) (incf (n s) (* 100 (- end start))) seq)
      (defclass plain (trivial-gray-streams:fundamental-character-output-stream) ((n :initform 0 :accessor n)))
      (defmethod trivial-gray-streams:stream-write-char ((s plain) c) (incf (n s)) c)
      (list (let ((s (make-instance 'counting))) (format s "abc~%") (write-sequence "abcd" s :start 1) (n s))
            (let ((s (make-instance 'plain))) (write-sequence "abcd" s :start 1) (n s)))""")
        == "(304 3)"
    )


def test_a_package_may_use_sbcls_packages(lisp):
    assert (
        lisp("""(defpackage :uses-sbcl (:use :cl :sb-ext :sb-thread :sb-sys))
      (eval (read-from-string "(let ((m (uses-sbcl::make-mutex))) (uses-sbcl::with-timeout 1 (uses-sbcl::with-mutex (m) 5)))"))""")
        == "5"
    )


@pytest.mark.soak
def test_a_program_may_have_a_package_that_is_called_like_a_library(tmp_path):
    # in an image of its own: the tests above have loaded the libraries
    assert process(
        tmp_path,
        "-c",
        """
from cramhy_runtime.repl.session import Session
Session(time="virtual").evaluate_text('(defpackage :bt (:use :cl)) (print (list (make-package :tg) (package-use-list :bt)))')
""",
    ) == ["(#<PACKAGE", '"TG">', "(#<PACKAGE", '"COMMON-LISP">))']


PROGRAM = """
(defvar *lock* (sb-thread:make-mutex))
(defun work () (sb-ext:with-timeout 5 (sb-thread:with-mutex (*lock*) (sb-sys:with-deadline (:seconds 1) #+sbcl :sbcl #-sbcl :cramhy))))
(print (work))
(print (list (sb-ext:wait-for t) (sb-ext:gc)))
"""


@pytest.mark.soak
def test_hooks_run_before_the_debugger_and_at_the_end(tmp_path, lisp):
    assert (
        lisp("""(block nil
      (let ((log '()))
        (let ((sb-ext:*invoke-debugger-hook* (lambda (c h) (declare (ignore c h)) (push (list :sbcl sb-ext:*invoke-debugger-hook*) log)))
              (*debugger-hook* (lambda (c h) (declare (ignore h)) (return (list (princ-to-string c) log)))))
          (error "x"))))""")
        == '("x" ((:SBCL NIL)))'
    )
    (tmp_path / "hooks.lisp").write_text(
        "(push (lambda () (print :bye)) sb-ext:*exit-hooks*) (print (length sb-ext:*exit-hooks*)) (sb-ext:exit)"
    )
    assert process(tmp_path, "-m", "cramhy_runtime.cli", "run", "hooks.lisp") == ["1", ":BYE"]


@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(sb-int:constant-form-value ''a)", "A"),
        ("(sb-int:constant-form-value 'pi)", "3.141592653589793d0"),
        ("(locally (declare (sb-ext:muffle-conditions sb-ext:compiler-note sb-ext:code-deletion-note)) 1)", "1"),
        ("(handler-case 2 (sb-ext:code-deletion-note () 3))", "2"),
        ("(subtypep 'sb-ext:code-deletion-note 'sb-ext:compiler-note)", "T"),
        ("(let ((sb-ext:*derive-function-types* t) (sb-ext:*inline-expansion-limit* 100)) 1)", "1"),
        ("(eq 'sb-impl::file-stream 'cl:file-stream)", "T"),
        ("(class-name (find-class 'sb-mop:slot-definition))", "SB-MOP:SLOT-DEFINITION"),
        ("(typep (first (sb-mop:class-direct-slots (defclass sbcl-slotted () (a)))) 'sb-mop:slot-definition)", "T"),
        ("(subtypep 'sb-mop:effective-slot-definition 'sb-mop:slot-definition)", "T"),
        ("(let ((cpl-impl::*tasks* (cut:make-queue))) (cpl-impl::list-saved-tasks))", "NIL"),
        ("(mapcar (lambda (s) (asdf:load-system s)) '(:roslisp-utils :roslisp-msg-protocol :ros-load-manifest))", "(T T T)"),
    ],
)
def test_names_that_libraries_declare_about_and_systems_that_they_ask_for(session, form, value):
    assert prin1_to_string(session.evaluate_text(form)[0]) == value


def process(folder, *words):
    done = subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, cwd=folder, env={**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
    )
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.soak
def test_kept_code_finds_the_late_names_and_features_are_part_of_it(tmp_path):
    (tmp_path / "program.lisp").write_text(PROGRAM)
    command = ["-m", "cramhy_runtime.cli", "run", "program.lisp"]
    assert process(tmp_path, *command) == process(tmp_path, *command) == [":CRAMHY", "(T", "NIL)"]
    assert process(tmp_path, *command, "--features", "sbcl") == [":SBCL", "(T", "NIL)"]
    assert process(tmp_path, *command) == [":CRAMHY", "(T", "NIL)"]


@pytest.mark.soak
def test_a_session_that_names_none_of_it_imports_none_of_it(tmp_path):
    program = """
import sys
from cramhy_runtime.repl.session import Session
session = Session(time="virtual")
session.evaluate_text("(print (list sb-ext:double-float-positive-infinity (sb-ext:posix-getenv \\"NO\\")))")
print([name for name in sys.modules if ".commonlisp.sbcl" in name or ".uiop." in name and not name.endswith(".texts")])
"""
    assert process(tmp_path, "-c", program)[-1] == "[]"
