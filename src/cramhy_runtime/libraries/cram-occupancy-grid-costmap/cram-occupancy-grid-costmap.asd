(defsystem "cram-occupancy-grid-costmap"
  :description "Robots stand where the map of the room, a topic, is free."
  :depends-on ("cram-prolog" "cram-designators" "cram-language" "roslisp" "roslisp-utilities" "cram-location-costmap"
               "cram-robot-interfaces" "nav_msgs-msg")
  :components ((:file "occupancy-grid-costmap")))
