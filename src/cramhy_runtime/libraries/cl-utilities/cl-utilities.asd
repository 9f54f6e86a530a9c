(defsystem "cl-utilities"
  :version "1.2.4"
  :depends-on ("alexandria" "split-sequence")
  :description "Utilities for splitting, collecting and choosing, as the library of that name has them."
  :components ((:file "cl-utilities")))
