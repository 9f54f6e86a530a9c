"The macros of CRAM-PROCESS-MODULES (process-modules.md)."

(require cramhy.operators [defoperator])
(import cramhy.operators *)

(setv package "CRAM-PROCESS-MODULES")

(defoperator def-process-module [name parameters #* body]
  (setv #(variable) parameters #(declarations forms) (split-declarations body))
  `(%define-process-module (quote ~name) (%named-lambda ~name [~variable] ~@declarations (block nil ~@forms))))

(defoperator with-process-modules-running [modules #* body]
  `(%with-process-modules-running (quote ~modules) (lambda [] ~@body)))

(defoperator with-process-module-aliases [aliases #* body]
  `(%with-process-module-aliases (quote ~aliases) (lambda [] ~@body)))

(defoperator with-process-module-registered-running [spec #* body]
  (setv #(name instance) spec)
  `(%with-process-module-registered-running ~name ~instance (lambda [] ~@body)))

(defoperator def-asynchronous-process-module [name slots #* options]
  `(progn
     (defclass ~name [asynchronous-process-module] ~slots ~@options)
     (%register-process-module (quote ~name))
     (quote ~name)))
