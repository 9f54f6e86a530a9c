(defsystem "trivial-garbage"
  :version "0.21"
  :description "Weak pointers, weak hash tables and finalizers, as the library of that name has them."
  :components ((:file "trivial-garbage")))
