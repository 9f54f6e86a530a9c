(defsystem "split-sequence"
  :version "2.0.1"
  :description "Sequences cut at delimiters, as the library of that name does it."
  :components ((:file "split-sequence")))
