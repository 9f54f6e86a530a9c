"""Fluents are classes, and ``value``, ``pulse``, ``wait-for`` ... are generic functions as soon as somebody adds a method."""

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.cpl.fluents import fluents
from cramhy_runtime.cpl.tasks import waiting
from cramhy_runtime.languages.commonlisp.faces.cpl import user_methods
from cramhy_runtime.lisp_core.dispatch.generic_functions import remove_method
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session


@pytest.fixture
def lisp(request, fresh_kernel):
    session = Session(time="virtual", backend=request.node.callspec.params["fresh_kernel"], time_limit=3600, turtlesim=False)
    session.evaluate_text("(defpackage fluent-methods (:use :cpl)) (in-package fluent-methods)")
    yield lambda text: prin1_to_string(session.evaluate_text(text, "<repl test>")[0])
    for opening in user_methods.OPENINGS:
        for method in list(opening.added):
            remove_method(opening.generic, method)


def test_a_class_of_ones_own_has_slots_and_initargs_and_its_instances_are_fluents(lisp):
    assert (
        lisp("""(defclass gauge (value-fluent) ((unit :initarg :unit :reader unit :initform "m")) (:default-initargs :value 7))
                   (let* ((f (make-fluent :class 'gauge :name 'depth :unit "cm")) (g (make-fluent :class 'gauge)) (net (> f 5)))
                     (setf (value f) 3)
                     (list f (unit f) (unit g) (value g) (value net) (typep f 'fluent) (typep f 'gauge) (class-name (class-of f))
                           (handler-case (make-fluent :class 'gauge :colour :red) (error () :no-colour))))
                """)
        == '(#<FLUENT DEPTH [3]> "cm" "m" 7 NIL T T GAUGE :NO-COLOUR)'
    )


def test_a_method_of_value_counts_for_nets_waits_and_callbacks(lisp):
    assert (
        lisp("""(defclass doubled (value-fluent) ())
                   (defmethod value ((f doubled)) (* 2 (call-next-method)))
                   (let* ((f (make-fluent :class 'doubled :value 1)) (plain (make-fluent :value 1)) (net (+ f 100)) (seen nil))
                     (register-update-callback f 'seen (lambda (x) (push x seen)))
                     (setf (value f) 4)
                     (list (value f) (peek-value f) (value net) seen (value plain) (setf (value f) 5) (value f) (wait-for f)
                           (value (fl-funcall #'list f plain))))""")
        == "(8 8 108 (8) 1 5 10 10 (10 1))"
    )


def test_a_slow_method_of_value_keeps_no_news_from_anybody_though_its_task_is_asked_to_end(lisp):
    assert (
        lisp("""(defclass slow (value-fluent) ())
                   (defmethod value ((f slow)) (let ((stored (call-next-method))) (when (> stored 0) (sleep 2)) stored))
                   (let* ((f (make-fluent :class 'slow :value 0)) (net (+ f 1)) (above (* net 10)))
                     (top-level (pursue (setf (value f) 1) (sleep 1)))
                     (list (value net) (value above)))""")
        == "(2 20)"
    )


def test_a_fluent_may_compute_its_value_itself(lisp):
    assert (
        lisp("""(defclass counter (fluent) ((n :initform 0 :accessor n)))
                   (defmethod value ((f counter)) (incf (n f)))
                   (let* ((f (make-fluent :class 'counter :name 'count)) (net (* 10 f)))
                     (list f (value f) (value net) (value net) (wait-for (> f 3))))""")
        == "(#<FLUENT COUNT> 1 20 30 T)"
    )


def test_a_class_without_a_method_for_value_says_so(lisp):
    assert (
        lisp("""(defclass idle (fluent) ())
                   (handler-case (value (make-fluent :class 'idle))
                     (error (e) (search "no applicable method" (princ-to-string e))))""")
        == "9"
    )


def test_methods_of_pulse_and_setf_value_are_called_by_assignments(lisp):
    assert (
        lisp("""(defclass noisy (value-fluent) ())
                   (defparameter *log* nil)
                   (defmethod pulse :before ((f noisy)) (push (list :pulse (value f)) *log*))
                   (defmethod (setf value) :around (new (f noisy)) (push (list :set new) *log*) (call-next-method (max 0 new) f))
                   (let* ((f (make-fluent :class 'noisy :value 1)) (net (= f 0)))
                     (list (setf (value f) -5) (value f) (value net) (progn (setf (value f) 0) (pulse f)) (reverse *log*)))
                """)
        == "(0 0 T NIL ((:SET -5) (:PULSE 0) (:SET 0) (:PULSE 0)))"
    )


def test_methods_of_pulse_are_called_for_the_fluents_of_pulsed_too(lisp):
    assert (
        lisp("""(let* ((seen nil) (f (make-fluent)) (once (pulsed f)))
                     (defmethod pulse :before ((fluent cpl-impl::pulse-fluent)) (push (if (eq fluent once) :once :other) seen))
                     (top-level
                       (pursue (whenever (once) (push :woken seen))
                               (progn (sleep 1) (pulse f) (sleep 1) (pulse f) (sleep 1))))
                     (list (reverse seen) (value once)))""")
        == "((:ONCE :WOKEN :ONCE :WOKEN) NIL)"
    )


