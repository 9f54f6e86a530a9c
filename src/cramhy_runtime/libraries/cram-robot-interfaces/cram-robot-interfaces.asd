(defsystem "cram-robot-interfaces"
  :description "The predicates with which plans ask about a robot: its arms, frames, joints and camera."
  :depends-on (cram-prolog cram-designators cram-utilities roslisp cl-transforms)
  :serial t
  :components ((:file "package")
               (:file "predicates")
               (:file "joints")
               (:file "designators")))
