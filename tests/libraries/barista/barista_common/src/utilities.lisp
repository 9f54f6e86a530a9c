(in-package :barista-common)

(defconstant +robot-radius+ 0.25d0
  "Metres from the middle of the base to its rim.")

(defparameter *verbosity* 1
  "0 says nothing.")

(deftype probability ()
  "A number from 0 to 1."
  '(real 0 1))

(deftype angle ()
  `(double-float ,(- pi) ,pi))

(defstruct (position
            (:constructor make-position (x y &optional (frame "map") &aux (norm (sqrt (+ (* x x) (* y y))))))
            (:copier copy-position)
            (:predicate position-p)
            (:print-function
             (lambda (object stream depth)
               (declare (ignore depth))
               (print-unreadable-object (object stream :type t)
                 (format stream "~,2f ~,2f in ~a" (position-x object) (position-y object) (position-frame object))))))
  "A place on the floor."
  (x 0.0d0 :type real)
  (y 0.0d0 :type real)
  (frame "map" :type string :read-only t)
  (norm 0 :read-only t))

(declaim (inline square))
(defun square (number)
  "NUMBER times itself."
  (declare (type number number))
  (* number number))

(declaim (ftype (function (position position) (values real &optional)) distance-2d))
(defun distance-2d (from to)
  (declare (type position from to)
           (optimize (speed 1) (safety 2)))
  (sqrt (+ (square (- (position-x from) (position-x to)))
           (square (- (position-y from) (position-y to))))))

(defun angle-in-range (angle)
  "ANGLE between -pi and pi."
  (loop with two-pi = (* 2 pi)
        while (> angle pi) do (decf angle two-pi)
        while (<= angle (- pi)) do (incf angle two-pi)
        finally (return angle)))

(defmacro while-let ((variable form) &body body)
  "Run BODY while FORM gives something, which VARIABLE is bound to."
  (with-gensyms (next)
    `(block nil
       (tagbody
          ,next
          (let ((,variable ,form))
            (when ,variable
              ,@body
              (go ,next)))))))

(define-modify-macro maxf (&rest numbers) max "Set the place to the greatest.")

(defmacro pushnew-key (key value place &key (test ''eql))
  "Put KEY and VALUE into the alist of PLACE unless KEY is there."
  (once-only (key)
    `(unless (assoc ,key ,place :test ,test)
       (push (cons ,key ,value) ,place))))

(defmacro do-alist ((key value alist &optional result) &body body)
  (let ((pair (gensym "PAIR")))
    `(dolist (,pair ,alist ,result)
       (destructuring-bind (,key . ,value) ,pair
         (declare (ignorable ,key ,value))
         ,@body))))

(define-condition give-up (error)
  ((tries :initarg :tries :reader give-up-tries :initform 0)
   (last-error :initarg :last-error :reader give-up-last-error))
  (:default-initargs :last-error nil)
  (:report (lambda (condition stream)
             (format stream "Gave up after ~r ~:*tr~[ies~;y~:;ies~]: ~a"
                     (give-up-tries condition) (give-up-last-error condition))))
  (:documentation "WITH-RETRIES has no tries left."))

(defmacro with-retries ((count &key (on 'error) (between nil)) &body body)
  "Run BODY again, up to COUNT times more, while it signals a condition of type ON. The restart TRY-AGAIN does not count."
  (with-gensyms (tries start limit condition done)
    `(let ((,tries 0) (,limit ,count))
       (declare (type (integer 0) ,tries ,limit))
       (block ,done
         (tagbody
            ,start
            (restart-case
                (handler-bind ((,on (lambda (,condition)
                                      (when (find-restart 'try-again ,condition)
                                        (cond ((< ,tries ,limit)
                                               (incf ,tries)
                                               ,@(when between `((funcall ,between ,condition)))
                                               (invoke-restart 'try-again))
                                              (t (error 'give-up :tries ,tries :last-error ,condition)))))))
                  (return-from ,done (progn ,@body)))
              (try-again ()
                :report (lambda (stream) (format stream "Try again, for the ~:r time" (1+ ,tries)))
                (go ,start))))))))

(defun normalize (alist)
  "The weights of ALIST, scaled so that their sum is 1."
  (let ((sum (reduce #'+ alist :key #'cdr)))
    (if (zerop sum)
        alist
        (mapcar (lambda (pair) (cons (car pair) (/ (cdr pair) sum))) alist))))

(defun collecting-by (key items &key (test #'equal) (value #'identity))
  "An alist from each KEY of ITEMS to what has it, in the order of the first of each."
  (loop with table = (make-hash-table :test test)
        with order = '()
        for item in items
        for its-key = (funcall key item)
        unless (nth-value 1 (gethash its-key table))
          do (push its-key order)
        do (push (funcall value item) (gethash its-key table))
        finally (return (loop for each in (nreverse order)
                              collect (cons each (nreverse (gethash each table)))))))

(defun memoized (function &key (test 'equal))
  "A function that keeps what FUNCTION gave, and a second that forgets it."
  (let ((kept (make-hash-table :test test)))
    (values (lambda (&rest arguments)
              (multiple-value-bind (values found) (gethash arguments kept)
                (values-list
                 (if found
                     values
                     (setf (gethash arguments kept)
                           (multiple-value-list (apply function arguments)))))))
            (lambda () (clrhash kept)))))

(defmacro define-memoized (name (&rest lambda-list) &body body)
  (multiple-value-bind (forms declarations documentation) (alexandria:parse-body body :documentation t)
    `(let ((call (memoized (lambda ,lambda-list ,@declarations ,@forms))))
       (defun ,name (&rest arguments)
         ,@(when documentation (list documentation))
         (apply call arguments)))))

(defgeneric step (thing seconds)
  (:documentation "What THING is SECONDS later.")
  (:method ((thing null) seconds)
    (declare (ignore seconds))
    nil)
  (:method ((thing position) (seconds real))
    (make-position (+ (position-x thing) (* 0.5 seconds)) (position-y thing) (position-frame thing)))
  (:method ((thing cons) seconds)
    (mapcar (alexandria:rcurry #'step seconds) thing)))

(defun implementation-name ()
  #+sbcl "sbcl"
  #+(and ccl (not sbcl)) "ccl"
  #-(or sbcl ccl) "another")
