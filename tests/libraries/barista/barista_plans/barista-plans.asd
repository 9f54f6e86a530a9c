(defsystem barista-plans
  :depends-on (barista-common barista-tf barista-costmap barista-knowledge
               roslisp barista_msgs-msg barista_msgs-srv geometry_msgs-msg std_msgs-msg actionlib-lisp
               cram-language cram-prolog cram-designators cram-process-modules cram-language-designator-support
               cram-executive cram-occasions-events cram-projection cram-utilities alexandria)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "world" :depends-on ("package"))
     (:file "messages" :depends-on ("package" "world"))
     (:file "process-modules" :depends-on ("package" "world" "messages"))
     (:file "designators" :depends-on ("package"))
     (:file "plans" :depends-on ("package" "designators" "process-modules"))
     (:file "events" :depends-on ("package" "world"))
     (:file "demo" :depends-on ("package" "plans" "events"))))))
