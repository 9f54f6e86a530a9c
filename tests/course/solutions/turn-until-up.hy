(defn turn-until-up []
  (try
    (pursue
      (wait-for (> (fl-funcall (fn [pose] pose.theta) turtle-pose) 1.57))
      (while True
        (send-vel-cmd 0 1)
        (wait-duration 0.1)))
    (finally
      (send-vel-cmd 0 0))))
