(defsystem "cram-pr2-description"
  :description "Facts about the PR2: arms, grippers, torso, neck, camera."
  :depends-on (cram-prolog cram-robot-interfaces cl-transforms cl-transforms-stamped)
  :serial t
  :components ((:file "package")
               (:file "robot")
               (:file "arms")
               (:file "neck")))
