(defsystem "cram-pr2-environment-manipulation"
  :description "Opening and closing drawers: which poses the arm takes, and the plans."
  :depends-on ("cram-language" "cram-executive" "cram-designators" "cram-prolog" "cram-utilities" "roslisp" "cl-transforms"
               "cl-transforms-stamped" "cl-urdf" "cram-common-failures" "cram-designator-specification" "cram-robot-interfaces"
               "cram-object-interfaces" "cram-plan-occasions-events" "cram-occasions-events" "cram-tf" "cram-bullet-reasoning"
               "cram-mobile-pick-place-plans" "cram-knowrob-pick-place")
  :serial t
  :components ((:file "package")
               (:file "containers")
               (:file "plans")
               (:file "actions")))
