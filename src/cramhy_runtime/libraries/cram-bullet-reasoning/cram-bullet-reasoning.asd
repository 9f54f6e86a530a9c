(defsystem "cram-bullet-reasoning"
  :description "Worlds of robots and objects, and reasoning about them: what lies where, touches, stands, is seen."
  :depends-on ("cl-bullet" "cl-bullet-vis" "cram-physics-utils" "cl-urdf" "cram-prolog" "cram-occasions-events" "cram-designators" "roslisp" "cram-utilities" "cl-transforms-stamped" "cram-robot-interfaces" "cram-tf"
               "roslisp-utilities" "moveit_msgs-msg" "moveit_msgs-srv")
  :serial t
  :components ((:file "package")
               (:file "world")
               (:file "timeline")
               (:file "meshes")
               (:file "objects")
               (:file "robots")
               (:file "vision")
               (:file "pictures")
               (:file "reaching")
               (:file "places")
               (:file "generations")
               (:file "predicates")
               (:file "services")))
