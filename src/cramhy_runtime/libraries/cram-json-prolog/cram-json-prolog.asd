(defsystem "cram-json-prolog"
  :description "The names of the client of KnowRob's Prolog. There is no KnowRob here: a query has no answers."
  :depends-on ("cram-utilities" "cram-prolog" "roslisp")
  :components ((:file "cram-json-prolog")))
