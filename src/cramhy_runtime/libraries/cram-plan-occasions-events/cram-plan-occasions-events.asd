(defsystem "cram-plan-occasions-events"
  :description "The events of which plans tell the belief state, and the occasions that they ask it for."
  :depends-on (cram-prolog cram-designators cram-occasions-events)
  :serial t
  :components ((:file "package")
               (:file "events")
               (:file "occasions")))
