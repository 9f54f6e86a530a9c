(defsystem cram-my-pick-place-tutorial
  :depends-on (roslisp-utilities
              cl-transforms cl-transforms-stamped cram-tf
              cram-language cram-executive cram-designators cram-prolog cram-utilities
              cram-occasions-events cram-common-failures
              cram-bullet-reasoning cram-bullet-reasoning-belief-state cram-bullet-reasoning-utilities
              cram-location-costmap cram-btr-visibility-costmap cram-btr-spatial-relations-costmap cram-robot-pose-gaussian-costmap
              cram-object-interfaces cram-knowrob-pick-place cram-mobile-pick-place-plans
              cram-pr2-projection cram-pr2-fetch-deliver-plans)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "kitchen" :depends-on ("package"))
     (:file "moving-a-bottle" :depends-on ("package" "kitchen"))
     (:file "choosing" :depends-on ("package" "kitchen"))
     (:file "places" :depends-on ("package" "kitchen"))
     (:file "recovering" :depends-on ("package" "kitchen" "moving-a-bottle" "choosing" "places"))
     (:file "setting-a-table" :depends-on ("package" "kitchen" "moving-a-bottle" "recovering"))))))
