(defsystem cram-my-beginner-tutorial
  :depends-on (roslisp cram-language
              turtlesim-msg turtlesim-srv std_srvs-srv
              cl-transforms geometry_msgs-msg
              cram-designators cram-prolog
              cram-process-modules cram-language-designator-support)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "control-turtlesim" :depends-on ("package"))
     (:file "simple-plans" :depends-on ("package" "control-turtlesim"))
     (:file "motion-designators" :depends-on ("package"))
     (:file "conditions" :depends-on ("package"))
     (:file "process-modules" :depends-on ("package"
                                          "control-turtlesim"
                                          "simple-plans"
                                          "motion-designators"))))))
