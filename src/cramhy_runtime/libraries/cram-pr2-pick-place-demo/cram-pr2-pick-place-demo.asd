(defsystem "cram-pr2-pick-place-demo"
  :description "A world for lessons about picking up and placing. A system of this name on ROS_PACKAGE_PATH comes before this one."
  :depends-on ("roslisp-utilities" "cl-transforms" "cl-transforms-stamped" "cl-tf" "cram-tf" "cram-language" "cram-executive"
               "cram-designators" "cram-prolog" "cram-projection" "cram-occasions-events" "cram-utilities" "cram-common-failures"
               "cram-mobile-pick-place-plans" "cram-knowrob-pick-place" "cram-physics-utils" "cl-bullet" "cram-bullet-reasoning"
               "cram-bullet-reasoning-belief-state" "cram-bullet-reasoning-utilities" "cram-location-costmap"
               "cram-btr-visibility-costmap" "cram-btr-spatial-relations-costmap" "cram-robot-pose-gaussian-costmap"
               "cram-occupancy-grid-costmap" "cram-pr2-projection" "cram-pr2-description" "cram-pr2-fetch-deliver-plans"
               "cram-pr2-environment-manipulation")
  :components ((:file "demo")))
