(defsystem "cffi-grovel"
  :description "Nothing: C is neither asked nor compiled here. See cffi."
  :depends-on ("cffi"))
