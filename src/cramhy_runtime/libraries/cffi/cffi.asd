(defsystem "cffi"
  :version "0.24.1"
  :description "The names of CFFI, so that files which call C load; a call of a C function is refused, with its name."
  :components ((:file "cffi")))
