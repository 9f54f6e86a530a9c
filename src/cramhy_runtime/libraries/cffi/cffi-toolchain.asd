(defsystem "cffi-toolchain"
  :description "The names of the compiler of C, which is not called. See cffi."
  :depends-on ("cffi")
  :components ((:file "toolchain")))
