(require cramhy *)
(import math [cos sin radians]
        cramhy [robot]
        cram-object-interfaces [get-object-pose]
        cram-tf [ensure-pose-in-frame]
        cramhy_runtime.robot.worlds [text]
        .kitchen [kitchen]
        .choosing [ways-to-take]
        .places [solutions])

(setv failed robot.failures)

(defn beside [place]
  "`place', and the places half a metre to its left and to its right as the robot faces it."
  (setv yaw (radians (kitchen.yaw)))
  (lfor step [0 0.5 -0.5]
    (robot.at (- place.origin.x (* step (sin yaw)))
              (+ place.origin.y (* step (cos yaw)))
              place.origin.z)))

(defn find-thing [type place]
  "Looks at `place' and to both sides of it, until a thing of that type is seen."
  (for [spot (beside place)]
    (try
      (robot.look spot)
      (return (robot.detect type))
      (except [failed.PerceptionObjectNotFound])))
  (fail (failed.ObjectNowhereToBeFound :description f"There is no {type} to be seen.")))

(defn take-somehow [thing]
  "Takes a thing that was detected, by one arm and grasp after the other, until one of them reaches it."
  (for [[arm grasp] (ways-to-take thing)]
    (try
      (return (robot.pick-up thing arm grasp))
      (except [failed.ManipulationPoseUnreachable]
        (robot.park))))
  (fail (failed.ObjectUnreachable :object thing :description "No arm reaches it by any grasp from here.")))

(defn where-seen [thing]
  "The pose at which a thing was detected a moment ago."
  (ensure-pose-in-frame (get-object-pose thing) "map" :use-zero-time True))

(defn take-what-slips [type place]
  "Finds a thing and takes it. When it slips out of the fingers, it is looked for twice more."
  (for [looks [2 1 0]]
    (try
      (return (take-somehow (find-thing type place)))
      (except [failure failed.GripperClosedCompletely]
        (robot.park)
        (when (= looks 0) (raise))))))

(defn fetch [thing]
  "Goes to a thing that was detected a moment ago, looks again, and takes it. Where it is out of reach, the robot goes to another place."
  (setv ?place (where-seen thing))
  (for [stand (solutions (desig:a location (to-reach ?place)))]
    (try
      (robot.go stand)
      (return (take-what-slips (text (get thing "type")) ?place))
      (except [[failed.NavigationPoseUnreachable failed.ObjectUnreachable failed.ObjectNowhereToBeFound]])))
  (fail (failed.ObjectUnfetchable :object thing :description "It was not taken from any place around it.")))

(defn deliver [thing ?place]
  "Puts down at `?place' a thing that the robot holds. Where that is out of reach, the robot goes to another place."
  (for [stand (solutions (desig:a location (to-reach ?place)))]
    (try
      (robot.go stand)
      (return (robot.place thing ?place))
      (except [[failed.NavigationPoseUnreachable failed.ManipulationPoseUnreachable]]
        (robot.park))))
  (fail (failed.ObjectUndeliverable :object thing :description "It could not be put there from any place around.")))
