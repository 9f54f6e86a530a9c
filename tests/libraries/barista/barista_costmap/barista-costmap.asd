(defsystem "barista-costmap"
  :depends-on ("barista-common" "barista-tf" "cram-prolog" "cram-designators" "cram-utilities" "cl-transforms-stamped" "alexandria")
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "costmap" :depends-on ("package"))
     (:file "generators" :depends-on ("package" "costmap"))
     (:file "facts" :depends-on ("package" "costmap" "generators"))
     (:file "locations" :depends-on ("package" "costmap" "facts"))))))
