(defsystem "cram-bullet-reasoning-belief-state"
  :description "The current world as what a plan believes: it follows events, and answers occasions and frames."
  :depends-on ("cram-bullet-reasoning" "cram-bullet-reasoning-utilities" "cram-plan-occasions-events" "cram-occasions-events"
               "cram-robot-interfaces" "cram-tf" "cram-designators" "cl-tf")
  :serial t
  :components ((:file "package")
               (:file "world")
               (:file "frames")
               (:file "events")
               (:file "occasions")))
