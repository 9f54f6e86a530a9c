(import cramhy [SimplePlanFailure])
(defclass NoInk [SimplePlanFailure])
(defn need-ink [ink]
  (when (= ink 0)
    (fail (NoInk)))
  ink)
