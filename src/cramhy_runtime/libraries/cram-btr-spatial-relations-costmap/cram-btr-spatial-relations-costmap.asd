(defsystem "cram-btr-spatial-relations-costmap"
  :description "Places on, in, left of, behind, near or far from things of the current world."
  :depends-on ("cram-bullet-reasoning" "cram-bullet-reasoning-belief-state" "cram-location-costmap" "cram-robot-interfaces"
               "cram-object-interfaces" "cram-designators" "roslisp-utilities")
  :serial t
  :components ((:file "package")
               (:file "things")
               (:file "relations")
               (:file "facts")
               (:file "validators")))
