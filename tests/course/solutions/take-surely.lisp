(defun take-surely (place)
  (with-retry-counters ((looks 3))
    (with-failure-handling
        ((nothing-gripped (failure)
           (declare (ignore failure))
           (do-retry looks
             (setf place (brick-place))
             (retry))))
      (take place))))
