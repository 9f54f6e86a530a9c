(defsystem "cl-bullet"
  :description "The names of CL-BULLET that plans use: boxes around things, copies of worlds."
  :depends-on ("cffi" "cffi-ros-utils")
  :components ((:file "cl-bullet")))
