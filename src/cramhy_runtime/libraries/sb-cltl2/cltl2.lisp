;;;; SB-CLTL2: what names mean in the environment that a macro gets, and environments with more names in them. Source: CLtL2, 8.5, and SBCL's
;;;; manual, sb-cltl2. The compiler's environments themselves are looked at in Python (sbcl/lexical_environments.py).

(defpackage #:sb-cltl2
  (:use #:common-lisp)
  (:export #:augment-environment #:compiler-let #:declaration-information #:define-declaration #:enclose #:function-information
           #:macroexpand-all #:parse-macro #:variable-information))
(in-package #:sb-cltl2)

(defun ask (function &rest arguments)
  (apply #'uiop:symbol-call (py:import-module "cramhy_runtime.languages.commonlisp.sbcl.lexical_environments") function arguments))

;;; ------------------------------------------------------------------------------------------------------------- what names mean

(defvar *declarations* (make-hash-table) "The name of a declaration -> the function that DEFINE-DECLARATION gave it.")

(defun variable-information (variable &optional environment)
  "Three values: :LEXICAL, :SPECIAL, :SYMBOL-MACRO, :CONSTANT or nil; whether ENVIRONMENT binds it; an alist of its declarations."
  (unless (symbolp variable) (error 'simple-type-error :datum variable :expected-type 'symbol :format-control "~S is not a symbol." :format-arguments (list variable)))
  (if (or (keywordp variable) (member variable '(t nil)))
      (values :constant nil nil)
      (values-list (ask '#:variable_information variable environment))))

(defun function-information (name &optional environment)
  "Three values: :FUNCTION, :MACRO, :SPECIAL-FORM or nil; whether ENVIRONMENT binds it; an alist of its declarations, which is empty."
  (unless (typep name '(or symbol (cons (eql setf) (cons symbol null))))
    (error 'simple-type-error :datum name :expected-type '(or symbol (cons (eql setf))) :format-control "~S is not the name of a function." :format-arguments (list name)))
  (destructuring-bind (kind local) (ask '#:function_information name environment)
    (values kind local nil)))

(defun declaration-information (name &optional environment)
  "Of OPTIMIZE the qualities, as they are globally: declarations inside of functions are not seen. Of DECLARATION the names of declarations."
  (ask '#:checked_environment environment)
  (case name
    (optimize (mapcar (lambda (quality) (list quality 1)) '(compilation-speed debug safety space speed)))
    (declaration (loop for known being the hash-keys of *declarations* collect known))
    (t (unless (gethash name *declarations*) (error "Unsupported declaration ~S." name)))))

(defmacro define-declaration (name lambda-list &body body)
  "Make NAME known as a declaration. BODY is not called: the compiler keeps no declarations of a program's own."
  (declare (ignore lambda-list body))
  `(eval-when (:compile-toplevel :load-toplevel :execute)
     (proclaim '(declaration ,name))
     (setf (gethash ',name *declarations*) t)
     ',name))

;;; -------------------------------------------------------------------------------------------------------------- environments

(defun augment-environment (environment &key variable symbol-macro function macro declare)
  "A new environment inside of ENVIRONMENT. SYMBOL-MACRO: (name expansion)...; MACRO: (name expander)...; DECLARE: declaration specifiers."
  (let ((specials (loop for (kind . names) in declare when (eq kind 'special) append names))
        (types (loop for (kind . rest) in declare
                     when (eq kind 'type) append (loop for name in (rest rest) collect (cons name (first rest))))))
    (ask '#:augmented environment variable specials types
         (loop for (name expansion) in symbol-macro collect (cons name expansion))
         function
         (loop for (name expander) in macro collect (cons name expander)))))

(defun parse-macro (name lambda-list body &optional environment)
  "The lambda expression of the expander of such a macro, a function of a form and an environment."
  (declare (ignore environment))
  (let ((form (gensym "FORM")) (env (gensym "ENVIRONMENT")) (bindings '()))
    (when (and (consp lambda-list) (eq (first lambda-list) '&whole))
      (push (list (second lambda-list) form) bindings)
      (setf lambda-list (cddr lambda-list)))
    (let ((place (and (listp lambda-list) (ldiff lambda-list (member '&environment lambda-list))))
          (rest (and (listp lambda-list) (member '&environment (loop for cell on lambda-list collect (car cell))))))
      (when rest
        (push (list (second rest) env) bindings)
        (setf lambda-list (append place (cddr (member '&environment lambda-list))))))
    (let ((declarations (loop while (and (consp (first body)) (eq (car (first body)) 'declare)) collect (pop body))))
      `(lambda (,form ,env)
         (declare (ignorable ,env))
         (let ,bindings
           (declare (ignorable ,@(mapcar #'first bindings)))
           (destructuring-bind ,lambda-list (rest ,form)
             ,@declarations
             (block ,name ,@body)))))))

(defun enclose (lambda-expression &optional environment)
  "The function of LAMBDA-EXPRESSION, in whose body the macros and symbol macros of ENVIRONMENT hold."
  (destructuring-bind (expanders expansions) (ask '#:local_macros environment)
    (let ((form (gensym "FORM")) (env (gensym "ENVIRONMENT")))
      (eval `(symbol-macrolet ,(loop for (name . expansion) in expansions collect (list name expansion))
               (macrolet ,(loop for (name . expander) in expanders
                                collect `(,name (&whole ,form &environment ,env &rest rest)
                                                (declare (ignore rest))
                                                (values (funcall ,expander ,form ,env))))
                 (function ,lambda-expression)))))))

(defmacro compiler-let (bindings &body body &environment environment)
  "BODY, compiled while the special variables of BINDINGS have these values."
  (progv (loop for binding in bindings collect (if (consp binding) (first binding) binding))
      (loop for binding in bindings collect (and (consp binding) (eval (second binding))))
    (macroexpand-all `(progn ,@body) environment)))

;;; ---------------------------------------------------------------------------------------------------------- all macros of a form

(defun macroexpand-all (form &optional environment)
  "FORM without calls of macros and without symbol macros. What is quoted stays, and so do the bindings of local macros."
  (walked form environment))

(defun walked (form environment)
  (let ((form (if (and (consp form) (eq (car form) 'lambda)) form (macroexpand form environment))))
    (cond ((atom form) form)
          ((eq (car form) 'lambda) (walked-lambda form environment))
          ((consp (car form)) (if (eq (caar form) 'lambda) (cons (walked-lambda (car form) environment) (walked-all (cdr form) environment)) form))
          ((eq (function-information (car form) environment) :function) (cons (car form) (walked-all (cdr form) environment)))
          (t (walked-special form environment)))))

(defun walked-all (forms environment)
  (mapcar (lambda (form) (walked form environment)) forms))

(defun declarations-and-body (body)
  (loop for rest on body
        while (and (consp (car rest)) (eq (caar rest) 'declare))
        collect (car rest) into declarations
        finally (return (values declarations rest))))

(defun walked-body (body environment)
  (multiple-value-bind (declarations forms) (declarations-and-body body)
    (append declarations (walked-all forms environment))))

(defun with-variables (names environment)
  (if names (augment-environment environment :variable names) environment))

(defun walked-lambda-list (lambda-list environment)
  "The lambda list with its initial forms walked, and the environment of the body."
  (let ((walked (loop for part in lambda-list
                      do (when (symbolp part) (unless (member part lambda-list-keywords) (setf environment (with-variables (list part) environment))))
                      collect (if (atom part)
                                  part
                                  (destructuring-bind (name &optional (init nil initp) (given nil givenp)) part
                                    (let ((init (and initp (walked init environment))))
                                      (setf environment (with-variables (list* (if (consp name) (second name) name) (and givenp (list given))) environment))
                                      `(,name ,@(and initp (list init)) ,@(and givenp (list given)))))))))
    (values walked environment)))

(defun walked-function (lambda-list body environment)
  (multiple-value-bind (lambda-list inner) (walked-lambda-list lambda-list environment)
    (cons lambda-list (walked-body body inner))))

(defun walked-lambda (expression environment)
  (cons (first expression) (walked-function (second expression) (cddr expression) environment)))

(defun walked-special (form environment)
  (destructuring-bind (operator . rest) form
    (case operator
      ((quote go) form)
      (function (list operator (if (and (consp (first rest)) (eq (car (first rest)) 'lambda)) (walked-lambda (first rest) environment) (first rest))))
      ((block return-from eval-when the truly-the catch-tag) (list* operator (first rest) (walked-all (cdr rest) environment)))
      (tagbody (cons operator (mapcar (lambda (part) (if (consp part) (walked part environment) part)) rest)))
      (setq (walked-setq rest environment))
      ((let let*)
       (let* ((inner environment)
              (bindings (loop for binding in (first rest)
                              for (name . init) = (if (consp binding) binding (list binding))
                              collect (if (consp binding) (cons name (walked-all init (if (eq operator 'let) environment inner))) binding)
                              do (setf inner (with-variables (list name) inner)))))
         `(,operator ,bindings ,@(walked-body (cdr rest) inner))))
      ((flet labels)
       (let ((inner (augment-environment environment :function (mapcar #'first (first rest)))))
         `(,operator ,(loop for (name lambda-list . body) in (first rest)
                            collect (cons name (walked-function lambda-list body (if (eq operator 'labels) inner environment))))
                     ,@(walked-body (cdr rest) inner))))
      (macrolet
       (let ((macros (loop for (name lambda-list . body) in (first rest)
                           collect (list name (enclose (parse-macro name lambda-list body) environment)))))
         `(macrolet ,(first rest) ,@(walked-body (cdr rest) (augment-environment environment :macro macros)))))
      (symbol-macrolet
       `(symbol-macrolet ,(first rest) ,@(walked-body (cdr rest) (augment-environment environment :symbol-macro (first rest)))))
      (locally (cons operator (walked-body rest environment)))
      (t (cons operator (walked-all rest environment))))))

(defun walked-setq (parts environment)
  "SETQ, or what SETF is where a variable is a symbol macro."
  (let ((places (loop for (name nil) on parts by #'cddr collect (macroexpand name environment))))
    (if (every #'symbolp places)
        `(setq ,@(loop for place in places for (nil value) on parts by #'cddr collect place collect (walked value environment)))
        (walked `(setf ,@(loop for place in places for (nil value) on parts by #'cddr collect place collect value)) environment))))

(provide "SB-CLTL2")
