(defsystem "cram-pr2-projection-reasoning"
  :description "Trying in the world what an action is about to do: whether the robot would touch something, or not reach it."
  :depends-on ("cram-language" "cram-designators" "cram-projection" "cram-utilities" "roslisp" "cl-transforms" "cram-common-failures"
               "cram-tf" "cram-bullet-reasoning" "cram-bullet-reasoning-belief-state" "cram-mobile-pick-place-plans" "cram-pr2-projection")
  :serial t
  :components ((:file "package")
               (:file "checks")
               (:file "places")
               (:file "projected-tasks")))
