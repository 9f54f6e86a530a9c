(ros-load:load-system "roslisp_tutorials_basics" :roslisp-tutorials-basics)
;=> T

(in-package :roslisp-tutorials-basics)
;=> #<PACKAGE "ROSLISP-TUTORIALS-BASICS">

(list (params-example) (params-example))
;=> \(0 0\)

(with-ros-node ("adder")
  (register-service "add_two_ints" 'AddTwoInts)
  (list (wait-for-service "add_two_ints" 10) (sum (call-service "add_two_ints" 'AddTwoInts :a 3 :b 4))))
;=> \(T 7\)

(let ((heard ()))
  (with-ros-node ("chatterer")
    (subscribe "chatter" "std_msgs/String" (lambda (message) (push (std_msgs-msg:data message) heard)))
    (let ((pub (advertise "chatter" "std_msgs/String")))
      (dotimes (i 2) (publish-msg pub :data (format nil "foo ~a" (1+ i))) (sleep 0.2))))
  heard)
;=> \("foo 2" "foo 1"\)

(let ((heard ()))
  (with-ros-node ("array_chatterer")
    (subscribe "array_chatter" '<Test> (lambda (message) (push (list (length (location message)) (orientation message)) heard)))
    (let ((pub (advertise "array_chatter" '<Test>)) (point (make-instance '<Point> :x 1.0 :y 2.0 :z 42.0)))
      (publish pub (make-instance '<Test> :location (vector point point) :orientation (vector 4 2 2)))
      (sleep 0.2)))
  heard)
;=> \(\(2 #\(4 2 2\)\)\)

(let ((talking (sb-thread:make-thread #'talker)))
  (sleep 1)
  (prog1 (sb-thread:thread-alive-p talking) (sb-thread:terminate-thread talking)))
;=> T
