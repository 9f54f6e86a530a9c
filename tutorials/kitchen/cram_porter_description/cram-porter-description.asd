(defsystem "cram-porter-description"
  :description "Facts about the porter, a mobile robot with one arm."
  :depends-on ("cram-prolog" "cram-robot-interfaces" "cl-transforms" "cl-transforms-stamped")
  :components ((:file "porter")
               (:static-file "porter.urdf")))
