"The operators of the plan language with Hy bodies.

    (require cramhy *)
    (import cramhy_runtime.cpl *)

    (setv door-open (make-fluent :name \"door-open\"))
    (top-level
      (pursue
        (wait-for door-open)
        (do (sleep 5) (fail \"Nobody opens.\"))))

In a file that never says `in-package` this is Hy: the names are Hy's, the values Python's, and each branch is a function of no
arguments, so what it assigns is its own unless it says `nonlocal`. A function of `cramhy_runtime.cpl` needs no macro: `wait-for`,
`fail`, `suspend` and the rest are called as they are. The macros here only put forms into functions; what the operators mean
stands with the functions that they call (`cramhy_runtime/cpl`).

Where Lisp says `return`, Hy must not, since a Hy `return` belongs to the function around it: `whenever` is left by `(break)`,
failure handling by `(leave value)`."

(defn _branch [forms]
  `(fn [] ~@forms))

(defn _branches [forms]
  (lfor form forms (_branch [form])))

(defn _lisp-list [form]
  `(hy.I.cramhy_runtime/lisp/data.list-from (or ~form [])))

(defmacro top-level [#* body]
  "Run `body` as the root of a plan; its value. A failure that leaves it is raised."
  `(hy.I.cramhy_runtime/cpl.top-level ~(_branch body)))

(defmacro seq [#* body]
  `(do ~@body))

(defmacro par [#* branches]
  "All at once until all have ended; the value of the first."
  `(hy.I.cramhy_runtime/cpl.par ~@(_branches branches)))

(defmacro pursue [#* branches]
  "All at once until one has ended; its value. The others are evaporated."
  `(hy.I.cramhy_runtime/cpl.pursue ~@(_branches branches)))

(defmacro try-all [#* branches]
  "All at once until one succeeds; its value."
  `(hy.I.cramhy_runtime/cpl.try-all ~@(_branches branches)))

(defmacro try-in-order [#* forms]
  "One after the other until one succeeds; its value."
  `(hy.I.cramhy_runtime/cpl.try-in-order ~@(_branches forms)))

(defmacro try-each-in-order [binding #* body]
  "`(try-each-in-order [x xs] ...)`: the body with one element after the other, until it succeeds."
  (setv #(variable items) binding)
  `(hy.I.cramhy_runtime/cpl.try-each-in-order ~(_lisp-list items) (fn [~variable] ~@body)))

(defmacro par-loop [binding #* body]
  "`(par-loop [x xs] ...)`: the body with all elements at once."
  (setv #(variable items) binding)
  `(hy.I.cramhy_runtime/cpl.par-loop ~(_lisp-list items) (fn [~variable] ~@body)))

(defmacro partial-order [steps #* orderings]
  "`(partial-order [step ...] (:order before after) ...)`: as `par`, with `after` starting when `before` is dead."
  (for [ordering orderings]
    (when (or (!= (len ordering) 3) (!= (get ordering 0) ':order))
      (raise (ValueError f"Malformed ordering constraint {(hy.repr ordering)}: write (:order before after)."))))
  `(hy.I.cramhy_runtime/cpl.partial-order [~@(_branches steps)]
     [~@(lfor #(_ before after) orderings `#(~before ~after))]))

(defmacro whenever [fluent #* body]
  "Each time that `fluent` is true: the body. `(break)` is the way out, `(continue)` waits again."
  (setv observed (hy.gensym "fluent"))
  `(do
     (setv ~observed ~fluent)
     (while True
       (hy.I.cramhy_runtime/kernel.checkpoint)
       (hy.I.cramhy_runtime/cpl.wait-for ~observed)
       ~@body)))

(defmacro with-failure-handling [clauses #* body]
  "`(with-failure-handling [[Type [e] ...] ...] ...)`: handlers run before anything unwinds.

  A handler that ends normally declines. `(retry)` unwinds and tries the body again, `(leave value)` unwinds and gives the form that
  value. A type may be a tuple of types."
  (setv handlers
    (lfor [type [condition] #* forms] clauses
      `#(~type (fn [~condition retry] (setv leave retry.leave) ~@forms))))
  `(hy.I.cramhy_runtime/cpl.with-failure-handling [~@handlers] (fn [retry] (setv leave retry.leave) ~@body)))

(defmacro with-retry-counters [counters #* body]
  "`(with-retry-counters [[name times] ...] ...)`; in the body `(do-retry name ...)` runs its forms while the counter is above zero."
  `(do
     ~@(lfor #(name times) counters `(setv ~name (hy.I.cramhy_runtime/cpl.RetryCounter (fn [] ~times))))
     ~@body))

(defmacro do-retry [counter #* body]
  `(when (.use ~counter) ~@body))

(defmacro on-suspension [form #* body]
  "The body; whenever the task is suspended meanwhile, `form` runs in it first."
  `(hy.I.cramhy_runtime/cpl.on-suspension (fn [] ~form) ~(_branch body)))

(defmacro retry-after-suspension [#* body]
  "The body; a suspension unwinds it, and after the wake-up it begins again."
  `(hy.I.cramhy_runtime/cpl.retry-after-suspension ~(_branch body)))

(defmacro without-scheduling [#* body]
  "The body; requests to suspend or evaporate this task wait until it is over."
  `(hy.I.cramhy_runtime/cpl.without-scheduling ~(_branch body)))

(defmacro with-task-suspended [spec #* body]
  "`(with-task-suspended [task] ...)`: the body while `task` is suspended."
  `(hy.I.cramhy_runtime/cpl.with-task-suspended ~(get spec 0) ~(_branch body)))

(defn _tagged [form]
  "The name of a form `(:tag name ...)`, else None."
  (when (and (isinstance form hy.models.Expression) (> (len form) 1) (= (get form 0) ':tag))
    (get form 1)))

(defn _tag-names [form found]
  (when (isinstance form hy.models.Sequence)
    (when (and (_tagged form) (not-in (_tagged form) found))
      (.append found (_tagged form)))
    (for [part form] (_tag-names part found)))
  found)

(defn _with-tag-calls [form]
  "`form` with each `(:tag name ...)` in it, also in tags and branches, become a call."
  (cond
    (_tagged form)
      (do
        (setv name (_tagged form))
        `((fn []
            (nonlocal ~name)
            (setv ~name (hy.I.cramhy_runtime/cpl/tags.prepare-tag ~name))
            (hy.I.cramhy_runtime/cpl/tags.execute-tag ~name (fn [] ~@(map _with-tag-calls (cut form 2 None)))))))
    (isinstance form hy.models.Sequence)
      ((type form) (map _with-tag-calls form))
    True form))

(defmacro with-tags [#* body]
  "The body, in which `(:tag name ...)` runs its forms as the task `name`: a variable of the body that others can order or suspend."
  (setv names (_tag-names (hy.models.List body) []))
  `((fn []
      ~@(lfor name names
          `(setv ~name (hy.I.cramhy_runtime/cpl/tags.make-tag-task
                         (hy.I.cramhy_runtime/lisp/packages.intern ~(.upper (str name)) "CRAM-USER"))))
      ~@(map _with-tag-calls body))))
