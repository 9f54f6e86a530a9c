;;;; Weak pointers, weak hash tables, finalizers and the collector. Names, lambda lists and results are those of trivial-garbage 0.21;
;;;; what Python can refer to weakly, and what not, is said in docs/differences.md.

(defpackage #:trivial-garbage
  (:use #:common-lisp)
  (:nicknames #:tg)
  (:export #:gc #:make-weak-pointer #:weak-pointer-value #:weak-pointer-p #:make-weak-hash-table #:hash-table-weakness
           #:finalize #:cancel-finalization))

(in-package #:trivial-garbage)

(defun gc (&key full verbose)
  "Collect garbage now."
  (declare (ignore verbose))
  (sb-ext:gc :full full))

(defun make-weak-pointer (object)
  "A pointer to OBJECT that does not keep it alive."
  (assert (not (null object)))
  (sb-ext:make-weak-pointer object))

(defun weak-pointer-p (object)
  "Whether OBJECT is a weak pointer."
  (sb-ext:weak-pointer-p object))

(defun weak-pointer-value (weak-pointer)
  "The object of WEAK-POINTER, or NIL when it is gone."
  (values (sb-ext:weak-pointer-value weak-pointer)))

(defun make-weak-hash-table (&rest args &key weakness (weakness-matters t) &allow-other-keys)
  "A hash table that does not keep its keys or values alive, as WEAKNESS says; other arguments are those of MAKE-HASH-TABLE."
  (declare (ignore weakness-matters))
  (let ((others (loop for (key value) on args by #'cddr
                      unless (member key '(:weakness :weakness-matters))
                        append (list key value))))
    (apply #'make-hash-table :weakness weakness others)))

(defun hash-table-weakness (table)
  "One of NIL, :KEY, :VALUE, :KEY-AND-VALUE, :KEY-OR-VALUE."
  (sb-ext:hash-table-weakness table))

(defun finalize (object function)
  "Have FUNCTION called, without arguments, after OBJECT is gone. Returns OBJECT."
  (sb-ext:finalize object function :dont-save t))

(defun cancel-finalization (object)
  "Forget the finalizers of OBJECT."
  (when object
    (sb-ext:cancel-finalization object)))
