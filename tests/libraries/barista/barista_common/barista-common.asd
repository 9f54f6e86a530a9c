;;; What every other part of the barista leans on.

(defsystem barista-common
  :author "the tests of cramhy"
  :license "BSD"
  :description "Types, conditions and helpers"
  :depends-on (alexandria cram-language)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "utilities" :depends-on ("package"))
     (:file "grids" :depends-on ("package" "utilities"))
     (:file "failures" :depends-on ("package"))
     (:file "reports" :depends-on ("package" "utilities"))))))
