(defsystem cram-my-beginner-tutorial
  :depends-on (roslisp cram-language
              turtlesim-msg turtlesim-srv std_srvs-srv
              cl-transforms geometry_msgs-msg
              cram-designators cram-prolog
              cram-process-modules cram-language-designator-support
              cram-executive)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "control-turtlesim" :depends-on ("package"))
     (:file "simple-plans" :depends-on ("package" "control-turtlesim"))
     (:file "motion-designators" :depends-on ("package"))
     (:file "location-designators" :depends-on ("package"))
     (:file "action-designators" :depends-on ("package" "control-turtlesim"))
     (:file "conditions" :depends-on ("package"))
     (:file "process-modules" :depends-on ("package"
                                          "control-turtlesim"
                                          "simple-plans"
                                          "motion-designators"
                                          "location-designators"))
     (:file "selecting-process-modules" :depends-on ("package"
                                                    "motion-designators"
                                                    "process-modules"))
     (:file "high-level-plans" :depends-on ("package"
                                           "control-turtlesim"
                                           "simple-plans"
                                           "location-designators"
                                           "action-designators"
                                           "conditions"
                                           "selecting-process-modules"))))))
