(require cramhy *)
(import pytest [approx raises]
        cramhy [robot]
        ..kitchen [init-kitchen kitchen spawn]
        ..moving-a-bottle [before-counter bottle-on-counter get-ready move-bottle]
        ..choosing [ways-to-take]
        ..places [touches-nothing-p]
        ..recovering [fetch find-thing]
        ..setting-a-table [place-before])

(defn with-bottle [[place bottle-on-counter]]
  "Begins with a bottle in the kitchen."
  (init-kitchen)
  (roslisp:set-debug-level (lisp (pick-place)) (lisp :error))
  (spawn "bottle" place))

(defn before-the-counter [plan]
  "The result of a plan before the counter."
  (robot.run
    (fn []
      (get-ready)
      (robot.go before-counter)
      (plan))))

(defn test-a-bottle-goes-to-the-island []
  (with-bottle)
  (move-bottle)
  (assert (= (kitchen.place "bottle-1") (approx #(-0.8 2.0 0.959) :abs 0.002)))
  (assert (not (kitchen.held))))

(defn test-the-arm-on-its-side-comes-first []
  (with-bottle)
  (defn first-way [y]
    (robot.run
      (fn []
        (get-ready)
        (robot.go (robot.at 0.75 y))
        (robot.look bottle-on-counter)
        (get (ways-to-take (robot.detect "bottle")) 0))))
  (assert (= (first-way 0.4) #("left" "left-side")))
  (assert (= (first-way 0.8) #("right" "right-side"))))

(defn test-failures-have-names []
  (with-bottle)
  (with [_ (raises robot.failures.ObjectNowhereToBeFound :match "There is no cup to be seen")]
    (before-the-counter (fn [] (find-thing "cup" bottle-on-counter))))
  (with [_ (raises robot.failures.NavigationPoseUnreachable)]
    (robot.go (robot.at 1.4 0.6))))

(defn test-a-bottle-at-the-side-is-found-and-fetched []
  (with-bottle (robot.at 1.45 1.1 0.96))
  (before-the-counter (fn [] (fetch (find-thing "bottle" bottle-on-counter))))
  (assert (= (list (kitchen.held)) ["bottle-1"])))

(defn test-the-robot-stands-before-the-counter-and-not-in-it []
  (with-bottle)
  (assert (touches-nothing-p before-counter))
  (assert (not (touches-nothing-p (robot.at 1.4 0.6)))))

(defn test-a-cover-lies-before-the-guest []
  (setv origin (. (place-before 1 2 90 0.5 0.1 0) origin))
  (assert (= #(origin.x origin.y) (approx #(0.9 2.5)))))
