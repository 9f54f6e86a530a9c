(defsystem "cram-mobile-pick-place-plans"
  :description "Plans for picking up and placing, and the actions that stand for them."
  :depends-on (cram-language cram-executive cram-designators cram-prolog roslisp cl-transforms-stamped cram-common-failures cram-designator-specification cram-common-designators cram-plan-occasions-events cram-occasions-events cram-robot-interfaces cram-object-interfaces cram-tf)
  :serial t
  :components ((:file "package")
               (:file "atomic-plans")
               (:file "pick-and-place")
               (:file "atomic-actions")
               (:file "pick-and-place-actions")))
