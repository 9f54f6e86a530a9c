(require cramhy *)
(import cramhy [robot])

(setv bottle-on-counter (robot.at 1.42 0.6 0.96)      ; a place on the counter, beside the sink
      bottle-on-island (robot.at -0.8 2.0 0.96)       ; a place on the kitchen island
      before-counter (robot.at 0.75 0.6)              ; where the robot stands to reach the counter
      before-island (robot.at -0.15 2.0 :yaw 180))    ; where it stands to reach the island

(defn get-ready []
  "Raises the torso and brings the arms out of the way."
  (par
    (robot.lift 0.3)
    (robot.park)))

(defn move-bottle []
  "Carries a bottle from the counter to the island: go, look, detect, pick up, carry, place."
  (robot.run
    (fn []
      (get-ready)
      (robot.go before-counter)
      (robot.look bottle-on-counter)
      (setv bottle (robot.detect "bottle"))
      (robot.pick-up bottle "right" "back")
      (robot.go before-island)
      (robot.place bottle bottle-on-island))))
