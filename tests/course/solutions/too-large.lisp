(def-fact-group limits ()
  (<- (too-large ?shape)
    (shape ?shape ?size)
    (> ?size 5)))
