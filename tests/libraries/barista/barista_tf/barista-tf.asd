(defsystem barista-tf
  :depends-on (barista-common cl-transforms cl-transforms-stamped cl-tf cram-utilities cram-prolog cram-designators roslisp roslisp-utilities)
  :components
  ((:module "src"
    :serial t
    :components ((:file "package")
                 (:file "frames")
                 (:file "poses")))))
