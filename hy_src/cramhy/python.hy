"The macros of PYTHON (nickname PY): importing modules, chains of attributes and methods, Python's `for` and `with`."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *
        cramhy_runtime.lisp_core.conditions [program-error])

(setv package "PYTHON")

(defoperator import [module #* options]
  "`(py:import numpy :as np)`: the module's package, with a nickname."
  (setv options (list options))
  (when (or (% (len options) 2) (any (gfor option (cut options None None 2) (is-not option (sym ":AS")))))
    (program-error "PY:IMPORT takes a module and :AS with a name, not ~S." (list-from options)))
  `(import-module (quote ~module) (quote ~(if options (get options 1) None))))

(defoperator -> [object #* steps]
  "`(py:-> frame (head 3) columns)` is `frame.head(3).columns`."
  (setv form object)
  (for [step steps]
    (setv form (if (listp step)
                   `(python::method ~form (quote ~step.car) ~@(elements step.cdr))
                   `(python::getattr ~form (quote ~step)))))
  form)

(defoperator for [spec #* body]
  "`(py:for (line file) ...)`"
  (setv #(variable iterable) spec)
  `(block nil (%iterate (lambda [~variable] ~@body) ~iterable)))

(defoperator with [spec #* body]
  "`(py:with (file (py:open \"x\")) ...)`"
  (setv #(variable manager) spec)
  `(%with-context (lambda [~variable] ~@body) ~manager))
