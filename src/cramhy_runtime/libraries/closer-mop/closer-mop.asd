(defsystem "closer-mop"
  :version "1.0.0"
  :description "The names of the metaobject protocol in one package, as far as cramhy has it."
  :components ((:file "closer-mop")))
