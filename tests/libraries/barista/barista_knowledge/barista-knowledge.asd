(in-package :asdf)

(defsystem barista-knowledge
  :depends-on (:barista-common :barista-tf :cram-prolog :cram-utilities :cl-transforms)
  :serial t
  :components ((:module src
                :serial t
                :components ((:file "package") (:file "objects") (:file "grasps") (:file "rules")))))
