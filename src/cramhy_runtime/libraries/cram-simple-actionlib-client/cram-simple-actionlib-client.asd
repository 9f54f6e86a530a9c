(defsystem "cram-simple-actionlib-client"
  :description "Clients of ROS actions, found by name."
  :depends-on (roslisp roslisp-utilities actionlib-lisp cram-language)
  :components ((:file "actionlib-client")))
