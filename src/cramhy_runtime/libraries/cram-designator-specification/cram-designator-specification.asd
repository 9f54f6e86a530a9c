(defsystem "cram-designator-specification"
  :description "The predicate PROPERTY: entries of designators, whose types are checked."
  :depends-on (cram-prolog cram-designators)
  :components ((:file "property")))
