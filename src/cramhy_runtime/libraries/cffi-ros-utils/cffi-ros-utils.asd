(defsystem "cffi-ros-utils"
  :description "The package whose macros find C libraries in ROS packages. cramhy calls no functions of C, so there are none of them."
  :depends-on ("cffi")
  :components ((:file "cffi-ros-utils")))
