"The macros of plans as trees of named steps: tags, nodes of the task tree, plan functions and goals (cpl.md 7, 8).

What they mean is in `cramhy_runtime.cpl`: `tree/tags.py`, `tree/task_tree.py`, `forms/plans.py`. A body is quoted beside its
function, because the task tree and `expand-plan` show it."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *
        cramhy_runtime.lisp_core.conditions [SimpleStyleWarning style-warn]
        cramhy_runtime.languages.commonlisp.compiler.compilation-unit [current :as compilation-unit]
        cramhy_runtime.cpl.tree.tags [check-tag is-tag-name]
        cramhy_runtime.languages.commonlisp.faces.cpl.walker [tag-names])

(setv package "CRAM-LANGUAGE-IMPLEMENTATION")

;; ------------------------------------------------------------------------------------------------------------- 7.1: tags

(setv tag (sym ":TAG") tag-form (sym "CPL-IMPL::TAG-FORM"))

(defoperator with-tags [#* body environment]
  (setv names (lfor name (tag-names body environment) :if (is-tag-name name) name))
  `(let [~@(lfor name names [name `(%make-tag-task (quote ~name))])]
     ~@(if names [] ['(%enter-with-tags)])
     (macrolet [[tag-form [name form]
                  (list 'progn
                        (list 'setq name (list '%prepare-tag name))
                        (list '%execute-tag name (list* 'lambda nil (cdr form)) (list 'quote (cons :tag form))))]]
       ~@body)))

(defn expand-tag [form environment]
  "The meaning of (:tag name . body): a keyword is no operator, so this is entered by hand."
  (setv local (when (is-not environment None) (.function environment tag-form)))
  (check-tag form (is-not local None))
  (.expander local (lisp-list tag-form form.cdr.car form.cdr) environment))

(setv tag.macro expand-tag)

;; ------------------------------------------------------------------------------------------------ 7.4: nodes of the task tree

(defoperator with-task-tree-node [options #* body]
  (setv options (keyword-options "WITH-TASK-TREE-NODE" (elements options)
                                 ["PATH-PART" "NAME" "SEXP" "LAMBDA-LIST" "PARAMETERS" "LOG-PARAMETERS" "LOG-PATTERN"]))
  (when (not-in "PATH-PART" options)
    (error (CompileError "Path parameter is required.")))
  (setv lambda-list (.get options "LAMBDA-LIST"))
  `(%with-tree-node ~(get options "PATH-PART") (lambda ~lambda-list ~@body) ~(.get options "NAME" "WITH-TASK-TREE-NODE")
                    ~(.get options "SEXP") (quote ~lambda-list) ~(.get options "PARAMETERS") ~(.get options "LOG-PARAMETERS")
                    ~(.get options "LOG-PATTERN")))

(defoperator replaceable-function [name lambda-list parameters path-part #* body]
  `(with-task-tree-node [:path-part ~path-part :name ~(+ "REPLACEABLE-FUNCTION-" (symbol-name name))
                         :sexp (quote (replaceable-function ~name ~lambda-list ~@body))
                         :lambda-list ~lambda-list :parameters ~parameters]
     ~@body))

;; --------------------------------------------------------------------------------------------------- 8.1-8.3: plan functions

(defn plan-function [name lambda-list body call kind]
  (setv #(documentation declarations forms) (documentation-and-body body) arguments (gensym "ARGUMENTS"))
  `(progn
     (defun ~name [&rest ~arguments]
       ~@documentation
       (~call (quote ~name) (lambda ~lambda-list ~@declarations (block ~name (with-tags ~@forms))) ~arguments))
     (%define-plan (quote ~name) ~kind (quote ~lambda-list) (quote ~(list-from forms)))))

(defoperator def-cram-function [name lambda-list #* body]
  (plan-function name lambda-list body '%cram-function-call "PLAN"))

(defoperator def-top-level-cram-function [name lambda-list #* body]
  (plan-function name lambda-list body '%top-level-cram-function-call "TOP-LEVEL-PLAN"))

(defn deprecated [old new form]
  (setv text (+ "Use of deprecated form " old ". Please use " new " instead.") unit (compilation-unit))
  (if (is unit None) (style-warn text) (.tell unit SimpleStyleWarning text))
  form)

(defoperator def-plan [name lambda-list #* body]
  (deprecated "DEF-PLAN" "DEF-CRAM-FUNCTION" `(def-cram-function ~name ~lambda-list ~@body)))

(defoperator def-top-level-plan [name lambda-list #* body]
  (deprecated "DEF-TOP-LEVEL-PLAN" "DEF-TOP-LEVEL-CRAM-FUNCTION" `(def-top-level-cram-function ~name ~lambda-list ~@body)))

;; ---------------------------------------------------------------------------------------------------------- 8.4, 8.5: goals

(defoperator declare-goal [name lambda-list #* body]  ; what the body returns is ignored, so a string alone documents too
  (setv #(documentation declarations forms) (documentation-and-body (+ body #(None))) arguments (gensym "ARGUMENTS"))
  `(progn
     (defun ~name [&rest ~arguments]
       ~@documentation
       (block nil
         (apply (lambda ~lambda-list ~@declarations ~@forms) ~arguments)
         (%call-goal (quote ~name) ~arguments)))
     (%declare-goal (quote ~name))))

(defoperator def-goal [head #* body]
  (setv name head.car pattern head.cdr bindings (gensym "BINDINGS") values (gensym "VALUES") body-block (gensym "GOAL"))
  (setv #(documentation declarations forms) (documentation-and-body body))
  `(%define-goal (quote ~name) (quote ~pattern)
     (lambda [~bindings]
       (block ~body-block
         (flet [[succeed [&rest ~values] (return-from ~body-block (values-list ~values))]]
           (cut:with-vars-bound ~(list-from (pattern-variables pattern)) ~bindings
             ~@declarations
             (with-tags ~@forms)))))
     ~(if documentation (get documentation 0) None)
     (quote (def-goal ~head ~@body))))

(defn pattern-variables [pattern [found None]]
  "The variables ?x of a pattern, without the anonymous one."
  (setv found (if (is found None) [] found))
  (cond
    (listp pattern) (do (pattern-variables pattern.car found) (pattern-variables pattern.cdr found))
    (and (isinstance pattern LispSymbol) (.startswith pattern.name "?") (!= pattern.name "?_") (not-in pattern found))
    (.append found pattern))
  found)
