(defsystem "cram-knowrob-pick-place"
  :description "Objects of a kitchen, and how a gripper takes hold of them."
  :depends-on (cram-prolog cram-object-interfaces)
  :serial t
  :components ((:file "package")
               (:file "objects")
               (:file "grasps")))
