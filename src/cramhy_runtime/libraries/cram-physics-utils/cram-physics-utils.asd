(defsystem "cram-physics-utils"
  :description "Addresses of files in ROS packages, and meshes."
  :depends-on ("cl-transforms")
  :components ((:file "cram-physics-utils")))
