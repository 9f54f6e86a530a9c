(require cramhy *)
(import cram-robot-interfaces
        cram-object-interfaces [get-object-pose]
        cramhy_runtime.robot.worlds [text])

(defn side-of [thing]
  "The side of the robot, :left or :right, on which it saw a thing."
  (setv origin (. (get-object-pose thing) origin))
  (if (> origin.y 0) (lisp :left) (lisp :right)))

(def-fact-group ways-to-take [suits arm-for way-to-take]

  ;; a left arm takes things with ease by their left side, from the back and from above
  (<- (suits :left :left-side))
  (<- (suits :right :right-side))
  (<- (suits ?arm :back))
  (<- (suits ?arm :top))

  ;; the arm on the side where the thing is comes first, if the robot has it; then the other ones
  (<- (arm-for ?thing ?arm)
    (lisp-fun side-of ?thing ?arm)
    (cram-robot-interfaces:robot ?robot)
    (cram-robot-interfaces:arm ?robot ?arm))
  (<- (arm-for ?thing ?arm)
    (cram-robot-interfaces:robot ?robot)
    (cram-robot-interfaces:arm ?robot ?arm)
    (lisp-fun side-of ?thing ?side)
    (not (== ?arm ?side)))

  ;; an arm, and a grasp that is known for things of that type and suits the arm
  (<- (way-to-take ?thing ?arm ?grasp)
    (desig-prop ?thing (type ?type))
    (arm-for ?thing ?arm)
    (cram-object-interfaces:object-type-grasp ?type ?grasp)
    (suits ?arm ?grasp)))

(defn ways-to-take [thing]
  "Pairs of an arm and a grasp by which a thing that was detected may be taken, the best first."
  (lfor solution (force-ll (prolog `(way-to-take ~thing ?arm ?grasp)))
    #((text (var-value '?arm solution)) (text (var-value '?grasp solution)))))
