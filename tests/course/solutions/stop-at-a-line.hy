(defn stop-at [line]
  (top-level
    (pursue
      (wait-for (> (fl-funcall (fn [pose] pose.x) tut.turtle-pose) line))
      (while True (tut.send-vel-cmd 2 0) (sleep 0.1)))
    (tut.send-vel-cmd 0 0)))
