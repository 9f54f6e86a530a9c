(defsystem "cram-location-costmap"
  :description "CRAM's location costmaps: places for location designators, drawn from distributions over a grid."
  :depends-on ("cram-prolog" "cram-designators" "cram-utilities" "cram-language" "cl-transforms-stamped" "roslisp" "roslisp-utilities"
               "alexandria" "cram-math")
  :serial t
  :components ((:file "package")
               (:file "costmaps")
               (:file "messages")
               (:file "facts")
               (:file "designators")))
