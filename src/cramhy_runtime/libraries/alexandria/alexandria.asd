(defsystem "alexandria"
  :version "1.0.1"
  :description "The utilities of Alexandria: its names, lambda lists and results."
  :serial t
  :components ((:file "package")
               (:file "macros")
               (:file "types")
               (:file "functions")
               (:file "lists")
               (:file "sequences")
               (:file "numbers")
               (:file "tables-and-files")
               (:file "alexandria-2")))
