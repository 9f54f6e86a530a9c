(defsystem "cl-urdf"
  :description "Descriptions of robots and furniture, read from URDF: links, joints, limits, shapes."
  :depends-on ("cl-transforms")
  :components ((:file "cl-urdf")))
