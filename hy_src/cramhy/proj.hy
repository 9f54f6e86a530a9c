"The macros of CRAM-PROJECTION (projection-and-events.md, part A)."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *)

(setv package "CRAM-PROJECTION")

(defn thunk [table key]
  "The form under the option `key` as a function of no arguments; nil without one."
  (if (in key table) `(lambda [] ~(get table key)) None))

(defoperator define-projection-environment [name #* options]
  (setv table (keyword-options "DEFINE-PROJECTION-ENVIRONMENT" options
                               ["SPECIAL-VARIABLE-INITIALIZERS" "PROCESS-MODULE-DEFINITIONS" "STARTUP" "SHUTDOWN"]))
  (setv pairs [])
  (for [pair (elements (.get table "SPECIAL-VARIABLE-INITIALIZERS"))]
    (setv #(variable form) pair)
    (.append pairs #(variable form)))
  `(progn
     ~@(lfor #(variable _) pairs `(defvar ~variable))
     (%define-projection-environment
       (quote ~name)
       (list ~@(lfor #(variable form) pairs `(list (quote ~variable) (lambda [] ~form))))
       (quote ~(.get table "PROCESS-MODULE-DEFINITIONS"))
       ~(thunk table "STARTUP") ~(thunk table "SHUTDOWN"))))

(defoperator define-special-projection-variable [name initializer]
  `(progn
     (defvar ~name)
     (%define-special-projection-variable (quote ~name) (lambda [] ~initializer))))
