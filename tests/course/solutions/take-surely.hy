(defn take-surely [place]
  (setv places [place])
  (with-retry-counters [[looks 3]]
    (with-failure-handling
        [[NothingGripped [failure]
           (do-retry looks
             (.append places (brick-place))
             (retry))]]
      (take (get places -1)))))
