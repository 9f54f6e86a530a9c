(defsystem "cram-common-designators"
  :description "What the motions of a mobile manipulator ask of its process modules."
  :depends-on (cram-prolog cram-designators cram-designator-specification)
  :components ((:file "motions")))
