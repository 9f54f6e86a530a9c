(defsystem "cl-urdf"
  :description "Descriptions of robots and furniture, read from URDF: links, joints, limits, shapes, materials."
  :depends-on ("cl-transforms")
  :serial t
  :components ((:file "package")
               (:file "parts")
               (:file "robot")))
