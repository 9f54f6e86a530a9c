"The macros of the plan language: packages CRAM-LANGUAGE-IMPLEMENTATION and CRAM-LANGUAGE.

A branch becomes a function of no arguments, and the operator a call of a function of `cramhy_runtime.cpl` with the branches.
What the operators mean stands there, and in the sections of cpl.md that the comments name."

(require cramhy.operators [defoperator])
(import cramhy.operators *)

(setv package "CRAM-LANGUAGE-IMPLEMENTATION")

(defn branches [forms]
  (lfor form forms `(lambda [] ~form)))

;; ------------------------------------------------------------------------------------------- 5, 6: top-level and operators

(defoperator top-level [#* body]
  `(%top-level (lambda [] ~@body)))

(defoperator named-top-level [options #* body]
  (setv #(_ name) (or options [None None]))
  `(%named-top-level (quote ~name) (lambda [] ~@body)))

(defoperator seq [#* forms]
  `(progn ~@forms))

(defoperator par [#* forms]
  `(%par ~@(branches forms)))

(defoperator pursue [#* forms]
  `(%pursue ~@(branches forms)))

(defoperator try-all [#* forms]
  `(%try-all ~@(branches forms)))

(defoperator try-in-order [#* forms]
  `(block nil (%try-in-order ~@(branches forms))))

(defoperator try-each-in-order [spec #* body]
  (setv #(variable items) spec)
  `(block nil (%try-each-in-order ~items (lambda [~variable] ~@body))))

(defoperator par-loop [spec #* body]
  (setv #(variable items) spec)
  `(%par-loop ~items (lambda [~variable] ~@body)))

(defn ordering [form]
  (setv parts (elements form))
  (when (or (!= (len parts) 3) (is-not (get parts 0) (sym ":ORDER")))
    (raise (ValueError "Malformed ordering constraint.")))
  `(list ~(get parts 1) ~(get parts 2)))

(defoperator partial-order [steps #* orderings]
  `(%partial-order (list ~@(branches (elements steps))) (list ~@(map ordering orderings))))

(defoperator with-parallel-childs [name groups forms #* watcher]
  `(block nil
     (%with-parallel-childs ~name (list ~@(branches (elements forms))) (lambda ~groups ~@watcher))))

(defoperator with-task-suspended [spec #* body]
  (setv #(task #* options) spec)
  `(%with-task-suspended ~task ~(if options (get options 1) None) (lambda [] ~@body)))

(defoperator with-task [options #* body]
  (setv options (dict (zip (lfor key (cut (elements options) 0 None 2) key.name) (cut (elements options) 1 None 2))))
  `(%with-task ~(.get options "NAME" "WITH-TASK") (lambda [] ~@body)))

;; ---------------------------------------------------------------------------------------------------------- 2: fluents

(defoperator whenever [spec #* body]
  `(block nil (%whenever ~spec.car (lambda [] ~@body))))

(defoperator def-cpl-parameter [name [value None] [documentation None]]
  `(progn
     (%cpl-parameter (quote ~name) ~value)
     (define-symbol-macro ~name (%parameter-value (quote ~name)))))

;; ------------------------------------------------------------------------------------------------------------ 3: tasks

(defoperator on-suspension [form #* body]
  `(%on-suspension (lambda [] ~form) (lambda [] ~@body)))

(defoperator retry-after-suspension [#* body]
  `(%retry-after-suspension (lambda [] ~@body)))

(defoperator without-scheduling [#* body]
  `(%without-scheduling (lambda [] ~@body)))

(defoperator with-scheduling [#* body]
  `(%with-scheduling (lambda [] ~@body)))

(defoperator define-task-variable [name [value None] [documentation None] #* options]
  (setv options (dict (zip (lfor key (cut options 0 None 2) key.name) (cut options 1 None 2))))
  `(progn
     (declaim (special ~name))
     (%define-task-variable (quote ~name) ~value ~documentation ~(.get options "INIT-FUNCTION"))
     (quote ~name)))

;; --------------------------------------------------------------------------------------------------------- 4: failures

(defn handler [clause again]
  "(list (type function) ...) for a clause (type (variable) . body): one for each type of an (or ...)."
  (setv #(type variables #* body) clause)
  (setv types (if (and (listp type) (= (symbol-name type.car) "OR")) (elements type.cdr) [type]))
  (setv #(declarations forms) (split-declarations body))
  (lfor each types
    `(list (quote ~each)
           (lambda [~@(elements variables) ~again]
             ~@declarations
             (flet [[retry [] (funcall ~again)]] ~@forms)))))

(defoperator with-failure-handling [clauses #* body]
  (setv again (gensym "RETRY"))
  `(block nil
     (%with-failure-handling
       (list ~@(sum (lfor clause (elements clauses) (handler clause again)) []))
       (lambda [~again] (flet [[retry [] (funcall ~again)]] ~@body)))))

(defoperator with-retry-counters [counters #* body]
  (setv pairs (lfor #(name initial) (elements counters) #(name initial (gensym name.name))))
  (setv table (list-from (lfor #(name _ variable) pairs (Cons name variable))))
  `(let [~@(lfor #(_ initial variable) pairs [variable `(%make-retry-counter (lambda [] ~initial))])]
     (macrolet [[do-retry [name &rest forms]
                  (list* 'when (list '%use-retry (%counter-variable name '~table)) forms)]
                [get-counter [name] (list '%counter-value (%counter-variable name '~table))]
                [reset-counter [name] (list '%reset-retry-counter (%counter-variable name '~table))]]
       ~@body)))

;; -------------------------------------------------------------------------------------------------- 7: tags, task tree

(defn tag-names [form found]
  "The names of the (:tag name ...) forms in `form`, in textual order; quoted data is not entered."
  (setv cell form)
  (while (listp cell)
    (setv item cell.car)
    (when (and (listp item) (is-not item.car (sym "QUOTE")))
      (when (and (is item.car (sym ":TAG")) (listp item.cdr) (not-in item.cdr.car found))
        (.append found item.cdr.car))
      (tag-names item found))
    (setv cell cell.cdr))
  found)

(defoperator with-tags [#* body]
  (setv names (tag-names (list-from body) []))
  `(progn
     (%enter-with-tags)
     (let [~@(lfor name names [name `(%make-tag-task (quote ~name))])]
       (macrolet [[tag-form [name &rest forms]
                    (list 'progn
                          (list 'setq name (list '%prepare-tag name))
                          (list '%execute-tag name (list* 'lambda nil forms)))]]
         ~@body))))

(defn expand-tag [form environment]
  "The meaning of (:tag name . body): a keyword is no operator, so this is entered by hand."
  (setv local (sym "CPL-IMPL::TAG-FORM"))
  (setv expander (when (is-not environment None) (.function environment local)))
  (if (is expander None)
      (lisp-list (sym "CRAMHY::TAG-OUTSIDE-OF-WITH-TAGS") (lisp-list (sym "QUOTE") form.cdr.car))
      (.expander expander (Cons local form.cdr) environment)))

(setv (. (sym ":TAG") macro) expand-tag)

(defoperator with-task-tree-node [options #* body]
  (setv table (dict (zip (lfor key (cut (elements options) 0 None 2) key.name) (cut (elements options) 1 None 2))))
  (when (not-in "PATH-PART" table)
    (raise (ValueError "Path parameter is required.")))
  `(%with-tree-node ~(get table "PATH-PART") (lambda ~(.get table "LAMBDA-LIST") ~@body)
                    ~(.get table "NAME" "WITH-TASK-TREE-NODE") ~(.get table "PARAMETERS")))

(defoperator replaceable-function [name lambda-list parameters path-part #* body]
  `(with-task-tree-node [:path-part ~path-part :name ~(+ "REPLACEABLE-FUNCTION-" (symbol-name name))
                         :lambda-list ~lambda-list :parameters ~parameters]
     ~@body))

;; --------------------------------------------------------------------------------------------- 8: plan functions, goals

(defn plan-function [name lambda-list body call kind]
  (setv documentation (if (and (> (len body) 1) (isinstance (get body 0) str)) [(get body 0)] []))
  (setv forms (cut body (len documentation) None) arguments (gensym "ARGUMENTS"))
  `(progn
     (defun ~name [&rest ~arguments]
       ~@documentation
       (~call (quote ~name) (lambda ~lambda-list (with-tags ~@forms)) ~arguments))
     (%note-plan (quote ~name) ~kind (quote ~lambda-list))
     (quote ~name)))

(defoperator def-cram-function [name lambda-list #* body]
  (plan-function name lambda-list body '%cram-function-call "PLAN"))

(defoperator def-top-level-cram-function [name lambda-list #* body]
  (plan-function name lambda-list body '%top-level-cram-function-call "TOP-LEVEL-PLAN"))

(defn deprecated [old new form]
  (import cramhy_runtime.lisp.conditions [style-warn])
  (style-warn (+ "Use of deprecated form " old ". Please use " new " instead."))
  form)

(defoperator def-plan [name lambda-list #* body]
  (deprecated "DEF-PLAN" "DEF-CRAM-FUNCTION" `(def-cram-function ~name ~lambda-list ~@body)))

(defoperator def-top-level-plan [name lambda-list #* body]
  (deprecated "DEF-TOP-LEVEL-PLAN" "DEF-TOP-LEVEL-CRAM-FUNCTION" `(def-top-level-cram-function ~name ~lambda-list ~@body)))

(defoperator declare-goal [name lambda-list #* body]
  (setv arguments (gensym "ARGUMENTS"))
  (setv documentation (if (and body (isinstance (get body 0) str)) [(get body 0)] []))
  `(progn
     (%declare-goal (quote ~name))
     (defun ~name [&rest ~arguments]
       ~@documentation
       (block nil
         (apply (lambda ~lambda-list ~@(cut body (len documentation) None)) ~arguments)
         (%goal-call (quote ~name) ~arguments)))))

(defoperator def-goal [head #* body]
  (setv name head.car pattern head.cdr bindings (gensym "BINDINGS") values (gensym "VALUES") body-block (gensym "GOAL"))
  (setv documentation (if (and (> (len body) 1) (isinstance (get body 0) str)) (get body 0) None))
  `(%register-goal (quote ~name) (quote ~pattern)
     (lambda [~bindings]
       (block ~body-block
         (flet [[succeed [&rest ~values] (return-from ~body-block (values-list ~values))]]
           (cut:with-vars-bound ~(list-from (pattern-variables pattern)) ~bindings
             (with-tags ~@(if documentation (cut body 1 None) body))))))
     ~documentation))

(defn pattern-variables [pattern [found None]]
  "The variables ?x of a pattern, without the anonymous one."
  (setv found (if (is found None) [] found))
  (cond
    (listp pattern) (do (pattern-variables pattern.car found) (pattern-variables pattern.cdr found))
    (and (isinstance pattern LispSymbol) (.startswith pattern.name "?") (!= pattern.name "?_") (not-in pattern found))
    (.append found pattern))
  found)

;; --------------------------------------------------------------------------------------------------------- 9: policies

(defn policy-parts [parameters rest]
  "(documentation, list of the clauses as functions of the store and the parameters)"
  (setv documentation (if (and rest (isinstance (get rest 0) str)) (get rest 0) None))
  (setv clauses (if documentation (cut rest 1 None) rest) store (gensym "STORE"))
  #(documentation
    `(list ~@(lfor clause clauses
       `(list ~clause.car
              (lambda [~store ~@(elements parameters)]
                (flet [[policy-get [symbol] (%policy-get ~store symbol)]
                       [policy-setf [symbol value] (%policy-set ~store symbol value)]]
                  ~@(elements clause.cdr))))))))

(defoperator make-policy [name parameters #* rest]
  (setv #(documentation clauses) (policy-parts parameters rest))
  `(%make-policy (quote ~name) (quote ~parameters) ~documentation ~clauses))

(defoperator define-policy [name parameters #* rest]
  (setv #(documentation clauses) (policy-parts parameters rest))
  `(progn
     (declaim (special ~name))
     (%define-policy (quote ~name) (quote ~parameters) ~documentation ~clauses)))

(defoperator with-policy [policy parameters #* body]
  `(%with-policy ~policy (lambda [] (list ~@(elements parameters))) (quote ~parameters) (lambda [] ~@body)))

(defoperator with-named-policy [name parameters #* body]
  `(with-policy (%named-policy ~name) ~parameters ~@body))

(defn nested [operator policies body]
  (setv form `(progn ~@body))
  (for [#(policy parameters) (reversed (elements policies))]
    (setv form `(~operator ~policy ~parameters ~form)))
  form)

(defoperator with-policies [policies #* body]
  (nested 'with-policy policies body))

(defoperator with-named-policies [policies #* body]
  (nested 'with-named-policy policies body))

;; --------------------------------------------------------------------------------------------------------- 10: logging

(defoperator log-event [#* clauses]
  (setv parts (dfor clause clauses clause.car.name (elements clause.cdr)))
  (when (not-in "TAGS" parts)
    (raise (ValueError "Missing (:TAGS ...) clause.")))
  `(%log-line (lambda [] (format nil ~@(.get parts "CONTEXT" [""]))) (lambda [] (format nil ~@(.get parts "DISPLAY" [""])))
              (quote ~(list-from (get parts "TAGS")))))

(defoperator logging-enabled-p [#* tags]
  `(%logging-enabled (quote ~tags)))
