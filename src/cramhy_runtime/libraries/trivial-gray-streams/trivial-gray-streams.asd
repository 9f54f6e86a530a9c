(defsystem "trivial-gray-streams"
  :version "2.0"
  :description "Streams whose functions users define, as the library of that name has them."
  :components ((:file "trivial-gray-streams")))
