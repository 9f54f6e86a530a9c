(in-package :tut)

(defun draw-line (metres)
  (top-level
    (with-retry-counters ((again 3))
      (with-failure-handling
          ((dry-pen (failure)
             (declare (ignore failure))
             (do-retry again
               (retry))))
        (dip-pen)))
    (send-vel-cmd metres 0)
    (wait-duration 1.1)))
