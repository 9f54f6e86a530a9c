(defsystem "cram-math"
  :description "CRAM's mathematics: angles, statistics, matrices of double-floats."
  :components ((:file "cram-math")))
