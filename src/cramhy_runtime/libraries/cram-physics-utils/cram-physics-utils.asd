(defsystem "cram-physics-utils"
  :description "Addresses of files in ROS packages, and meshes."
  :depends-on ("cl-transforms" "cffi" "cffi-ros-utils")
  :components ((:file "cram-physics-utils")))
