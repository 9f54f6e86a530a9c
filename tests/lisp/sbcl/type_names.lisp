; Prints what types of the standard the objects have, how the types relate and what coercions give; SBCL's answers are in type_names.txt.
(defvar *types* '(base-char standard-char extended-char character boolean null symbol keyword list cons atom
 signed-byte unsigned-byte bit fixnum bignum integer ratio rational real float short-float single-float double-float long-float complex number
 string base-string simple-base-string simple-string bit-vector simple-bit-vector vector simple-vector array simple-array sequence
 hash-table package pathname logical-pathname random-state readtable restart stream string-stream file-stream synonym-stream broadcast-stream
 concatenated-stream two-way-stream echo-stream function compiled-function generic-function standard-generic-function method standard-method
 class built-in-class standard-class structure-class standard-object structure-object method-combination
 condition error serious-condition simple-condition simple-error arithmetic-error division-by-zero t nil
 (unsigned-byte 8) (signed-byte 8) (integer 0 10) (mod 5) (float 0.0 1.0) (member 1 a) (eql 3) (or string symbol) (and integer (not (eql 3)))
 (vector t) (vector character) (array t (3)) (array * 1) (simple-array t (*)) (string 3) (cons integer) (complex float) (not symbol)))
(defun evenp-safe (x) (and (integerp x) (evenp x)))
(defstruct pt x)
(defclass kl () ())
(defvar *objects* (list #\a #\Newline (code-char 955) nil t 'a :k '(1 2) 0 1 3 7 -1 -200 255 256 (expt 2 70) 1/2 1.5 0.5 1.5d0 #c(1 2) #c(1.0 2.0)
 "abc" "" (make-string 3 :initial-element #\a) (make-array 3 :element-type 'character :fill-pointer 2 :initial-element #\a) #*101 (vector 1 2 3) (make-array 3 :adjustable t) (make-array '(2 2)) (make-hash-table) *package* #p"x" *random-state* *readtable*
 (make-string-input-stream "x") (make-string-output-stream) (make-synonym-stream '*standard-output*) (make-broadcast-stream) (make-two-way-stream *standard-input* *standard-output*)
 #'car (lambda (x) x) #'print-object (find-class 't) (find-class 'integer) (find-class 'kl) (find-class 'pt) (make-pt) (make-instance 'kl) (make-condition 'simple-error :format-control "x") (make-condition 'division-by-zero)))
(setf *print-pretty* nil)
(dolist (ty *types*)
  (format t "~s: ~{~a~}~%" ty (mapcar (lambda (o) (if (typep o ty) 1 0)) *objects*)))
(dolist (a *types*)
  (format t "sub ~s: ~{~a~}~%" a (mapcar (lambda (b) (multiple-value-bind (x y) (ignore-errors (subtypep a b)) (cond ((and x y) 1) (y 0) (t "?")))) *types*)))
(dolist (c '((1 float) (1 single-float) (1 double-float) (1 short-float) (1 long-float) (1/2 double-float) (1.5 double-float) ("a" character) (a character) ("abc" list) ((#\a #\b) string) ((1 2) vector) (#(1 2) list) ((1 2) simple-vector) ((1 0) bit-vector)
  (1 complex) (1.0 (complex float)) (1 t) (nil list) ((1 2) (vector t)) ((1 2) (vector * 2)) ("abc" simple-string) ("abc" vector) (car function) ((lambda (x) x) function) (1 integer) (1 string) ((1 2) array) ((#\a) base-string) ((#\a) simple-base-string) (2 (integer 0 5)) (#\a symbol) ("a" base-char) (1.5 integer) (1 boolean)))
  (format t "coerce ~s: ~a~%" c (handler-case (let ((v (coerce (first c) (second c)))) (if (functionp v) 'fun (list (prin1-to-string v) (type-of v)))) (error (e) (type-of e)))))
