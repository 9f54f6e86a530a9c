;;;; Macros, and macros that write macros.

(in-package #:courier-util)

(defmacro with-gensyms ((&rest names) &body body)
  "Bind each of NAMES to a fresh symbol while BODY builds an expansion."
  `(let ,(loop for name in names collect `(,name (gensym ,(string name))))
     ,@body))

(defmacro once-only ((&rest names) &body body)
  "The forms in NAMES are evaluated once, in order, where the expansion of BODY stands."
  (let ((symbols (loop for nil in names collect (gensym "ONCE"))))
    `(let ,(loop for symbol in symbols collect `(,symbol (gensym)))
       `(let (,,@(loop for symbol in symbols for name in names collect ``(,,symbol ,,name)))
          ,(let ,(loop for name in names for symbol in symbols collect `(,name ,symbol))
             ,@body)))))

(defmacro while (test &body body)
  `(loop (unless ,test (return)) ,@body))

(defmacro until (test &body body)
  `(while (not ,test) ,@body))

(defmacro if-let ((variable value) then &optional else)
  `(let ((,variable ,value)) (if ,variable ,then ,else)))

(defmacro when-let (bindings &body body)
  (destructuring-bind ((variable value) &rest more) (if (symbolp (first bindings)) (list bindings) bindings)
    `(let ((,variable ,value))
       (when ,variable
         ,@(if more `((when-let ,more ,@body)) body)))))

;;; A macro that writes anaphoric macros.

(defmacro define-anaphoric (name (&rest parameters) (test) expansion)
  "Define NAME as a macro that binds IT to the value of its parameter TEST around EXPANSION."
  (let ((rest (or (second (member '&body parameters)) (gensym "REST"))))
    `(defmacro ,name (,@(if (member '&body parameters) (ldiff parameters (member '&body parameters)) parameters) &body ,rest)
       (declare (ignorable ,rest))
       `(let ((it ,,test))
          (declare (ignorable it))
          ,,expansion))))

(define-anaphoric aif (test then) (test) `(if it ,then nil))
(define-anaphoric awhen (test &body body) (test) `(when it ,@body))

(defmacro acond (&rest clauses)
  (unless (null clauses)
    (destructuring-bind ((test &body body) . others) clauses
      (with-gensyms (value)
        `(let ((,value ,test))
           (if ,value
               (let ((it ,value)) (declare (ignorable it)) ,@(or body '(it)))
               (acond ,@others)))))))

;;; Enumerations: a type, an ordered list of names, a printer and a dispatching macro for each.

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun symbolicate (&rest things)
    (intern (format nil "~{~A~}" things)))

  (defun enumeration-members (clauses)
    (mapcar (lambda (clause) (if (consp clause) (first clause) clause)) clauses)))

(defmacro define-enumeration (name &body clauses)
  "Define the type NAME, the function NAME-INDEX, NAME-LABEL and a macro NAME-CASE that insists on every member."
  (let ((members (enumeration-members clauses))
        (case-macro (symbolicate name "-CASE")))
    `(progn
       (deftype ,name () '(member ,@members))
       (defun ,(symbolicate name "-INDEX") (member)
         (check-type member ,name)
         (position member ',members))
       (defun ,(symbolicate name "-LABEL") (member)
         (ecase member
           ,@(loop for clause in clauses
                   for member = (if (consp clause) (first clause) clause)
                   collect `(,member ,(if (consp clause) (second clause) (string-capitalize member))))))
       (defmacro ,case-macro (value &body cases)
         (let ((missing (set-difference ',members (mapcan (lambda (one) (if (listp (first one))
                                                                             (copy-list (first one))
                                                                             (list (first one))))
                                                          cases))))
           (when missing
             (error "~S lacks ~{~S~^, ~}." ',case-macro (sort missing #'string<)))
           `(ecase ,value ,@cases)))
       ',name)))

;;; Collectors: a local function that gathers, with the result at the end.

(defmacro define-collector (name (initial) combine &optional (finish '#'identity))
  "Define a macro NAME like (NAME (function) body...): calls of FUNCTION in the body are folded by COMBINE."
  `(defmacro ,name ((function) &body body)
     (let ((state (gensym "STATE")) (thing (gensym "THING")))
       `(let ((,state ,',initial))
          (flet ((,function (,thing) (setf ,state (funcall ,',combine ,thing ,state)) ,thing))
            (declare (ignorable #',function))
            ,@body)
          (funcall ,',finish ,state)))))

(define-collector collecting (nil) #'cons #'nreverse)
(define-collector summing (0) #'+)
(define-collector collect-into ((make-hash-table :test #'equal))
  (lambda (thing table) (incf (gethash thing table 0)) table))

;;; Memory.

(defvar *memos* (make-hash-table :test #'eq) "The tables of all functions defined by DEFMEMO.")

(defmacro defmemo (name (&rest parameters) &body body)
  "A function that remembers its answers by EQUAL arguments; declarations and documentation may stand in BODY."
  (let ((table (gensym "TABLE")) (key (gensym "KEY")) (documentation (and (stringp (first body)) (rest body) (list (pop body)))))
    `(let ((,table (make-hash-table :test #'equal)))
       (setf (gethash ',name *memos*) ,table)
       (defun ,name ,parameters
         ,@documentation
         (let ((,key (list ,@parameters)))
           (multiple-value-bind (value found) (gethash ,key ,table)
             (if found
                 (values value :remembered)
                 (values (setf (gethash ,key ,table) (block ,name ,@body)) :computed))))))))

(defun clear-memo (name)
  (when-let (table (gethash name *memos*))
    (prog1 (hash-table-count table) (clrhash table))))

;;; Threading, places and functions.

(defmacro -> (value &rest steps)
  "VALUE goes through STEPS as their first argument."
  (reduce (lambda (inner step)
            (etypecase step
              (symbol (list step inner))
              ((cons (eql function) t) `(funcall ,step ,inner))
              (cons `(,(first step) ,inner ,@(rest step)))))
          steps :initial-value value))

(define-modify-macro appendf (&rest lists) append "Append LISTS to the list in a place.")
(define-modify-macro maxf (&rest numbers) max)
(define-modify-macro toggle () not)

(defmacro do-plist ((key value plist &optional result) &body body)
  (with-gensyms (tail)
    `(do ((,tail ,plist (cddr ,tail)))
         ((endp ,tail) ,result)
       (let ((,key (car ,tail)) (,value (cadr ,tail)))
         ,@body))))

(defmacro named-lambda (name parameters &body body)
  `(labels ((,name ,parameters ,@body)) #',name))

(defun compose (&rest functions)
  (if (null functions)
      #'identity
      (destructuring-bind (outer &rest inner) functions
        (let ((inner (if inner (apply #'compose inner) #'identity)))
          (lambda (&rest arguments)
            (multiple-value-call outer (apply inner arguments)))))))

(defun curry (function &rest early)
  (lambda (&rest late) (apply function (append early late))))
