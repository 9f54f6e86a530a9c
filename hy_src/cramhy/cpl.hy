"The macros of the plan language: packages CRAM-LANGUAGE-IMPLEMENTATION and CRAM-LANGUAGE. Those of the task tree, of plan
functions and of goals are in `plans.hy`.

A branch becomes a function of no arguments, and the operator a call of a function of `cramhy_runtime.cpl` with the branches.
What the operators mean stands there, and in the sections of cpl.md that the comments name."

(eval-when-compile (require cramhy.operators [defoperator]))
(import itertools
        cramhy.operators *
        cramhy_runtime.cpl.logging [check-constant-tags]
        cramhy_runtime.cpl.failures.retry_counters [counter-variable]
        cramhy_runtime.lisp_core.conditions [CompileError SimpleWarning]
        cramhy_runtime.languages.commonlisp.compiler.compilation_unit [mention-type warn-of]
        cramhy_runtime.languages.commonlisp.printer.printer [prin1-to-string])

(setv package "CRAM-LANGUAGE-IMPLEMENTATION")

(defn branches [forms]
  (lfor form forms `(lambda [] ~form)))

;; ------------------------------------------------------------------------------------------- 5, 6: top-level and operators

(defn ordering [form]
  (setv parts (if (listp form) (elements form) []))
  (when (or (!= (len parts) 3) (is-not (get parts 0) (sym ":ORDER")))
    (setv problem (CompileError "Malformed ordering constraint."))
    (setv problem.hint (.format "Instead of {} write (:order before after)." (prin1-to-string form)))
    (error problem))
  `(list ~(get parts 1) ~(get parts 2)))

(defoperator partial-order [steps #* orderings]
  `(%partial-order (list ~@(branches (elements steps))) (lambda [] (list ~@(map ordering orderings)))))

(defoperator with-parallel-childs [name groups forms #* watcher]
  `(block nil
     (%with-parallel-childs ~name (list ~@(branches (elements forms))) (lambda ~groups ~@watcher))))

(defoperator with-task-suspended [spec #* body]
  (setv #(task #* options) spec)
  (when (and options (or (!= (len options) 2) (is-not (get options 0) (sym ":REASON"))))
    (raise (ValueError "after the task only :REASON and a text may stand.")))
  `(%with-task-suspended ~task (lambda [] ~@body) ~(if options (get options 1) None)))

(defoperator with-task [options #* body]
  (setv options (keyword-options "WITH-TASK" (elements options) ["CLASS" "NAME"]))
  `(%with-task ~(.get options "CLASS" '(quote task)) ~(.get options "NAME" "WITH-TASK") (lambda [] ~@body)))

;; ---------------------------------------------------------------------------------------------------------- 2: fluents

(defoperator whenever [spec #* body]
  (setv #(fluent #* options) spec)
  (when (and options (or (!= (len options) 2) (is-not (get options 0) (sym ":WAIT-STATUS"))))
    (raise (ValueError "after the fluent only :WAIT-STATUS and a value may stand.")))
  `(block nil (%whenever ~(if options `(prog1 ~fluent ~(get options 1)) fluent) (lambda [] ~@body))))

(defoperator def-cpl-parameter [name [value None] [documentation None]]
  `(progn
     (%define-cpl-parameter (quote ~name) ~value)
     ~@(if documentation [`(setf (documentation (quote ~name) (quote variable)) ~documentation)] [])
     (define-symbol-macro ~name (%parameter-value (quote ~name)))))

;; ------------------------------------------------------------------------------------------------------------ 3: tasks

(defoperator define-task-variable [name [value None] [documentation None] #* options]
  (setv table (keyword-options "DEFINE-TASK-VARIABLE" options ["TYPE" "INIT-FUNCTION" "IGNORE-PACKAGE-LOCKS"]))
  (setv type (.get table "TYPE"))
  (setv form `(progn
     (defvar ~name ~value ~@(if documentation [documentation] []))
     ~@(if type [`(declaim (type ~type ~name))] [])
     (%define-task-variable (quote ~name) ~(.get table "INIT-FUNCTION"))
     (quote ~name)))
  (if (.get table "IGNORE-PACKAGE-LOCKS") `(sb-ext:without-package-locks ~form) form))

;; --------------------------------------------------------------------------------------------------------- 4: failures

(defn wrong [form operator part why]
  "The error of a part of a call that has not the shape it must have."
  (setv problem (CompileError "~A: ~S is malformed: ~A" operator part why))
  (setv problem.hint form)
  (error problem))

(defn is-code [part]
  "Whether PART is Hy code in a Lisp form, such as the name of a class with its module before it."
  (hasattr part "model"))

(defn failure-types [clause]
  "The types of the conditions that a clause of `with-failure-handling` handles."
  (defn no-clause [why]
    (wrong "A clause is written (plan-failure (failure) form*) or ((or type*) (failure) form*)."
           "WITH-FAILURE-HANDLING" clause why))
  (when (not (and (listp clause) (listp clause.cdr) (or (is clause.cdr.car None) (listp clause.cdr.car))))
    (no-clause "a clause is a list of a type, a parameter list and forms."))
  (setv named clause.car parameters (elements clause.cdr.car) unions (and (listp named) (is named.car (sym "OR"))))
  (setv types (if unions (elements named.cdr) [named]))
  (for [each types]
    (when (not (or (is-symbol each) (is-code each)))
      (no-clause (if unions "OR takes names of condition types." "its type must be a name or (OR name*).")))
    (when (is-symbol each) (mention-type each)))
  (setv required (list (itertools.takewhile (fn [name] (not (.startswith (symbol-name name) "&"))) parameters)))
  (when (or (> (len required) 1) (not parameters))
    (no-clause "its parameter list must take one argument, the condition."))
  types)

(defn handlers [clauses again]
  "type function ... for the clauses: one pair for each type of an (or ...), and one for types named twice, the last."
  (setv found {})
  (for [clause (elements clauses)]
    (setv types (failure-types clause) #(_ variables #* body) clause)
    (setv #(declarations forms) (split-declarations body))
    (setv body `(~@declarations (flet [[retry [] (%retry ~again)]] ~@forms)))
    (setv condition (gensym "CONDITION"))
    (for [each types]
      (when (in each found)
        (.pop found each)
        (warn-of SimpleWarning "WITH-FAILURE-HANDLING has two clauses for ~S. The last one counts." each))
      (setv (get found each)
            (if (and (is variables.cdr None) (not (.startswith (symbol-name variables.car) "&")))
                `(lambda [~variables.car ~again] ~@body)
                `(lambda [~condition ~again] (funcall (lambda ~variables ~@body) ~condition))))))
  (lfor #(each function) (.items found) part [(if (is-code each) each `(quote ~each)) function] part))

(defoperator with-failure-handling [clauses #* body]
  (setv again (gensym "RETRY"))
  (when (not (or (is clauses None) (listp clauses)))
    (wrong "It is written (with-failure-handling ((plan-failure (failure) form*)) form*)." "WITH-FAILURE-HANDLING" clauses
           "the first part is a list of clauses."))
  `(block nil
     (%handling-failures
       (lambda [~again] (flet [[retry [] (%retry ~again)]] ~@body))
       ~@(handlers clauses again))))

(defoperator with-retry-counters [counters #* body]
  (setv names [])
  (for [counter (elements counters)]
    (when (not (and (listp counter) (is-symbol counter.car) (listp counter.cdr) (is counter.cdr.cdr None)))
      (wrong "It is written (with-retry-counters ((counter 2)) form*)." "WITH-RETRY-COUNTERS" counter
             "a counter is a list of a name and a form that gives its first value."))
    (when (in counter.car names)
      (wrong "Give every counter a name of its own." "WITH-RETRY-COUNTERS" counter "there is a counter of this name already."))
    (.append names counter.car))
  `(let [~@(lfor #(name initial) (elements counters) [(counter-variable name) `(%make-retry-counter (lambda [] ~initial))])]
     (macrolet [[do-retry [counter &body forms &environment here]
                  (list* 'when (list '%use-retry (%known-counter counter here)) forms)]
                [get-counter [counter &environment here] (list '%counter-value (%known-counter counter here))]
                [reset-counter [counter &environment here] (list '%reset-retry-counter (%known-counter counter here))]]
       ~@body)))

;; --------------------------------------------------------------------------------------------------------- 9: policies

(setv policy-clauses [":INIT" ":CHECK" ":RECOVER" ":CLEAN-UP"])

(defn policy-parts [operator name parameters rest]
  "(documentation, list of the clauses as functions of the store and the parameters)"
  (defn no-policy [part why]
    (wrong "A policy is written (define-policy name (parameter*) (:init form*) (:check form*) (:recover form*) (:clean-up form*))."
           operator part why))
  (when (or (not (is-symbol name)) (is name None))
    (no-policy name "its name must be a symbol."))
  (when (not (or (is parameters None) (listp parameters)))
    (no-policy parameters "after the name comes the list of its parameters."))
  (setv documentation None clauses {} store (gensym "STORE"))
  (setv variables (lfor part (elements parameters) (if (listp part) part.car part)))
  (setv variables (lfor variable variables :if (and (is-symbol variable) (not (.startswith (symbol-name variable) "&"))) variable))
  (for [part rest]
    (cond
      (and (isinstance part str) (is documentation None)) (setv documentation part)
      (not (and (listp part) (in part.car (map sym policy-clauses))))
      (no-policy part (+ "it is none of the clauses " (.join " " policy-clauses) "."))
      (in part.car clauses) (no-policy part "there is a clause of this name already.")
      True (setv (get clauses part.car) (elements part.cdr))))
  (defn clause-function [body]
    (setv #(declarations forms) (split-declarations body))
    `(lambda [~store ~@(elements parameters)]
       (declare (ignorable ~@variables))
       ~@declarations
       (flet [[policy-get [symbol] (%policy-get ~store symbol)]
              [policy-setf [symbol value] (%policy-set ~store symbol value)]]
         ~@forms)))
  #(documentation `(list ~@(lfor #(key body) (.items clauses) `(list ~key ~(clause-function body))))))

(defoperator make-policy [name parameters #* rest]
  (setv #(documentation clauses) (policy-parts "MAKE-POLICY" name parameters rest))
  `(%make-policy (quote ~name) (quote ~parameters) ~documentation ~clauses))

(defoperator define-policy [name parameters #* rest]
  (setv #(documentation clauses) (policy-parts "DEFINE-POLICY" name parameters rest))
  `(progn
     (declaim (special ~name))
     (%define-policy (quote ~name) (quote ~parameters) ~documentation ~clauses)))

(defn under-policy [operator policy parameters body]
  (when (not (or (is parameters None) (listp parameters)))
    (wrong (+ "It is written (" (.lower operator) " policy (parameter*) form*).") operator parameters
           "after the policy comes the list of its parameters."))
  `(%with-policy ~policy (lambda [] (list ~@(elements parameters))) (quote ~parameters) (lambda [] ~@body)))

(defoperator with-policy [policy parameters #* body]
  (under-policy "WITH-POLICY" policy parameters body))

(defoperator with-named-policy [name parameters #* body]
  (under-policy "WITH-NAMED-POLICY" `(%named-policy ~name) parameters body))

(defn nested [operator inner policies body]
  (setv form `(progn ~@body))
  (for [part (reversed (elements policies))]
    (when (not (and (listp part) (listp part.cdr) (is part.cdr.cdr None)))
      (wrong (+ "It is written (" (.lower operator) " ((policy (parameter*))*) form*).") operator part
             "each policy is a list of it and the list of its parameters."))
    (setv form `(~inner ~part.car ~part.cdr.car ~form)))
  form)

(defoperator with-policies [policies #* body]
  (nested "WITH-POLICIES" 'with-policy policies body))

(defoperator with-named-policies [policies #* body]
  (nested "WITH-NAMED-POLICIES" 'with-named-policy policies body))

;; --------------------------------------------------------------------------------------------------------- 10: logging

(defoperator log-event [#* clauses]
  (setv parts {})
  (for [clause clauses]
    (when (not (and (listp clause) (in clause.car (map sym [":CONTEXT" ":DISPLAY" ":TAGS"])) (not-in clause.car.name parts)))
      (wrong "It is written (log-event (:context control argument*) (:display control argument*) (:tags tag*))." "LOG-EVENT" clause
             "it is none of the clauses :CONTEXT, :DISPLAY and :TAGS, or the second of its name."))
    (setv (get parts clause.car.name) (elements clause.cdr)))
  (when (not (.get parts "TAGS"))
    (error (CompileError "Missing (:TAGS ...) clause.")))
  (check-constant-tags (get parts "TAGS"))
  (defn formatted [part]
    (setv #(control #* arguments) (or (.get parts part) [""]))
    [control `(list ~@arguments)])
  `(progn
     (%log-event (quote ~(list-from (get parts "TAGS")))
                 (lambda [] (list ~@(formatted "CONTEXT") ~@(formatted "DISPLAY"))))
     (values)))

(defoperator logging-enabled-p [#* tags]
  (check-constant-tags tags)
  `(%logging-enabled-p (quote ~(list-from tags))))

(defoperator define-log-tags [#* tags]
  `(eval-when [:compile-toplevel :load-toplevel :execute]
     (%define-log-tags (quote ~(list-from tags)))))

(defoperator log-block [begin-hook parameters end-hook #* body]
  "The body between two hooks; the second gets the first result of the first, and whether the body called `log-succeed` last."
  (setv id (gensym "ID") succeeded (gensym "SUCCEEDED"))
  `(let [[~id (first (~begin-hook ~@(elements parameters)))] [~succeeded nil]]
     (flet [[log-succeed [] (setq ~succeeded t)]
            [log-fail [] (setq ~succeeded nil)]]
       (unwind-protect (progn ~@body) (~end-hook ~id ~succeeded)))))
