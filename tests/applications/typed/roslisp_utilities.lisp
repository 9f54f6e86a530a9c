(asdf:load-system :roslisp-utilities)
;=> T

(in-package :roslisp-utilities)
;=> .*

(lispify-ros-name "myRosName")
;=> MY-ROS-NAME

(lispify-ros-name "MyRosName")
;=> MY-ROS-NAME

(lispify-ros-name "my_ros_name")
;=> MY_ROS_NAME

(lispify-ros-name "HTTPServer")
;=> HTTPSERVER

(lispify-ros-name "arm2Left")
;=> ARM2-LEFT

(lispify-ros-name "x" (find-package :keyword))
;=> :X

(lispify-ros-name "aB" :keyword)
;=> :A-B

(lispify-ros-underscore-name "my_ros_name")
;=> MY-ROS-NAME

(lispify-ros-underscore-name "my_ros_name" :keyword)
;=> :MY-ROS-NAME

(lispify-ros-underscore-name "name")
;=> NAME

(rosify-lisp-name 'my-lisp-name)
;=> "MyLispName"

(rosify-lisp-name :left-arm)
;=> "LeftArm"

(rosify-lisp-name 'x)
;=> "X"

(rosify-underscores-lisp-name 'my-lisp-name)
;=> "my_lisp_name"

(rosify-underscores-lisp-name :left-arm)
;=> "left_arm"

(rosify-underscores-lisp-name 'x)
;=> "x"

(rosify-lisp-name (lispify-ros-name "myRosName" :keyword))
;=> "MyRosName"

(lispify-ros-name (rosify-lisp-name :left-arm) :keyword)
;=> :LEFT-ARM

(rosify-underscores-lisp-name (lispify-ros-underscore-name "a_b_c" :keyword))
;=> "a_b_c"

(defvar *called* nil)
;=> \*CALLED\*

(defun first-of-all () (push :first *called*))
;=> FIRST-OF-ALL

(defun then () (push :then *called*))
;=> THEN

(defun last-of-all () (push :last *called*))
;=> LAST-OF-ALL

(register-ros-init-function last-of-all 10)
;=> #<FUNCTION LAST-OF-ALL>

(register-ros-init-function then)
;=> #<FUNCTION THEN>

(register-ros-init-function first-of-all -5)
;=> #<FUNCTION FIRST-OF-ALL>

(defun goodbye () (push :goodbye *called*))
;=> GOODBYE

(register-ros-cleanup-function goodbye)
;=> #<FUNCTION GOODBYE>

(progn (startup-ros :anonymous nil :name "list-of-typed-forms") (reverse *called*))
;=> \(:LAST :THEN :FIRST\)

(progn (setf *called* nil) (shutdown-ros) *called*)
;=> \(:GOODBYE\)

(progn (setf *called* nil) (startup-ros) (startup-ros) (length *called*))
;=> 7
