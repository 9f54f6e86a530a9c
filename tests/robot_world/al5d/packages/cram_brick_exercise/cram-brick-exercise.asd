(defsystem cram-brick-exercise
  :depends-on (roslisp roslisp-utilities cram-language cram-tf sensor_msgs-msg std_msgs-msg cram-designators cram-prolog
               cram-process-modules cram-language-designator-support cram-executive)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "arm" :depends-on ("package"))
     (:file "designators" :depends-on ("package"))
     (:file "plans" :depends-on ("arm" "designators"))))))
