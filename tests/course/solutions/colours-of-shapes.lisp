(def-fact-group colours ()
  (<- (colour house red))
  (<- (colour castle grey)))
