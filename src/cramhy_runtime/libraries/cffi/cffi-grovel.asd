(defsystem "cffi-grovel"
  :description "The names of files that ask the compiler of C, which are passed over. See cffi."
  :depends-on ("cffi" "cffi-toolchain")
  :components ((:file "grovel")))
