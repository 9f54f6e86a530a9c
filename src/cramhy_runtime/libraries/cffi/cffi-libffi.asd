(defsystem "cffi-libffi"
  :description "Nothing: C is neither asked nor compiled here. See cffi."
  :depends-on ("cffi" "cffi-grovel"))
