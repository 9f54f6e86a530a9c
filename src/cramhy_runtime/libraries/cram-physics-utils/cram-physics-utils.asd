(defsystem "cram-physics-utils"
  :description "Files of meshes, and what is in them: points, faces, sizes, masses."
  :depends-on ("cffi" "cffi-ros-utils" "cl-transforms" "roslisp" "cram-utilities")
  :serial t
  :components ((:file "cram-physics-utils")
               (:file "shapes")
               (:file "event-queue")))
