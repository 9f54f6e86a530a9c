"How a macro of the plan language is written: `defoperator`.

An operator gets the forms of its call as they were read, and returns a form made by quasiquote, in which unqualified symbols
are those of Common Lisp or else of the Lisp package named by the file's `package`; `%name` belongs to CRAMHY, where the
runtime's helpers are, and `pkg::name` to that package. Lists in brackets are lists. `(gensym \"X\")` makes a fresh variable.

A file requires `defoperator` within `eval-when-compile`. When a compiled file requires something, Hy looks at the source of every frame of
the stack, which takes 5 ms, and the prompt loads a dozen of these files. They use no macro of `hyrule`: Python would compile all of it at
the first start, which takes seconds."

(import cramhy_runtime.languages.commonlisp.syntax.body_parts [body-parts]
        cramhy_runtime.languages.commonlisp.syntax.operator_macros [define-operator malformed]
        cramhy_runtime.lisp_core.data [Cons Keyword Symbol :as LispSymbol list-from lisp-list]
        cramhy_runtime.lisp_core.conditions [CompileError error program-error]
        cramhy_runtime.languages.commonlisp.syntax.lambda_lists [gensym]
        cramhy_runtime.lisp_core.packages [sym is-symbol symbol-name])

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

(defn documentation-and-body [body]
  "(list of the doc string or of nothing, declarations, other forms) of the body of a function."
  (setv #(documentation declarations forms) (body-parts body))
  #((if (is documentation None) [] [documentation]) declarations forms))

(defn keyword-options [operator options known]
  "The options `:key form ...` of an operator as a dictionary of forms by the names of the keys."
  (when (% (len options) 2)
    (raise (ValueError "each of its options is a keyword and a value.")))
  (setv table (dict (zip (cut options None None 2) (cut options 1 None 2))))
  (for [key table]
    (when (or (not (isinstance key Keyword)) (not-in key.name known))
      (error (CompileError "~A has no option ~S: it has ~{~S~^, ~}." operator key (list-from (lfor name known (sym (+ ":" name))))))))
  (dfor #(key form) (.items table) key.name form))
