"The macros of Common Lisp, except those of places (setf, push, ...), which are in `languages/commonlisp/evaluation/setf_places.py`, and LOOP.

Each is what the standard says that it expands into; see the section of ANSI in its comment where that is not plain."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *
        cramhy_runtime.languages.commonlisp.compiler.compilation_unit [duplicate-keys mention-type])

(setv package "COMMON-LISP")

;; ---------------------------------------------------------------------------------------------------------------- choice

(defoperator when [test #* body]
  `(if ~test ~(clause-body body)))

(defoperator unless [test #* body]
  `(if ~test nil ~(clause-body body)))

(defn clause-body [body]
  (if (= (len body) 1) (get body 0) `(progn ~@body)))

(defoperator cond [#* clauses]
  (setv form None)
  (for [clause (reversed clauses)]
    (setv #(test #* body) clause)
    (setv form (cond
                 (not body) `(or ~test ~form)
                 (is test True) (clause-body body)
                 True `(if ~test ~(clause-body body) ~form))))
  form)

(defn key-equal [variable key]
  "Whether the key is `eql` to `key`; a string never is, but Python may share equal ones."
  (if (isinstance key str) None `(eql ~variable (quote ~key))))

(defn key-test [variable keys]
  "The test of a `case` clause: `keys` is one object or a list of them."
  (setv items (if (or (listp keys) (is keys None)) (elements keys) [keys]))
  (match (len items)
    0 None
    1 (key-equal variable (get items 0))
    _ `(or ~@(lfor item items (key-equal variable item)))))

(defn type-test [variable type]
  `(typep ~variable (quote ~type)))

(defn otherwise? [key]
  (or (is key True) (is key (sym "OTHERWISE"))))

(defn check-clauses [operator clauses]
  "T and OTHERWISE stand for any key only in the last clause of `case` and `typecase`."
  (for [clause (cut clauses 0 -1)]
    (when (and (listp clause) (is clause.car (sym "OTHERWISE")))
      (error "Bad ~A clause:~%  ~S~%~S is allowed as the key designator only in the last clause. Use (~S) instead, or move the clause to the end." operator clause clause.car clause.car))))

(defn choose [variable clauses test default]
  "Nested conditionals for the clauses of `case` and its relatives."
  (setv form default)
  (for [#(index clause) (reversed (list (enumerate clauses)))]
    (setv #(keys #* body) clause)
    (setv form (if (and (otherwise? keys) (= index (- (len clauses) 1)) (is default None))
                   (clause-body (or body [None]))
                   `(if ~(test variable keys) ~(clause-body (or body [None])) ~form))))
  form)

(defn all-keys [clauses]
  (list-from (sum (lfor clause clauses (if (or (is clause.car None) (listp clause.car)) (elements clause.car) [clause.car])) [])))

(defoperator case [key #* clauses]
  (check-clauses "CASE" clauses)
  (duplicate-keys "CASE" clauses)
  (setv variable (gensym "KEY"))
  `(let [[~variable ~key]] ~(choose variable clauses key-test None)))

(defoperator ecase [key #* clauses]
  (duplicate-keys "ECASE" clauses)
  (setv variable (gensym "KEY"))
  `(let [[~variable ~key]]
     ~(choose variable clauses key-test `(%case-failure ~variable "ECASE" (quote ~(all-keys clauses))))))

(defoperator ccase [place #* clauses]
  (setv variable (gensym "KEY") again (gensym "AGAIN"))
  `(block ~again
     (tagbody
       ~again
       (let [[~variable ~place]]
         (return-from ~again
           ~(choose variable clauses key-test
              `(progn (setf ~place (%ask-for-value ~variable "CCASE" (quote ~(all-keys clauses)))) (go ~again))))))))

(defoperator typecase [key #* clauses]
  (check-clauses "TYPECASE" clauses)
  (setv variable (gensym "KEY"))
  `(let [[~variable ~key]] ~(choose variable clauses type-test None)))

(defoperator etypecase [key #* clauses]
  (setv variable (gensym "KEY"))
  `(let [[~variable ~key]]
     ~(choose variable clauses type-test
        `(%case-failure ~variable "ETYPECASE" (quote ~(list-from (lfor clause clauses clause.car)))))))

(defoperator ctypecase [place #* clauses]
  (setv variable (gensym "KEY") again (gensym "AGAIN"))
  `(block ~again
     (tagbody
       ~again
       (let [[~variable ~place]]
         (return-from ~again
           ~(choose variable clauses type-test
              `(progn (setf ~place (%ask-for-value ~variable "CTYPECASE" (quote ~(list-from (lfor clause clauses clause.car)))))
                      (go ~again))))))))

;; The compiler treats these itself; programs that expand forms see them as the macros that they are.

(defoperator and [#* forms]
  (cond
    (not forms) True
    (= (len forms) 1) (get forms 0)
    True `(if ~(get forms 0) (and ~@(cut forms 1 None)) nil)))

(defoperator or [#* forms]
  (setv value (gensym "VALUE"))
  (cond
    (not forms) None
    (= (len forms) 1) (get forms 0)
    True `(let [[~value ~(get forms 0)]] (if ~value ~value (or ~@(cut forms 1 None))))))

(defoperator multiple-value-list [form]
  `(multiple-value-call (function list) ~form))

(defoperator multiple-value-bind [variables form #* body]
  (setv ignored (gensym "IGNORED"))
  `(multiple-value-call (lambda [&optional ~@(elements variables) &rest ~ignored] ~@body) ~form))

(defoperator lambda [#* parts]
  `(function (lambda ~@parts)))

;; ------------------------------------------------------------------------------------------------------------- sequence

(defoperator prog1 [first #* body]
  (setv value (gensym "VALUE"))
  `(let [[~value ~first]] ~@body ~value))

(defoperator prog2 [first second #* body]
  `(progn ~first (prog1 ~second ~@body)))

(defoperator prog [bindings #* body]
  (setv #(declarations forms) (split-declarations body))
  `(block nil (let ~bindings ~@declarations (tagbody ~@forms))))

(defoperator prog* [bindings #* body]
  (setv #(declarations forms) (split-declarations body))
  `(block nil (let* ~bindings ~@declarations (tagbody ~@forms))))

(defoperator return [[value None]]
  `(return-from nil ~value))

;; ------------------------------------------------------------------------------------------------------------ iteration

(defn iteration-spec [variable form [result None] #* extra]
  "The parts (variable form result) of `dotimes` and its relatives; there is at most one result form."
  (if extra (raise (TypeError "takes at most three parts")) #(variable form result)))

(defn specials [declarations]
  "The declarations that variables are special: they hold for the result form, too."
  (setv found (lfor declaration declarations specifier (elements declaration.cdr)
                    :if (and (listp specifier) (is specifier.car (sym "SPECIAL")))
                    specifier))
  (if found [`(declare ~@found)] []))

(defoperator dotimes [spec #* body]
  ; one variable for all turns, as in SBCL: closures share it, and a form that assigns it changes the turns
  (setv #(variable count result) (iteration-spec #* spec))
  (setv limit (gensym "LIMIT") next (gensym "NEXT") end (gensym "END"))
  (setv #(declarations forms) (split-declarations body))
  `(block nil
     (let [[~variable 0] [~limit ~(if (isinstance count int) count `(the integer ~count))]]
       (declare (ignorable ~variable))
       ~@declarations
       (tagbody
         ~next
         (if (>= ~variable ~limit) (go ~end))
         (tagbody ~@forms)
         (setq ~variable (1+ ~variable))
         (go ~next)
         ~end)
       ~result)))

(defoperator dolist [spec #* body]
  (setv #(variable items result) (iteration-spec #* spec))
  (setv rest (gensym "REST") next (gensym "NEXT") end (gensym "END"))
  (setv #(declarations forms) (split-declarations body))
  `(block nil
     (let [[~rest ~items]]
       (tagbody
         ~next
         (if (endp ~rest) (go ~end))
         (let [[~variable (%car-of-cons ~rest)]] (declare (ignorable ~variable)) ~@declarations (tagbody ~@forms))
         (setq ~rest (%cdr-of-cons ~rest))
         (go ~next)
         ~end))
     ~(if (is result None) None `(let [[~variable nil]] (declare (ignorable ~variable)) ~@(specials declarations) ~result))))

(defn step-parts [bindings]
  "(variables with their first values, pairs of variable and step form) of `do`."
  (setv initial [] steps [])
  (for [binding (elements bindings)]
    (setv parts (if (listp binding) (list binding) [binding]))
    (.append initial (list-from (cut parts 2)))
    (when (= (len parts) 3)
      (.extend steps [(get parts 0) (get parts 2)])))
  #(initial steps))

(defn do-loop [bind assign bindings end body]
  (setv #(initial steps) (step-parts bindings) #(declarations forms) (split-declarations body))
  (setv next (gensym "NEXT") done (gensym "DONE") #(test #* result) end)
  `(block nil
     (~bind ~initial
       (declare (ignorable ~@(lfor item initial item.car)))
       ~@declarations
       (tagbody
         ~next
         (if ~test (go ~done))
         (tagbody ~@forms)
         ~@(if steps [`(~assign ~@steps)] [])
         (go ~next)
         ~done)
       (progn ~@result))))

(defoperator do [bindings end #* body]
  (do-loop 'let 'psetq bindings end body))

(defoperator do* [bindings end #* body]
  (do-loop 'let* 'setq bindings end body))

(defoperator loop [#* forms]
  (import cramhy_runtime.languages.commonlisp.loop.loop [expand])
  (expand (list-from forms)))

(defoperator loop-finish []
  `(go %end-loop))

(defoperator do-symbols [spec #* body]
  (setv #(variable #* rest) spec)
  `(dolist [~variable (%package-symbols ~(if rest (get rest 0) '*package*) nil) ~@(cut rest 1 None)] ~@body))

(defoperator do-external-symbols [spec #* body]
  (setv #(variable #* rest) spec)
  `(dolist [~variable (%package-symbols ~(if rest (get rest 0) '*package*) t) ~@(cut rest 1 None)] ~@body))

(defoperator do-all-symbols [spec #* body]
  (setv #(variable #* rest) spec)
  `(dolist [~variable (%all-symbols) ~@rest] ~@body))

;; ------------------------------------------------------------------------------------------------------ multiple values

(defoperator multiple-value-setq [variables form environment]
  (import cramhy_runtime.languages.commonlisp.syntax.macros [macroexpand-1])
  (setv names (elements variables) temporaries (lfor _ names (gensym "VALUE")))
  (for [name names]
    (when (not (isinstance name LispSymbol))
      (raise (ValueError "only variables can be assigned; use (setf (values place...) form)."))))
  (cond
    (not names) `(prog1 ~form)
    ; the forms of a symbol macro are evaluated before the values (ANSI 5.1.2.3)
    (any (gfor name names (get (macroexpand-1 name environment) 1))) `(values (setf (values ~@names) ~form))
    True `(multiple-value-bind ~temporaries ~form
            ~@(lfor #(name value) (zip names temporaries) `(setq ~name ~value))
            ~(get temporaries 0))))

(defoperator nth-value [n form]
  (if (and (is (type n) int) (<= 0 n 4))
      (do (setv names (lfor _ (range (+ n 1)) (gensym "VALUE")))
          `(multiple-value-bind ~names ~form ~(get names n)))
      `(nth ~n (multiple-value-list ~form))))

(defoperator destructuring-bind [lambda-list form #* body]
  (import cramhy_runtime.languages.commonlisp.syntax.lambda_lists [destructure])
  `(let* ~(lfor #(variable value) (destructure lambda-list form "DESTRUCTURING-BIND") [variable value]) ~@body))

;; ---------------------------------------------------------------------------------------------------------- definitions

(defn check-name [name operator valid kind]
  (when (not valid)
    (error "The NAME argument to ~A, ~S, is not a ~A." operator name kind)))

(defn function-name? [name]
  (or (is-symbol name) (and (listp name) (is name.car (sym "SETF")) (listp name.cdr) (is-symbol name.cdr.car))))

(defoperator defun [name lambda-list #* body]
  (check-name name "DEFUN" (function-name? name) "function name")
  (setv #(documentation declarations forms) (body-parts body))
  `(%define-function (quote ~name) (%named-lambda ~name ~lambda-list ~@declarations ~@forms) ~documentation (quote ~lambda-list)))

(defoperator defmacro [name lambda-list #* body]
  (import cramhy_runtime.languages.commonlisp.evaluation.definitions [macro-function-form])
  (setv #(function documentation) (macro-function-form name lambda-list (list-from body)))
  `(%define-macro (quote ~name) ~function ~documentation (quote ~lambda-list)))

(defoperator define-compiler-macro [name lambda-list #* body]
  "Its function rewrites the calls that are compiled from now on."
  (import cramhy_runtime.languages.commonlisp.evaluation.definitions [macro-function-form])
  (setv #(function documentation) (macro-function-form name lambda-list (list-from body) "DEFINE-COMPILER-MACRO"))
  `(%define-compiler-macro (quote ~name) ~function ~documentation))

(defoperator defvar [name #* rest]
  (check-name name "DEFVAR" (is-symbol name) "symbol")
  (%note-special name)
  (setv #(value documentation) (+ (list rest) (* [None] (- 2 (len rest)))))
  `(%define-variable (quote ~name) ~(if rest `(lambda [] ~value) None) ~documentation))

(defoperator defparameter [name value [documentation None]]
  (check-name name "DEFPARAMETER" (is-symbol name) "symbol")
  (%note-special name)
  `(%define-variable (quote ~name) (lambda [] ~value) ~documentation t))

(defn %note-special [name]
  "The forms after a definition see the variable as special even before the definition has run."
  (import cramhy_runtime.languages.commonlisp.evaluation.definitions [note-special])
  (note-special name))

(defoperator defconstant [name value [documentation None]]
  `(%define-constant (quote ~name) ~value ~documentation))

(defoperator define-symbol-macro [name expansion]
  `(%define-symbol-macro (quote ~name) (quote ~expansion)))

(defoperator declaim [#* specifiers]
  `(%declaim ~@(lfor specifier specifiers `(quote ~specifier))))

(defoperator deftype [name lambda-list #* body]
  (import cramhy_runtime.languages.commonlisp.evaluation.definitions [type-function-form])
  (setv #(function documentation) (type-function-form name lambda-list (list-from body)))
  `(%define-type (quote ~name) ~function ~documentation (quote ~lambda-list)))

(defoperator "sb-ext::without-package-locks" [#* body]
  `(%call-unlocked t (lambda [] ~@body)))

(defoperator "sb-ext::with-unlocked-packages" [packages #* body]
  `(%call-unlocked (quote ~packages) (lambda [] ~@body)))

(defoperator defpackage [name #* options]
  `(%define-package (quote ~name) (quote ~options)))

(defoperator in-package [name]
  `(%set-package (quote ~name)))

(defoperator with-package-iterator [spec #* body]
  (setv #(name packages #* kinds) spec)
  (import cramhy_runtime.languages.commonlisp.packages.package_definition [check-kinds])
  (check-kinds kinds)
  (setv iterator (gensym "ITERATOR"))
  `(let [[~iterator (%package-iterator ~packages (quote ~kinds))]]
     (macrolet [[~name [] (quote (funcall ~iterator))]] ~@body)))

;; --------------------------------------------------------------------------------------------------- conditions, checks

(defoperator check-type [place type [name None]]
  (setv again (gensym "AGAIN") failed `(%check-type-failed ~place (quote ~place) (quote ~type) ~name))
  (if (or (listp place) (isinstance place LispSymbol))
      `(tagbody ~again (if (typep ~place (quote ~type)) nil (progn (setf ~place ~failed) (go ~again))))
      `(if (typep ~place (quote ~type)) nil ~failed)))

(defn handler-function [clause]
  "(type function) for a clause (type (variable) . body)."
  (setv #(type variables #* body) clause)
  (mention-type type)
  (setv ignored (gensym "CONDITION"))
  (if variables
      `(list (quote ~type) (lambda ~variables ~@body))
      `(list (quote ~type) (lambda [~ignored] ~@body))))

(defoperator handler-bind [bindings #* body]
  (for [#(type #* _) (elements bindings)] (mention-type type))
  `(%handling ~(list-from (lfor #(type function) (elements bindings) (list-from [type function]))) ~@body))

(defn plain-variables? [variables]
  "Whether the lambda list of a clause has no variable, or one."
  (or (is variables None)
      (and (listp variables) (is variables.cdr None) (isinstance variables.car LispSymbol)
           (not (.startswith (. variables.car name) "&")))))

(defoperator handler-case [form #* clauses]
  (setv no-error (lfor clause clauses :if (is clause.car (sym ":NO-ERROR")) clause))
  (setv handlers (lfor clause clauses :if (is-not clause.car (sym ":NO-ERROR")) (handler-function clause)))
  (if (and clauses (not no-error) (all (gfor clause clauses (plain-variables? clause.cdr.car))))
      `(%catching ~(list-from (lfor clause clauses clause.car)) ~form ~@(lfor clause clauses clause.cdr))
      `(%handler-case (list ~@handlers) (lambda [] ~form)
                      ~(if no-error `(lambda ~@(. (get no-error 0) cdr)) None))))

(defoperator ignore-errors [#* body]
  (setv condition (gensym "CONDITION"))
  `(handler-case (progn ~@body) (error [~condition] (values nil ~condition))))

(defn restart-clause [clause]
  "A clause (name lambda-list [:report r] [:interactive i] [:test t] . body) of `restart-case`."
  (setv #(name lambda-list #* rest) clause options {} rest (list rest))
  (while (and rest (isinstance (get rest 0) LispSymbol) (in (. (get rest 0) name) ["REPORT" "INTERACTIVE" "TEST"]))
    (setv (get options (. (get rest 0) name)) (get rest 1))
    (setv rest (cut rest 2 None)))
  (setv report (.get options "REPORT"))
  (defn function-of [form]
    (if (or (is form None) (isinstance form str)) form `(function ~form)))
  `(list (quote ~name) (lambda ~lambda-list ~@rest) (%restart-report ~(function-of report))
         ~(function-of (.get options "INTERACTIVE")) ~(function-of (.get options "TEST"))))

(defn signalling [form]
  "The name of the function that the form calls to signal a condition, with which `restart-case` associates its restarts."
  (when (and (listp form) (isinstance form.car LispSymbol) (in form.car (lfor name ["ERROR" "CERROR" "SIGNAL" "WARN"] (sym name))))
    form.car))

(defoperator restart-case [form #* clauses environment]
  (import cramhy_runtime.languages.commonlisp.syntax.macros [macroexpand])
  (setv operator (signalling form))
  (when (and (not operator) (or (listp form) (isinstance form LispSymbol)))
    (setv expansion (get (macroexpand form environment) 0))  ; of a local macro or symbol macro, say
    (setv operator (signalling expansion))
    (when operator (setv form expansion)))
  `(%restart-case (list ~@(lfor clause clauses (restart-clause clause)))
                  (lambda [] ~(if operator `(%signal-with-restarts (quote ~operator) ~@(. form cdr)) form))))

(defoperator restart-bind [bindings #* body]
  `(%restart-bind
     (list ~@(lfor binding (elements bindings)
               (do
                 (setv #(name function #* options) binding)
                 `(list (quote ~name) ~function ~@options))))
     (lambda [] ~@body)))

(defoperator with-simple-restart [spec #* body]
  (setv #(name control #* arguments) spec)
  (when (and (= (len body) 1) (signalling (get body 0)))  ; the restart belongs to the condition, as on SBCL
    (return `(restart-case ~(get body 0)
               (~name [] :report (lambda [stream] (format stream ~control ~@arguments)) (values nil t)))))
  `(%with-simple-restart (quote ~name) (lambda [] (format nil ~control ~@arguments)) (lambda [] ~@body)))

(defoperator with-condition-restarts [condition restarts #* body]
  `(%with-condition-restarts ~condition ~restarts (lambda [] ~@body)))

;; -------------------------------------------------------------------------------------------------------------- streams

(defoperator with-output-to-string [spec #* body]
  (setv #(stream #* options) (elements spec))
  (setv target (if (or (not options) (isinstance (get options 0) Keyword)) None (get options 0)))
  (setv keywords (if (or (not options) (isinstance (get options 0) Keyword)) options (cut options 1 None)))
  (if (is target None)
      `(let [[~stream (make-string-output-stream ~@keywords)]] ~@body (get-output-stream-string ~stream))
      `(let [[~stream (%make-fill-pointer-output-stream ~(if keywords `(prog1 ~target ~@(cut keywords 1 None 2)) target))]] ~@body)))

(defoperator with-input-from-string [spec #* body]
  (setv #(variable string #* options) spec)
  (setv options (dict (zip (lfor option (cut options None None 2) option.name) (cut options 1 None 2))))
  (setv index (.get options "INDEX"))
  (setv stream `(make-string-input-stream ~string ~(.get options "START" 0) ~(.get options "END")))
  (if (is index None)
      `(let [[~variable ~stream]] (declare (ignorable ~variable)) ~@body)
      `(let [[~variable ~stream]]
         (multiple-value-prog1 (let [[~variable ~variable]] (declare (ignorable ~variable)) ~@body)
           (setf ~index (%stream-position ~variable))))))

(defoperator with-open-file [spec #* body]
  (setv #(variable path #* options) spec)
  `(%with-open-file (lambda [~variable] (declare (ignorable ~variable)) ~@body) ~path ~@options))

(defoperator with-open-stream [spec #* body]
  (setv #(variable form) spec)
  `(%with-open-stream (lambda [~variable] (declare (ignorable ~variable)) ~@body) ~form))

(defoperator with-standard-io-syntax [#* body]
  `(%with-standard-io-syntax (lambda [] ~@body)))

(defoperator print-unreadable-object [spec #* body]
  (setv #(object stream #* options) spec)
  `(%print-unreadable-object ~object ~stream ~(if body `(lambda [] ~@body) None) ~@options))

(defoperator formatter [control]
  `(%formatter ~control))

(defoperator pprint-pop []
  (raise (ValueError "PPRINT-POP must be lexically inside PPRINT-LOGICAL-BLOCK.")))

(defoperator pprint-exit-if-list-exhausted []
  (raise (ValueError "PPRINT-EXIT-IF-LIST-EXHAUSTED must be lexically inside PPRINT-LOGICAL-BLOCK.")))

(defoperator pprint-logical-block [spec #* body]
  (setv #(stream items #* options) spec)
  (setv variable (if (and (isinstance stream LispSymbol)) stream (gensym "STREAM")))
  (setv #(declarations forms) (split-declarations body))
  `(%pprint-logical-block
     (lambda [~variable]
       (declare (ignorable ~variable))
       ~@declarations
       (macrolet [[pprint-pop [] (quote (%pprint-pop ~variable))]
                  [pprint-exit-if-list-exhausted [] (quote (if (%pprint-list-exhausted ~variable) (return nil) nil))]]
         (block nil ~@forms)))
     ~stream ~items ~@options))

;; ------------------------------------------------------------------------------------------------------------ the REPL's

(defoperator time [form]
  `(%timed (lambda [] ~form)))

(defoperator trace [#* names]
  `(%trace (quote ~names)))

(defoperator untrace [#* names]
  `(%untrace (quote ~names)))

(defoperator step [form]
  `(%step (quote ~form) (lambda [] ~form)))

(defoperator with-compilation-unit [options #* body]
  `(%with-compilation-unit (lambda [] ~@body) ~@options))

(defoperator with-hash-table-iterator [spec #* body]
  (setv #(name table) spec)
  (setv iterator (gensym "ITERATOR"))
  `(let [[~iterator (%hash-table-iterator ~table)]]
     (macrolet [[~name [] (quote (funcall ~iterator))]] ~@body)))
