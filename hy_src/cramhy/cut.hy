"The macros of CRAM-UTILITIES: lazy lists and pattern variables (cpl.md 13)."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *
        cramhy_runtime.lisp_core.packages [keyword]
        cramhy-runtime.utilities.patterns [var-name])

(setv package "CRAM-UTILITIES")

(defn parameter-parts [parameters]
  "(names, initial forms) of bindings as in `let`."
  #((lfor parameter (elements parameters) (if (listp parameter) parameter.car parameter))
    (lfor parameter (elements parameters) (if (and (listp parameter) (listp parameter.cdr)) parameter.cdr.car None))))

(setv lazy-restarts (lfor name ["CONT" "NEXT" "FINISH" "REST"] (keyword name)))

(defn names-restart [form]
  "Whether `form` mentions one of the restarts that a lazy list has in the original; they cost time, so others do without."
  (cond
    (listp form) (or (names-restart form.car) (names-restart form.cdr))
    True (any (gfor restart lazy-restarts (is form restart)))))

(defoperator lazy-list [parameters #* body]
  (setv #(names initial) (parameter-parts parameters))
  (setv give (gensym "CONT") again (gensym "NEXT") end (gensym "FINISH") rest (gensym "ARGUMENTS"))
  `(%lazy-list-of (list ~@initial)
     (lambda [~give ~again ~end ~@names]
       (flet [[cont [&rest ~rest] (apply ~give ~rest)]
              [next [&rest ~rest] (apply ~again ~rest)]
              [finish [&rest ~rest] (apply ~end ~rest)]]
         ~@body))
     ~(names-restart (list-from body))))

(defoperator with-lazy-list-dynamic-environment [definitions #* body]
  `(%lazy-environment (quote ~(list-from (lfor definition (elements definitions) definition.car)))
                      (list ~@(lfor definition (elements definitions) `(lambda [] ~definition.cdr.car)))
                      (lambda [] ~@body)))

(defoperator lazy-dolist [spec #* body]
  (setv #(variable items #* result) spec)
  `(block nil
     (%lazy-dolist ~items (lambda [~variable] (declare (ignorable ~variable)) ~@body))
     (let* [[~variable nil]] (declare (ignorable ~variable)) ~(if result (get result 0) None))))

(defn binding-form [variables values body]
  "Bind `variables` to the elements of the list that the form `values` gives."
  (setv rest (gensym "VALUES"))
  `(let* [[~rest ~values]
          ~@(sum (lfor variable (elements variables) [[variable `(car ~rest)] [rest `(cdr ~rest)]]) [])]
     ~@body))

(defoperator with-vars-bound [variables bindings #* body]
  (binding-form variables `(%values-of-variables (quote ~variables) ~bindings) body))

(defoperator with-vars-strictly-bound [variables bindings #* body]
  (binding-form variables `(%strict-values-of-variables (quote ~variables) ~bindings) body))

(defn pattern-variables [pattern found]
  (cond
    (listp pattern) (do (pattern-variables pattern.car found) (pattern-variables pattern.cdr found))
    (and (isinstance pattern LispSymbol) (.startswith pattern.name #("?" "!?")) (not-in pattern.name ["?_" "!?_"]))
    (do (setv variable (var-name pattern))
        (when (not-in variable found) (.append found variable))))
  found)

(defoperator with-pat-vars-bound [pattern sequence #* body]
  (setv variables (list-from (pattern-variables pattern [])))
  (binding-form variables `(%values-of-pattern (quote ~pattern) ~sequence (quote ~variables)) body))

(defoperator "flet*" [functions #* body]
  (setv form `(progn ~@body))
  (for [function (reversed (elements functions))]
    (setv form `(flet [~function] ~form)))
  form)

(defoperator string-case [string #* clauses]
  "Dispatch on a string whatever its case; the keys of a clause are one string or a list of them, or `t`."
  (setv value (gensym "STRING"))
  `(let [[~value ~string]]
     (cond
       ~@(lfor clause clauses
           (if (is clause.car True)
               `[t ~@(elements clause.cdr)]
               `[(or ~@(lfor key (if (listp clause.car) (elements clause.car) [clause.car]) `(string-equal ~value ~key)))
                 ~@(elements clause.cdr)])))))

(defoperator destructure-case [form #* clauses]
  "Dispatch on the first element of a list and destructure the rest: `((:move x y) ...)`."
  (setv value (gensym "VALUE"))
  `(let [[~value ~form]]
     (case (car ~value)
       ~@(lfor clause clauses
           (if (is clause.car True)
               clause
               `[~clause.car.car (destructuring-bind ~clause.car.cdr (cdr ~value) ~@(elements clause.cdr))]))
       ~@(if (and clauses (is (. (get clauses -1) car) True)) [] [`[t (error "destructure-case failed: ~S" ~value)]]))))

(defoperator with-synchronization-barrier [spec #* body]
  "`((variable n &key name recyclable) form...)`: `variable` is a new barrier, which is broken when the form is left."
  `(%with-synchronization-barrier (make-synchronization-barrier ~@(elements spec.cdr)) (lambda [~spec.car] ~@body)))

(defoperator with-synchronization-barriers [specs #* body]
  "`(((variable n ...)...) form...)`"
  (setv form `(progn ~@body))
  (for [spec (reversed (elements specs))]
    (setv form `(with-synchronization-barrier ~spec ~form)))
  form)

(defoperator choose [tag #* options]
  "`(choose tag :parameters (x y) :generators (form-x form-y) :body form)`: a tag that computes each parameter by its generator."
  (setv options (dict (zip (lfor key (cut options None None 2) key.name) (cut options 1 None 2))))
  (setv parameters (elements (.get options "PARAMETERS")) generators (elements (.get options "GENERATORS")))
  (when (!= (len parameters) (len generators))
    (error "~S has ~D parameters and ~D generators; each parameter needs one." tag (len parameters) (len generators)))
  `(:tag ~tag (let* [~@(lfor #(parameter generator) (zip parameters generators) [parameter generator])] ~(.get options "BODY"))))

(defoperator define-hook [name lambda-list #* options]
  "A generic function that calls all applicable methods, the most specific first, and gives the list of their results.

  The option `(:method-combination :hook-combination operator)` has `operator` called with the results instead, and
  `(:method-combination cut:ordered-hooks)` has those called first whose qualifiers are a name and a number."
  (setv combination (sym ":METHOD-COMBINATION"))
  (setv wanted (sum (lfor option options :if (and (listp option) (is option.car combination)) (elements option.cdr)) []))
  (setv own (and wanted (not (.startswith (str (get wanted 0)) ":")) (is-not (get wanted 0) (sym "CUT::HOOKS")) (get wanted 0)))
  (setv wanted (cut wanted (if (in (sym ":HOOK-COMBINATION") wanted) (.index wanted (sym ":HOOK-COMBINATION")) (len wanted)) None))
  `(defgeneric ~name ~lambda-list
     (:method-combination ~(or own (sym "CUT::HOOKS")) ~@wanted)
     ~@(lfor option options :if (not (and (listp option) (is option.car combination))) option)))
