(defsystem "cram-tf"
  :description "Poses, frames and transforms, as plans use them."
  :depends-on (cram-prolog cram-designators cram-utilities roslisp roslisp-utilities cl-transforms cl-transforms-stamped cl-tf cram-robot-interfaces cram-designator-specification visualization_msgs-msg)
  :serial t
  :components ((:file "package")
               (:file "frames")
               (:file "poses")
               (:file "transforms")
               (:file "designators")
               (:file "broadcaster")
               (:file "marker")))
