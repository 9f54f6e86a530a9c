;;;; Closer to MOP: what SB-MOP has here, with the functions and macros of Common Lisp that belong to it, in one package. The packages are
;;;; those of closer-mop 1.0.

(defpackage #:closer-mop
  (:use)
  (:nicknames #:c2mop))

(defpackage #:closer-common-lisp
  (:use)
  (:nicknames #:c2cl))

(defpackage #:closer-common-lisp-user
  (:use #:closer-common-lisp)
  (:nicknames #:c2cl-user))

(flet ((reexport (from to)
         (do-external-symbols (symbol from)
           (import (list symbol) to)
           (export (list symbol) to))))
  (reexport '#:sb-mop '#:closer-mop)
  (dolist (symbol '(defclass defgeneric defmethod ensure-generic-function standard-class standard-generic-function subtypep typep
                    find-class class-of slot-value slot-boundp slot-makunbound slot-exists-p initialize-instance
                    reinitialize-instance shared-initialize change-class find-method compute-applicable-methods))
    (import (list symbol) '#:closer-mop)
    (export (list symbol) '#:closer-mop))
  (export '(closer-mop::ensure-finalized closer-mop::required-args closer-mop::classp closer-mop::subclassp) '#:closer-mop)
  (reexport '#:common-lisp '#:closer-common-lisp)
  (reexport '#:closer-mop '#:closer-common-lisp))

(defun closer-mop::ensure-finalized (class &optional (errorp t))
  "The CLASS, which is complete as soon as its superclasses are defined."
  (declare (ignore errorp))
  (sb-mop:finalize-inheritance class)
  class)

(defun closer-mop::required-args (lambda-list &optional (collector #'identity))
  "The required parameters of LAMBDA-LIST, each as COLLECTOR gives it."
  (loop for parameter in lambda-list
        until (member parameter lambda-list-keywords)
        collect (funcall collector parameter)))

(defun closer-mop::classp (thing)
  "Whether THING is a class."
  (typep thing 'class))

(defun closer-mop::subclassp (class superclass)
  "Whether CLASS, a class or its name, is a subclass of SUPERCLASS."
  (flet ((class-of-name (thing) (if (symbolp thing) (find-class thing) thing)))
    (not (null (member (class-of-name superclass) (sb-mop:class-precedence-list (class-of-name class)))))))
