(defsystem "cram-bullet-reasoning"
  :description "Worlds of robots and objects, and reasoning about them: what lies where, touches, stands, is seen."
  :depends-on ("cl-bullet" "cram-prolog" "cram-utilities" "cl-transforms-stamped" "cram-robot-interfaces" "cram-tf")
  :serial t
  :components ((:file "package")
               (:file "world")
               (:file "objects")
               (:file "robots")
               (:file "vision")
               (:file "pictures")
               (:file "predicates")))
