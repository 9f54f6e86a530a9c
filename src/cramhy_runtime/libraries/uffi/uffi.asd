(defsystem "uffi"
  :version "2.1.2"
  :description "The names of UFFI, so that files which call C load; a call of a C function is refused, with its name."
  :depends-on ("cffi")
  :components ((:file "uffi")))
