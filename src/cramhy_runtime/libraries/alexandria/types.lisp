;;;; Types, symbols and features.

(in-package #:alexandria)

(defmacro define-signed-types (&rest kinds)
  "For each numeric type its positive, negative, non-positive and non-negative numbers: a type and a predicate."
  `(progn
     ,@(loop for kind in kinds
             append (loop for (sign test range) in '(("POSITIVE" plusp ((0) *)) ("NEGATIVE" minusp (* (0)))
                                                     ("NON-POSITIVE" non-plusp (* 0)) ("NON-NEGATIVE" non-minusp (0 *)))
                          for name = (intern (format nil "~A-~A" sign kind) '#:alexandria)
                          collect `(deftype ,name () ',(signed-type kind test range))
                          collect `(defun ,(intern (format nil "~A-P" name) '#:alexandria) (n) (typep n ',name))))))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun signed-type (kind test range)
    "The type specifier of the numbers of type KIND in RANGE, limits that may be exclusive."
    (case kind
      (fixnum (ecase test
                (plusp '(integer 1 #.most-positive-fixnum))
                (minusp '(integer #.most-negative-fixnum -1))
                (non-plusp '(integer #.most-negative-fixnum 0))
                (non-minusp '(integer 0 #.most-positive-fixnum))))
      ((float rational real integer) (cons kind range))
      (t (cons kind (subst (coerce 0 kind) 0 range)))))) ; limits of the kind itself, as the standard wants them

(define-signed-types fixnum integer rational real float short-float single-float double-float long-float)

(deftype array-index (&optional (length (1- array-dimension-limit)))
  "An index of an array of LENGTH elements."
  `(integer 0 (,length)))

(deftype array-length (&optional (length (1- array-dimension-limit)))
  "The length of an array of at most LENGTH elements."
  `(integer 0 ,length))

(deftype string-designator ()
  "A string, a symbol or a character."
  '(or symbol string character))

(deftype proper-list () '(or null (and cons (satisfies proper-list-p))))
(deftype proper-sequence () '(or proper-list (and (not list) sequence)))
(deftype circular-list () '(satisfies circular-list-p))

(defun of-type (type)
  "A predicate: whether something is of TYPE."
  (lambda (thing) (typep thing type)))

(defun type= (type1 type2)
  "Whether the types have the same elements, and whether that is certain."
  (multiple-value-bind (within certain) (subtypep type1 type2)
    (cond ((not within) (values nil certain))
          (t (subtypep type2 type1)))))

(defun featurep (feature-expression)
  "Whether FEATURE-EXPRESSION holds for *FEATURES*."
  (etypecase feature-expression
    (symbol (not (null (member feature-expression *features*))))
    (cons (let ((operator (first feature-expression)) (rest (rest feature-expression)))
            (cond ((not (symbolp operator)) (error "~S is not a feature expression." feature-expression))
                  ((string= operator '#:and) (every #'featurep rest))
                  ((string= operator '#:or) (some #'featurep rest))
                  ((string= operator '#:not) (not (featurep (first rest))))
                  (t (error "~S is not a feature expression." feature-expression)))))))

;;; ---------------------------------------------------------------------------------------------------------------- symbols

(defun ensure-symbol (name &optional (package *package*))
  "The symbol called NAME, as it is, that PACKAGE has or gets; and its status."
  (intern (string name) package))

(defun format-symbol (package control &rest arguments)
  "The symbol whose name FORMAT makes; PACKAGE: a package, T for the current one, NIL for none."
  (let ((name (with-standard-io-syntax (apply #'format nil (string control) arguments))))
    (case package
      ((nil) (make-symbol name))
      ((t) (values (intern name)))
      (t (values (intern name package))))))

(defun make-keyword (name)
  "The keyword called NAME."
  (values (intern (string name) :keyword)))

(defun symbolicate (&rest things)
  "The symbol of the current package whose name is that of THINGS together."
  (values (intern (apply #'concatenate 'string (mapcar #'string things)))))
