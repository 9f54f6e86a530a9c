(defsystem "cram-pr2-fetch-deliver-plans"
  :description "Searching, fetching, delivering and transporting: plans that try other places, arms and grasps."
  :depends-on ("cram-language" "cram-executive" "cram-designators" "cram-prolog" "cram-utilities" "roslisp" "cl-transforms"
               "cl-transforms-stamped" "cram-common-failures" "cram-designator-specification" "cram-robot-interfaces"
               "cram-object-interfaces" "cram-tf" "cram-location-costmap" "cram-robot-pose-gaussian-costmap"
               "cram-btr-spatial-relations-costmap" "cram-bullet-reasoning" "cram-bullet-reasoning-belief-state"
               "cram-mobile-pick-place-plans" "cram-pr2-projection"
               "cram-pr2-projection-reasoning" "cram-pr2-environment-manipulation")
  :serial t
  :components ((:file "package")
               (:file "places")
               (:file "moving")
               (:file "searching")
               (:file "fetching")
               (:file "delivering")
               (:file "transporting")
               (:file "in-the-way")
               (:file "actions")))
