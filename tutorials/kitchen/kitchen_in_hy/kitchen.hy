(require cramhy *)
(import cramhy [robot])

(setv kitchen (robot.World))  ; the world of now, whichever that is

(defn init-kitchen []
  "Puts the robot into a kitchen without anything in it."
  (robot.world)
  None)

(defn spawn [type place]
  "Puts a thing of a type such as \"bottle\" into the kitchen, and lets it fall until it stands. Returns its name."
  (setv name (kitchen.spawn type place))
  (kitchen.settle)
  name)
