(require cramhy *)
(import cramhy_runtime.cpl [SimplePlanFailure])

(defclass OutOfBoundsError [SimplePlanFailure]
  (defn __init__ [self [description "Turtle went out of bounds."]]
    (.__init__ (super) description)
    (setv self.description description)))
