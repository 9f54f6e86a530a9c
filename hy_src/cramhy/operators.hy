"How a macro of the plan language is written: `defoperator`.

An operator gets the forms of its call as they were read, and returns a form made by quasiquote, in which unqualified symbols
are those of Common Lisp or else of the Lisp package named by the file's `package`; `%name` belongs to CRAMHY, where the
runtime's helpers are, and `pkg::name` to that package. Lists in brackets are lists. `(gensym \"X\")` makes a fresh variable."

(import cramhy_runtime.lisp.evaluation.macros [define-operator malformed]
        cramhy_runtime.lisp.data [Cons Symbol :as LispSymbol list-from lisp-list]
        cramhy_runtime.lisp.conditions [error program-error]
        cramhy_runtime.lisp.evaluation.lambda_lists [gensym]
        cramhy_runtime.lisp.packages [sym is-symbol symbol-name])

(defmacro defoperator [name parameters #* body]
  "Define the macro `name` of the Lisp package that the variable `package` names.

  The name may be a string when Hy could not read it as a symbol. Parameters are Python parameters: `#* body` takes the rest."
  (setv function (hy.models.Symbol (hy.mangle (+ "expand-" (str name)))))
  `(do
     (defn ~function ~parameters ~@body)
     (define-operator package ~(str name) ~function)))

(defn listp [form]
  "Whether a form is a non-empty list."
  (isinstance form Cons))

(defn elements [form]
  "The elements of a form that is a list, as a Python list; `nil` has none."
  (if (is form None) [] (list form)))

(defn split-declarations [body]
  "(declarations, other forms)"
  (setv declare (sym "DECLARE") forms (list body) declarations [])
  (while (and forms (listp (get forms 0)) (is (. (get forms 0) car) declare))
    (.append declarations (.pop forms 0)))
  #(declarations forms))
