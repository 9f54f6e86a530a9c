(defsystem "cram-bullet-reasoning-utilities"
  :description "Short ways to put objects and the robot somewhere in the current world."
  :depends-on ("cram-bullet-reasoning" "cram-robot-interfaces" "cram-tf" "cram-designators" "cram-location-costmap")
  :serial t
  :components ((:file "package")
               (:file "objects")
               (:file "robot")
               (:file "drawings")))
