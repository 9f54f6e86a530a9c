(defn turn-left []
  (tut.send-vel-cmd 0 1.57)
  (sleep 1))
