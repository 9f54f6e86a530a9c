(defsystem "cram-common-failures"
  :description "What can go wrong when a robot moves, looks and grasps, as classes of plan failures."
  :depends-on (cram-language)
  :components ((:file "failures")))
