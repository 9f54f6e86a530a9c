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
  (setv names (lfor _ (elements facts) (gensym "FACT")))
  `(let [~@(lfor #(name fact) (zip names (elements facts)) [name fact])]
     ~@(lfor name names `(rete-assert ~name))
     (unwind-protect (progn ~@body)
       ~@(lfor name names `(rete-retract ~name)))))

(defoperator def-production [name #* definition]
  `(register-production (quote ~name) (quote ~definition)))

(defoperator with-productions [productions #* body]
  `(%with-productions (quote ~productions) (lambda [] ~@body)))

(defoperator with-production-handlers [handlers #* body]
  `(%with-production-handlers
     (list ~@(lfor #(name parameters #* code) (elements handlers) `(list (quote ~name) (lambda ~parameters ~@code))))
     (lambda [] ~@body)))
