(defsystem "s-xml"
  :description "XML: a parser that calls hooks, three kinds of trees, a printer, and namespaces as packages."
  :serial t
  :components ((:file "package")
               (:file "namespaces")
               (:file "parser")
               (:file "trees")))
