"The macros of CRAM-PROLOG (prolog.md)."

(require cramhy.operators [defoperator])
(import cramhy.operators *)

(setv package "CRAM-PROLOG")

(defoperator def-fact-group [name extendable #* facts]
  "Facts are collected while the body runs: `<-` is a local macro there, so loops and macros may make facts."
  (setv collector (gensym "FACTS"))
  `(let [[~collector (%fact-collector)]]
     (macrolet [[<- [&rest fact] (list '%collect-fact '~collector (list 'quote fact))]]
       ~@facts)
     (%finish-fact-group (quote ~name) (quote ~extendable) ~collector)))

(defoperator "<-" [#* fact]
  `(%fact-outside-group (quote ~fact)))

(defoperator def-prolog-handler [name parameters #* body]
  `(%define-prolog-handler (quote ~name) (%named-lambda ~name ~parameters ~@body)))

(defoperator with-facts-asserted [facts #* body]
  `(%with-facts-asserted (list ~@(lfor fact (elements facts) `(lambda [] ~fact))) (lambda [] ~@body)))

;; More than the original has: watching goals. What is traced is named as with `trace`.
(defoperator trace-prolog [#* functors]
  `(%trace-prolog (quote ~functors)))

(defoperator untrace-prolog [#* functors]
  `(%untrace-prolog (quote ~functors)))

(defoperator def-production [name #* definition]
  `(register-production (quote ~name) (quote ~definition)))

(defoperator with-productions [productions #* body]
  `(%with-productions (quote ~productions) (lambda [] ~@body)))

(defoperator with-production-handlers [handlers #* body]
  `(%with-production-handlers
     (list ~@(lfor #(name parameters #* code) (elements handlers) `(list (quote ~name) (lambda ~parameters ~@code))))
     (lambda [] ~@body)))
