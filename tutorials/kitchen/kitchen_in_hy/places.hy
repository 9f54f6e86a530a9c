(require cramhy *)
(import math [cos sin radians dist]
        cramhy [robot]
        cramhy_runtime.robot_world.placements [of-pose]
        .kitchen [kitchen])

(setv distances [0.65 0.55 0.75])  ; how far from a thing the robot stands to reach it, in metres, the best first

(defn pose-facing [place distance degrees]
  "A pose on the floor: so far from `place', in that direction, and turned towards it."
  (setv angle (radians degrees))
  (robot.at (+ place.origin.x (* distance (cos angle)))
            (+ place.origin.y (* distance (sin angle)))
            :yaw (+ degrees 180)))

(defn distance-to-robot [pose]
  (dist #(pose.origin.x pose.origin.y) (cut (kitchen.place) 2)))

(defn poses-around [place]
  "Poses on circles around `place': of each circle those eight that are nearest to the robot."
  (lfor distance distances
        pose (cut (sorted (lfor degrees (range 0 360 20) (pose-facing place distance degrees))
                          :key distance-to-robot)
                  8)
    pose))

(defn generate-poses-to-reach [location]
  "Proposes poses for (a location (to-reach ?place))."
  (with-desig-props [to-reach] location
    (when to-reach
      (poses-around to-reach))))

(register-location-generator
 5 generate-poses-to-reach
 "Poses around a place, turned towards it.")

(defn touches-nothing-p [pose]
  "Whether the robot, which is tried at that pose in a copy of the world, would touch nothing but what it holds."
  (setv copy (kitchen.core.copy)
        name kitchen.robot.name)
  (copy.put name (of-pose pose))
  (all (gfor thing (copy.touching name)
         (in thing.name kitchen.robot.holds))))

(defn validate-pose-to-reach [location pose]
  "Rejects poses at which the robot would touch something."
  (with-desig-props [to-reach] location
    (cond (not to-reach) (lisp :unknown)
          (touches-nothing-p pose) (lisp :accept)
          True (lisp :reject))))

(register-location-validation-function
 5 validate-pose-to-reach
 "Poses at which the robot touches nothing.")

(defn solutions [location]
  "What a location designator stands for: one pose after the other."
  (while location
    (yield (reference location))
    (setv location (next-solution location))))
