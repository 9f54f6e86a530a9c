(defsystem cram-cup-demo
  :depends-on (roslisp-utilities cl-transforms cl-transforms-stamped cram-tf cram-language cram-executive cram-designators cram-prolog
               cram-projection cram-occasions-events cram-common-failures cram-mobile-pick-place-plans cram-knowrob-pick-place
               cram-json-prolog cram-cloud-logger cram-bullet-reasoning cram-bullet-reasoning-belief-state
               cram-bullet-reasoning-utilities cram-location-costmap cram-robot-pose-gaussian-costmap cram-pr2-projection cram-pr2-description)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "setup" :depends-on ("package"))
     (:file "demo" :depends-on ("package" "setup"))))))
