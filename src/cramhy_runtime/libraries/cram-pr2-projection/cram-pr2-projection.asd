(defsystem "cram-pr2-projection"
  :description "A robot without a body: process modules that move the robot of the current world."
  :depends-on ("cram-bullet-reasoning" "cram-bullet-reasoning-belief-state" "cram-projection" "cram-process-modules" "cram-language"
               "cram-common-designators" "cram-common-failures" "cram-plan-occasions-events" "cram-robot-interfaces"
               "cram-object-interfaces" "cram-tf"
               "cl-tf")
  :serial t
  :components ((:file "package")
               (:file "parts")
               (:file "motions")
               (:file "perception")
               (:file "process-modules")
               (:file "durations")
               (:file "environment")))
