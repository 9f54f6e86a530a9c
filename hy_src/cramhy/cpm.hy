"The macros of CRAM-PROCESS-MODULES (process-modules.md)."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *)

(setv package "CRAM-PROCESS-MODULES")

(defoperator def-process-module [name parameters #* body]
  (setv #(variable) parameters #(declarations forms) (split-declarations body))
  `(%define-process-module (quote ~name) (%named-lambda ~name [~variable] ~@declarations (block nil ~@forms))))

(defoperator def-asynchronous-process-module [name slots #* options]
  `(progn
     (defclass ~name [asynchronous-process-module] ~slots ~@options)
     (%register-process-module (quote ~name))
     (quote ~name)))
