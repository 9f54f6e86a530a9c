(defn figure-eight []
  (for [i (range 6)] (send-vel-cmd 1 1.047) (sleep 1))
  (for [i (range 6)] (send-vel-cmd 1 -1.047) (sleep 1)))
