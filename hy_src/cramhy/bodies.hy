"The operators that Hy writes in another way than Lisp: where a variable is Python's, a class is Python's, or a local macro is not needed.

The other operators come from their declarations (`cramhy_runtime/languages/operators`); these stand in their place in plain Hy. A body
becomes a function of no arguments, which `operator_bodies` hides: it assigns the variables of the function around. `whenever` is left by
`(break)`, a form that Lisp leaves by `return` by `(leave value)`."

(import hy.models [Expression List Sequence Symbol]
        cramhy_runtime.languages.hy.lisp-data [constant-form lisp-data package-of refuse-case]
        cramhy_runtime.languages.hy.properties [in-goal]
        cramhy_runtime.languages.hy.goal-functions [named]
        cramhy_runtime.languages.hy.operator-bodies [hidden])

(defn _here [compiler]
  "The Lisp package of the module that is compiled."
  (package-of compiler.module.__name__))

(defn _constant [compiler model]
  (constant-form (lisp-data model (_here compiler))))

(defn _doc-and-body [forms]
  (if (and (> (len forms) 1) (isinstance (get forms 0) hy.models.String))
    #([(get forms 0)] (cut forms 1 None))
    #([] forms)))

;; ------------------------------------------------------------------------------------------------- names and data

(defmacro lisp-package [_hy-compiler name]
  "Let the names of this module be symbols of the Lisp package `name`, such as `:tut`, so that its plans meet those of Common Lisp."
  (setv module _hy-compiler.module.__name__ package (.lstrip (str name) ":"))
  (hy.I.cramhy_runtime/languages/hy/lisp_data.choose-package module package)
  `(do ((hy.R.cramhy._ours calls choose-package) ~module ~package) None))

(defmacro lisp [_hy-compiler model]
  "The Lisp data that is written: `(lisp drive)` is a symbol, `(lisp (a b))` a list of Lisp."
  (_constant _hy-compiler model))

;; ------------------------------------------------------------------------------------------------- 2: fluents

(defmacro whenever [_hy-compiler spec #* body]
  "[fluent] form... : the body each time that the fluent is true. `(break)` is the way out, `(continue)` waits again."
  (setv observed (hy.gensym "fluent"))
  `(do
     (setv ~observed ~(get spec 0))
     (while True
       ((hy.R.cramhy._ours calls checkpoint))
       ((hy.R.cramhy._ours calls wait-for) ~observed)
       ~@body)))

(defmacro def-cpl-parameter [_hy-compiler name [value None] [documentation None]]
  "A fluent that Lisp knows as the parameter `name`: plans wait for it, `name.value` is its value."
  `(setv ~name ((hy.R.cramhy._ours calls cpl-parameter) ~(_constant _hy-compiler name) ~value)))

;; ------------------------------------------------------------------------------------------------- 4: failures

(defmacro with-retry-counters [_hy-compiler counters #* body]
  "[[counter value]...] form... : in the body, `(do-retry counter form...)` runs its forms while the counter is above zero."
  `(let [~@(sum (lfor #(name times) counters [name `((hy.R.cramhy._ours calls RetryCounter) (fn [] ~times))]) [])]
     ~@body))

(defmacro do-retry [counter #* body]
  "The body if the counter is above zero, which takes one from it."
  `(when (.use ~counter) ~@body))

(defmacro get-counter [counter]
  "How often a retry counter can still be used."
  `(. ~counter left))

(defmacro reset-counter [counter]
  "Let a retry counter begin again."
  `(.reset ~counter))

;; ------------------------------------------------------------------------------------------------- 7: tags

(defn _tagged [form]
  "The name of a form `(:tag name ...)`, else None."
  (when (and (isinstance form Expression) (> (len form) 1) (= (get form 0) ':tag))
    (get form 1)))

(defn _has-tags-of-its-own [form]
  "Whether a form is a `with-tags`, whose tags are none of those around it."
  (and (isinstance form Expression) (> (len form) 0)
       (in (get form 0) ['with-tags 'cpl:with-tags 'cram-language:with-tags 'hy.R.cramhy/bodies.with-tags])))

(defn _tag-names [form found]
  (when (and (isinstance form Sequence) (not (_has-tags-of-its-own form)))
    (when (and (_tagged form) (not-in (_tagged form) found))
      (.append found (_tagged form)))
    (for [part form] (_tag-names part found)))
  found)

(defn _chosen [form]
  "What a form `(choose tag :parameters [x y] :generators [form form] :body form)` of CRAM's utilities stands for: a tag."
  (setv options (dict (zip (cut form 2 None 2) (cut form 3 None 2))))
  `(:tag ~(get form 1)
     (let [~@(sum (map list (zip (.get options ':parameters []) (.get options ':generators []))) [])] ~(.get options ':body 'None))))

(defn _with-choices [form]
  "`form` with what each `(choose ...)` in it stands for."
  (cond
    (not (isinstance form Sequence)) form
    (and (isinstance form Expression) (> (len form) 1) (in (get form 0) ['choose 'cut:choose 'cram-utilities:choose]))
      (.replace (_chosen form) form)
    True (.replace ((type form) (map _with-choices form)) form)))

(defn _with-tag-calls [form]
  "`form` with each `(:tag name ...)` in it, also in tags and branches, become a call."
  (cond
    (_tagged form)
      (do
        (setv name (_tagged form))
        (.replace
          (Expression
            [(hidden
               `(fn []
                  (nonlocal ~name)
                  (setv ~name ((hy.R.cramhy._ours calls prepare-tag) ~name))
                  ((hy.R.cramhy._ours calls execute-tag) ~name ~(hidden `(fn [] ~@(map _with-tag-calls (cut form 2 None))) ":tag")))
               "with-tags")])
          form))
    (and (isinstance form Sequence) (not (_has-tags-of-its-own form)))
      (.replace ((type form) (map _with-tag-calls form)) form)
    True form))

(defmacro with-tags [_hy-compiler #* body]
  "The body, in which `(:tag name form...)` runs its forms as the task `name`: a variable of the body that others can order or suspend."
  (setv body (list (map _with-choices body)) names (_tag-names (List body) []))
  (if names
    (Expression
      [(hidden
         `(fn [~@names]
            ((hy.R.cramhy._ours calls enter-with-tags))
            ~@(map _with-tag-calls body))
         "with-tags")
       #* (lfor name names `((hy.R.cramhy._ours calls make-tag-task) ~(_constant _hy-compiler name)))])
    `(do ~@body)))

;; ------------------------------------------------------------------------------------------------- 8: plan functions

(defn _plan [compiler kind name parameters body]
  (setv #(documentation forms) (_doc-and-body body))
  (setv arguments (hy.gensym "arguments") keywords (hy.gensym "keywords"))
  `(do
     (defn ~name [#* ~arguments #** ~keywords]
       ~@documentation
       ((hy.R.cramhy._ours calls call-plan)
         ~kind ~(_constant compiler name) (fn ~(List parameters) (hy.R.cramhy/bodies.with-tags ~@forms)) ~arguments ~keywords))
     ((hy.R.cramhy._ours calls define-plan)
       ~kind ~(_constant compiler name) ~(_quoted compiler parameters) ~(_quoted compiler (Expression forms)) ~name)))

(defn _quoted [compiler model]
  (constant-form (hy.I.cramhy_runtime/languages/hy/call_parts.shown-data model (_here compiler))))

(defmacro def-cram-function [_hy-compiler name parameters #* body]
  "name [parameter...] {documentation} form... : define a plan, a function whose calls are nodes of the task tree."
  (_plan _hy-compiler "PLAN" name parameters body))

(defmacro def-top-level-cram-function [_hy-compiler name parameters #* body]
  "name [parameter...] {documentation} form... : define a plan that is the root of a task tree."
  (_plan _hy-compiler "TOP-LEVEL-PLAN" name parameters body))

(defmacro def-plan [_hy-compiler name parameters #* body]
  "The old name of `def-cram-function`."
  (_plan _hy-compiler "PLAN" name parameters body))

(defmacro def-top-level-plan [_hy-compiler name parameters #* body]
  "The old name of `def-top-level-cram-function`."
  (_plan _hy-compiler "TOP-LEVEL-PLAN" name parameters body))

;; ------------------------------------------------------------------------------------------------- Prolog

(defn _with-facts [form collector compiler]
  "`form` with each `(<- head goal...)` in it become a call that collects it."
  (cond
    (and (isinstance form Expression) (len form) (in (get form 0) ['<- 'prolog:<- 'cram-prolog:<-]))
      (do
        (refuse-case form)
        (setv names {} goals (named (Expression (map in-goal (cut form 1 None))) names) fact (_constant compiler goals))
        (for [[name function] (.items names)]
          (setv fact `((hy.R.cramhy._ours calls calling) ~fact ~(_constant compiler name) (fn [] ~function))))
        (.replace `((hy.R.cramhy._ours calls collect-fact) ~collector ~fact) form))
    (isinstance form Sequence)
      (.replace ((type form) (lfor part form (_with-facts part collector compiler))) form)
    True form))

(defmacro def-fact-group [_hy-compiler name predicates #* facts]
  "name [predicate...] fact... : facts `(<- head)` and rules `(<- head goal...)`; loops and macros may stand around them."
  (setv collector (hy.gensym "facts"))
  `(do
     (setv ~collector ((hy.R.cramhy._ours calls fact-collector)))
     ~@(lfor fact facts (_with-facts fact collector _hy-compiler))
     ((hy.R.cramhy._ours calls finish-fact-group)
       ~(_constant _hy-compiler name) ~(_constant _hy-compiler predicates) ~collector)))

;; ------------------------------------------------------------------------------------------------- process modules

(defmacro def-asynchronous-process-module [_hy-compiler name slots #* body]
  "name [slot...] method... : a Python class of process modules, with methods `on-input`, `on-run`, `on-cancel`, `ready`."
  `(do
     (defclass ~name [(hy.R.cramhy._ours calls AsynchronousModule) :name ~(_constant _hy-compiler name)]
       ~@(lfor slot slots (if (isinstance slot Sequence) `(setv ~(get slot 0) ~(get slot 1)) `(setv ~slot None)))
       ~@body)
     ~(_constant _hy-compiler name)))

;; ------------------------------------------------------------------------------------------------- messages

(defmacro store-message-in [_hy-compiler place]
  "A function that stores its argument in the place: a callback for `subscribe`."
  (setv message (hy.gensym "message"))
  `(fn [~message]
     ~@(cond
         (not (isinstance place Symbol)) []
         (hy.I.hy/scoping.is-inside-function-scope _hy-compiler.scope) [`(nonlocal ~place)]
         True [`(global ~place)])
     (setv ~place ~message)))
