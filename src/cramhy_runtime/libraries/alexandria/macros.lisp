;;;; Macros: for writing macros, for binding and choosing, and for changing places.

(in-package #:alexandria)

;;; ------------------------------------------------------------------------------------------------------- writing macros

(defun make-gensym (name)
  "A fresh symbol whose name begins with NAME; a number is the number that it ends in."
  (if (typep name '(integer 0))
      (gensym name)
      (gensym (string name))))

(defun make-gensym-list (length &optional (x "G"))
  "A list of LENGTH fresh symbols whose names begin with X."
  (let ((prefix (if (typep x '(integer 0)) x (string x))))
    (loop repeat length collect (gensym prefix))))

(defmacro with-gensyms (names &body forms)
  "Bind each of NAMES to a fresh symbol around FORMS. A name may be a list (SYMBOL PREFIX)."
  `(let ,(mapcar (lambda (name)
                   (multiple-value-bind (symbol prefix)
                       (if (consp name) (values (first name) (second name)) (values name name))
                     `(,symbol (gensym ,(string prefix)))))
                 names)
     ,@forms))

(defmacro with-unique-names (names &body forms)
  "Another name of WITH-GENSYMS."
  `(with-gensyms ,names ,@forms))

(defmacro once-only (specs &body forms)
  "In a macro: let each of SPECS, symbols or (SYMBOL FORM), stand in FORMS for a variable bound to the form's value."
  (let* ((names (mapcar (lambda (spec) (if (consp spec) (first spec) spec)) specs))
         (sources (mapcar (lambda (spec) (if (consp spec) (second spec) spec)) specs))
         (variables (mapcar (lambda (name) (gensym (string name))) names)))
    `(let ,(mapcar (lambda (variable name) `(,variable (gensym ,(string name)))) variables names)
       `(let (,,@(mapcar (lambda (variable source) ``(,,variable ,,source)) variables sources))
          ,(let ,(mapcar #'list names variables)
             ,@forms)))))

(defun parse-body (body &key documentation whole)
  "Three values: the forms of BODY after its declarations, the declarations, and the documentation string if there may be one."
  (let ((declarations '()) (text nil))
    (loop for form = (first body)
          while body
          do (cond ((and documentation (stringp form) (rest body))
                    (when text
                      (error "Too many documentation strings in ~S." (or whole body)))
                    (setf text form))
                   ((and (consp form) (eq (first form) 'declare))
                    (push form declarations))
                   (t (return)))
             (setf body (rest body)))
    (values body (nreverse declarations) text)))

(defmacro named-lambda (name lambda-list &body body)
  "A function that calls itself NAME inside BODY."
  `(labels ((,name ,lambda-list ,@body)) #',name))

(defmacro define-constant (name initial-value &key (test ''eql) documentation)
  "DEFCONSTANT for values that are made anew when the file is loaded again: TEST decides whether they are the same."
  `(defconstant ,name (same-constant-value ',name ,initial-value ,test) ,@(when documentation (list documentation))))

(defun same-constant-value (name value test)
  "The value that the constant NAME keeps; one that TEST says is different is an error."
  (cond ((not (boundp name)) value)
        ((not (constantp name))
         (cerror "Try to redefine the variable as a constant." "~@<~S is an already bound non-constant variable whose value is ~S.~:@>"
                 name (symbol-value name))
         value)
        ((funcall test (symbol-value name) value) (symbol-value name))
        (t (cerror "Try to redefine the constant." "~@<~S is an already defined constant whose value ~S is not equal to the provided ~
                    initial value ~S under ~S.~:@>" name (symbol-value name) value test)
           value)))

;;; -------------------------------------------------------------------------------------------------- binding and choosing

(defun binding-list (bindings)
  "BINDINGS of IF-LET and its kin: one binding or a list of them."
  (if (and (consp bindings) (symbolp (first bindings)))
      (list bindings)
      bindings))

(defmacro if-let (bindings &body (then-form &optional else-form))
  "Bind the variables; THEN-FORM when all of them are true, else ELSE-FORM."
  (let ((list (binding-list bindings)))
    `(let ,list
       (if (and ,@(mapcar #'first list)) ,then-form ,else-form))))

(defmacro when-let (bindings &body forms)
  "Bind the variables; FORMS when all of them are true."
  (let ((list (binding-list bindings)))
    `(let ,list
       (when (and ,@(mapcar #'first list)) ,@forms))))

(defmacro when-let* (bindings &body body)
  "Bind the variables one after the other, as long as they are true; then BODY."
  (let ((list (binding-list bindings)))
    (if (null list)
        `(progn ,@body)
        `(let (,(first list))
           (when ,(first (first list))
             ,(if (rest list) `(when-let* ,(rest list) ,@body) `(let () ,@body)))))))

(defun switch-form (clauses object test key default)
  "The conditional of SWITCH and its kin."
  (with-gensyms (value)
    `(let ((,value (,@(callable key) ,object)))
       (cond ,@(mapcar (lambda (clause)
                         (destructuring-bind (other &rest forms) clause
                           (if (member other '(t otherwise))
                               `(t ,@(or forms '(nil)))
                               `((,@(callable test) ,value ,other) ,@(or forms '(nil))))))
                       clauses)
             ,@(unless (member (first (car (last clauses))) '(t otherwise))
                 `((t ,(funcall default value))))))))

(defun callable (designator)
  "The beginning of a call of the function that the form DESIGNATOR means: a bare symbol is a name."
  (cond ((symbolp designator) (list designator))
        ((and (consp designator) (member (first designator) '(quote function)) (symbolp (second designator)))
         (list (second designator)))
        (t (list 'funcall designator))))

(defmacro switch ((object &key (test 'eql) (key 'identity)) &body clauses)
  "Like CASE with evaluated keys: the first clause whose key is equal to OBJECT under TEST."
  (switch-form clauses object test key (constantly nil)))

(defmacro eswitch ((object &key (test 'eql) (key 'identity)) &body clauses)
  "SWITCH that signals an error when no clause matches."
  (switch-form clauses object test key (lambda (value) `(error "No keys match in SWITCH. Testing against ~S with ~S." ,value ',test))))

(defmacro cswitch ((object &key (test 'eql) (key 'identity)) &body clauses)
  "SWITCH that signals a correctable error when no clause matches."
  (switch-form clauses object test key
               (lambda (value) `(cerror "Return NIL from CSWITCH." "No keys match in SWITCH. Testing against ~S with ~S." ,value ',test))))

(defmacro whichever (&rest possibilities)
  "The value of one of the forms, chosen at random."
  `(case (random ,(length possibilities))
     ,@(loop for form in possibilities for index from 0 collect `(,index ,form))))

(defmacro xor (&rest datums)
  "The value of the only true form, and T; if there is none or another one, NIL, and T when there is none."
  (with-gensyms (block found next)
    `(block ,block
       (let ((,found nil))
         ,@(mapcar (lambda (form)
                     `(let ((,next ,form))
                        (when ,next
                          (if ,found (return-from ,block (values nil nil)) (setf ,found ,next)))))
                   datums)
         (values ,found t)))))

(defmacro nth-value-or (nth-value &body forms)
  "The values of the first form whose value number NTH-VALUE is true, or those of the last form."
  (if (null (rest forms))
      (first forms)
      (once-only (nth-value)
        (with-gensyms (values)
          `(let ((,values (multiple-value-list ,(first forms))))
             (if (nth ,nth-value ,values)
                 (values-list ,values)
                 (nth-value-or ,nth-value ,@(rest forms))))))))

(defmacro multiple-value-prog2 (first-form second-form &body forms)
  "The values of SECOND-FORM, after all forms."
  `(progn ,first-form (multiple-value-prog1 ,second-form ,@forms)))

(defmacro doplist ((key val plist &optional values) &body body)
  "Go through the keys and values of PLIST; VALUES is the result."
  (multiple-value-bind (forms declarations) (parse-body body)
    (with-gensyms (rest)
      `(block nil
         (do ((,rest ,plist (cddr ,rest)))
             ((null ,rest))
           (unless (consp (cdr ,rest))
             (error "malformed plist: ~S" ,rest))
           (let ((,key (first ,rest)) (,val (second ,rest)))
             ,@declarations
             (tagbody ,@forms)))
         (let ((,key nil) (,val nil))
           (declare (ignorable ,key ,val))
           ,values)))))

(defun destructuring-form (keyform clauses case-operator)
  "The expansion of DESTRUCTURING-CASE and its kin with the operator CASE-OPERATOR. In all clauses, that of T too, the lambda list gets
what follows the key."
  (with-gensyms (object)
    `(let ((,object ,keyform))
       (unless (consp ,object)
         (error "Invalid key to DESTRUCTURING-~S: ~S" ',case-operator ,object))
       (,case-operator (car ,object)
         ,@(mapcar (lambda (clause)
                     (destructuring-bind ((keys . lambda-list) &body body) clause
                       `(,keys (destructuring-bind ,lambda-list (cdr ,object) ,@body))))
                   clauses)))))

(defmacro destructuring-case (keyform &body clauses)
  "CASE on the first element of the value of KEYFORM; a clause ((KEYS . LAMBDA-LIST) . FORMS) destructures the rest of it."
  (destructuring-form keyform clauses 'case))

(defmacro destructuring-ecase (keyform &body clauses)
  "DESTRUCTURING-CASE that signals an error when no clause matches."
  (destructuring-form keyform clauses 'ecase))

(defmacro destructuring-ccase (keyform &body clauses)
  "DESTRUCTURING-CASE that signals a correctable error when no clause matches."
  (destructuring-form keyform clauses 'ccase))

;;; ------------------------------------------------------------------------------------------------------------ conditions

(defun required-argument (&optional name)
  "Signal that the keyword argument NAME was left out: the default of an argument that must be given."
  (error "Required argument ~@[~S ~]missing." name))

(define-condition simple-style-warning (simple-warning style-warning) ())

(defun simple-style-warning (message &rest args)
  (warn 'simple-style-warning :format-control message :format-arguments args))

(define-condition simple-reader-error (simple-condition reader-error) ())

(defun simple-reader-error (stream message &rest args)
  (error 'simple-reader-error :stream stream :format-control message :format-arguments args))

(define-condition simple-parse-error (simple-error parse-error) ())

(defun simple-parse-error (message &rest args)
  (error 'simple-parse-error :format-control message :format-arguments args))

(define-condition simple-program-error (simple-error program-error) ())

(defun simple-program-error (message &rest args)
  (error 'simple-program-error :format-control message :format-arguments args))

(defmacro ignore-some-conditions ((&rest conditions) &body body)
  "Evaluate BODY; when it signals one of CONDITIONS the values are NIL and the condition."
  `(handler-case (progn ,@body)
     ,@(mapcar (lambda (condition) `(,condition (c) (values nil c))) conditions)))

(defmacro unwind-protect-case ((&optional (abort-flag (gensym "ABORT"))) protected-form &body clauses)
  "UNWIND-PROTECT with clauses :NORMAL, :ABORT and :ALWAYS; ABORT-FLAG is true in them when the form was left by a jump."
  (dolist (clause clauses)
    (unless (and (consp clause) (member (first clause) '(:normal :abort :always)))
      (error "UNWIND-PROTECT-CASE: a clause begins with :NORMAL, :ABORT or :ALWAYS, not ~S." clause)))
  `(let ((,abort-flag t))
     (declare (ignorable ,abort-flag))
     (unwind-protect (multiple-value-prog1 ,protected-form (setf ,abort-flag nil))
       ,@(mapcar (lambda (clause)
                   (destructuring-bind (when &rest forms) clause
                     (ecase when
                       (:normal `(unless ,abort-flag ,@forms))
                       (:abort `(when ,abort-flag ,@forms))
                       (:always `(progn ,@forms)))))
                 clauses))))

;;; ----------------------------------------------------------------------------------------------------------------- places

(define-modify-macro maxf (&rest numbers) max "Set the place to the greatest of its value and NUMBERS.")
(define-modify-macro minf (&rest numbers) min "Set the place to the least of its value and NUMBERS.")
(define-modify-macro coercef (type-spec) coerce "Set the place to its value as TYPE-SPEC.")
(define-modify-macro appendf (&rest lists) append "Append LISTS to the place.")
(define-modify-macro nconcf (&rest lists) nconc "Append LISTS to the place, changing its list.")
(define-modify-macro unionf (list &rest args) union "Set the place to its union with LIST.")
(define-modify-macro nunionf (list &rest args) nunion "Set the place to its union with LIST, changing its list.")
(define-modify-macro reversef () reverse "Reverse the sequence in the place.")
(define-modify-macro nreversef () nreverse "Reverse the sequence in the place, changing it.")
(define-modify-macro removef (item &rest keyword-arguments) remove-item "Remove ITEM from the place.")
(define-modify-macro deletef (item &rest keyword-arguments) delete-item "Delete ITEM from the place.")
(define-modify-macro remove-from-plistf (&rest keys) remove-from-plist "Set the place to its property list without KEYS.")
(define-modify-macro delete-from-plistf (&rest keys) delete-from-plist "Set the place to its property list without KEYS.")

(defun remove-item (sequence item &rest keyword-arguments)
  (apply #'remove item sequence keyword-arguments))

(defun delete-item (sequence item &rest keyword-arguments)
  (apply #'delete item sequence keyword-arguments))

(defmacro ensure-gethash (key hash-table &optional default)
  "The value of KEY; when there is none, DEFAULT is computed and entered. The second value says whether there was one."
  (once-only (key hash-table)
    (with-gensyms (value there)
      `(multiple-value-bind (,value ,there) (gethash ,key ,hash-table)
         (if ,there
             (values ,value ,there)
             (values (setf (gethash ,key ,hash-table) ,default) nil))))))

(defmacro ensure-functionf (&rest places)
  "Set each place to the function that its value designates."
  `(setf ,@(mapcan (lambda (place) (list place `(ensure-function ,place))) places)))
