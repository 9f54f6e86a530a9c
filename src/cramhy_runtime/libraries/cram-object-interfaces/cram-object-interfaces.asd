(defsystem "cram-object-interfaces"
  :description "Objects and grasps: where a gripper takes hold of an object, and from which side."
  :depends-on (cram-prolog cram-designators roslisp-utilities cl-transforms cl-transforms-stamped cram-robot-interfaces cram-tf)
  :serial t
  :components ((:file "package")
               (:file "objects")
               (:file "gripper-transforms")
               (:file "grasps")))
