"The macros of CRAM-PROLOG (prolog.md)."

(eval-when-compile (require cramhy.operators [defoperator]))
(import cramhy.operators *)

(setv package "CRAM-PROLOG")

(defoperator def-fact-group [name extendable #* facts]
  "Facts are collected while the body runs: `<-` is a local macro there, so loops and macros may make facts."
  (setv collector (gensym "FACTS"))
  `(let [[~collector (%fact-collector)]]
     (macrolet [[<- [&rest fact] (list '%collect-fact '~collector (list 'quote fact))]]
       ~@facts)
     (%finish-fact-group (quote ~name) (quote ~extendable) ~collector)))


(defoperator with-productions [productions #* body]
  `(%with-productions (quote ~productions) (lambda [] ~@body)))

(defoperator with-production-handlers [handlers #* body]
  `(%with-production-handlers
     (list ~@(lfor #(name parameters #* code) (elements handlers) `(list (quote ~name) (lambda ~parameters ~@code))))
     (lambda [] ~@body)))
