(defsystem "cram-robot-pose-gaussian-costmap"
  :description "Where a robot stands to reach or to see something: around it, in a ring, turned towards it."
  :depends-on ("cram-prolog" "cram-designators" "cram-location-costmap" "cram-robot-interfaces" "cram-tf")
  :serial t
  :components ((:file "package")
               (:file "targets")
               (:file "facts")
               (:file "validators")))
