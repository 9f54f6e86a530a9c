(defsystem "cram-btr-visibility-costmap"
  :description "Robots that are to see something stand where it is seen from."
  :depends-on ("cram-bullet-reasoning" "cram-bullet-reasoning-belief-state" "cram-location-costmap" "cram-robot-interfaces"
               "cram-designators" "cram-tf")
  :components ((:file "visibility-costmap")))