def test_a_method_of_wait_for_is_called_by_whenever_too(lisp):
    assert (
        lisp("""(defclass patient (value-fluent) ())
                   (defparameter *waits* 0)
                   (defmethod wait-for :before ((f patient) &key timeout &allow-other-keys) (incf *waits* (or timeout 1)))
                   (let ((f (make-fluent :class 'patient :value :yes)) (n 0))
                     (list (wait-for f :timeout 10 :colour :red) (whenever (f) (when (= (incf n) 3) (return n)))
                           (wait-for (make-fluent :value 1)) *waits*))""")
        == "(:YES 3 1 13)"
    )


def test_methods_of_the_callback_functions(lisp):
    assert (
        lisp("""(defclass strict (value-fluent) ())
                   (defparameter *names* nil)
                   (defmethod register-update-callback :after ((f strict) name function) (declare (ignore function)) (push name *names*))
                   (defmethod remove-update-callback :after ((f strict) name) (push (list :no name) *names*))
                   (let ((f (make-fluent :class 'strict)) (g (make-fluent)))
                     (register-update-callback f 'a #'identity) (register-update-callback g 'b #'identity)
                     (list (remove-update-callback f 'a) (remove-update-callback g 'b) (remove-update-callback g 'b) *names*))
                """)
        == "(T T NIL ((:NO A) A))"
    )


def test_an_around_method_for_all_fluents_and_one_for_a_single_one(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value 1)) (p (pulsed f)) (net (fl-and p f)) (log 0))
                     (defmethod value :around ((any fluent)) (incf log) (call-next-method))
                     (defmethod value ((one (eql f))) :one)
                     (pulse f)
                     (list (value f) (value (make-fluent :value 2)) (peek-value net) (peek-value net) (value net) (value net) (> log 6)))
                """)
        == "(:ONE 2 :ONE :ONE :ONE NIL T)"
    )


def test_peeking_consumes_nothing_through_a_method_either(lisp):
    assert (
        lisp("""(defclass relay (fluent) ((source :initarg :source :reader source)))
                   (defmethod value ((f relay)) (value (source f)))
                   (let* ((f (make-fluent)) (r (make-fluent :class 'relay :source (pulsed f))))
                     (pulse f)
                     (list (peek-value r) (peek-value r) (value r) (value r)))""")
        == "(T T T NIL)"
    )


def test_value_may_have_methods_for_things_that_are_no_fluents(lisp):
    assert (
        lisp("""(defclass box () ((content :initarg :content)))
                   (defmethod value ((b box)) (slot-value b 'content))
                   (defmethod (setf value) (new (b box)) (setf (slot-value b 'content) new))
                   (let ((b (make-instance 'box :content 3))) (list (value b) (setf (value b) 4) (incf (value b)) (value 9)))
                """)
        == "(3 4 5 9)"
    )


def test_what_a_method_changed_is_undone_when_it_is_removed(lisp):
    lisp("""(defmethod value :around ((f value-fluent)) (list (call-next-method))) 1""")
    assert lisp("(value (make-fluent :value 1))") == "(1)"
    lisp("(remove-method #'value (find-method #'value '(:around) (list (find-class 'value-fluent)))) 1")
    assert lisp("(list (value (make-fluent :value 1)) (typep #'value 'generic-function))") == "(1 T)"
    assert not user_methods._replaced and fluents.ValueFluent.read is vars(fluents.ValueFluent)["read"]


def test_python_reads_and_assigns_through_the_methods_of_lisp(lisp):
    lisp("""(defclass clipped (value-fluent) ())
            (defmethod value ((f clipped)) (min 10 (call-next-method)))
            (defmethod (setf value) (new (f clipped)) (call-next-method (cl:* 2 new) f)) 1""")
    from cramhy_runtime.lisp_core.packages import intern

    fluent = cpl.make_fluent(class_=intern("CLIPPED", "FLUENT-METHODS"), value=1)
    fluent.value = 3
    assert (fluent.value, fluent.stored) == (6, 6)
    fluent.set(50)
    assert (fluent.value, cpl.value(fluent), cpl.wait_for(fluent), fluent.stored) == (10, 10, 10, 100)


def test_nobody_pays_for_methods_that_nobody_defined(lisp):
    assert not user_methods._replaced


def test_the_hook_sees_every_kind_of_fluent_and_how_it_may_be_traced(lisp):
    assert (
        lisp("""(defparameter *made* nil)
                   (defmethod on-make-fluent-hook note ((f fluent) tracing frequency)
                     (push (list (type-of f) tracing frequency (ignore-errors (slot-boundp f 'extra))) *made*))
                   (defclass tagged-fluent (value-fluent) ((extra :initform 1)))
                   (let ((f (make-fluent :value 1 :allow-tracing nil :max-tracing-freq 10)))
                     (make-fluent :class 'tagged-fluent :max-tracing-freq 1/2)
                     (< f 3) (pulsed f) (fl-value-changed f) (cpl-impl:fl-apply #'list f nil)
                     (remove-method #'on-make-fluent-hook (find-method #'on-make-fluent-hook '(note) (list (find-class 'fluent) t t)))
                     (reverse *made*))""").split()
        == """((VALUE-FLUENT NIL 10 NIL) (TAGGED-FLUENT T 1/2 T)
                (CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-CACHEABLE-FLUENT T NIL NIL) (CRAM-LANGUAGE-IMPLEMENTATION::PULSE-FLUENT T NIL NIL)
                (CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-FLUENT T NIL NIL)
                (CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-CACHEABLE-FLUENT T NIL NIL))""".split()
    )
    assert waiting.user_wait.value is None or waiting.user_wait.value.methods
