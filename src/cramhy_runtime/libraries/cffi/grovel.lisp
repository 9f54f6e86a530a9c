;;;; cffi-grovel: files that ask the compiler of C for constants and sizes, and wrappers that it compiles. Such a file of a system is
;;;; passed over, so that the files of Lisp beside it load; what it would have defined is not there.

(defpackage #:cffi-grovel
  (:use #:common-lisp)
  (:export #:grovel-file #:process-grovel-file #:process-wrapper-file #:wrapper-file))

(in-package #:cffi-grovel)

(defvar *cc* "cc" "The compiler of C that a system asks for. It is not called.")

(defclass process-op-input (asdf:cl-source-file)
  ((cc-flags :initarg :cc-flags :initform nil :accessor cc-flags-of))
  (:documentation "A file for the compiler of C. It is passed over."))

(defclass grovel-file (process-op-input) ())
(defclass wrapper-file (process-op-input)
  ((soname :initarg :soname :initform nil :accessor soname-of)))

(defmethod asdf:perform ((operation asdf:compile-op) (file process-op-input)) nil)
(defmethod asdf:perform ((operation asdf:load-op) (file process-op-input)) nil)
(defmethod asdf:perform ((operation asdf:load-source-op) (file process-op-input)) nil)

(defun process-grovel-file (&rest arguments)
  "The error that C is not asked."
  (declare (ignore arguments))
  (cffi::refuse 'process-grovel-file))

(defun process-wrapper-file (&rest arguments)
  "The error that C is not compiled."
  (declare (ignore arguments))
  (cffi::refuse 'process-wrapper-file))

(defclass asdf::cffi-grovel-file (grovel-file) ())
(defclass asdf::cffi-wrapper-file (wrapper-file) ())
