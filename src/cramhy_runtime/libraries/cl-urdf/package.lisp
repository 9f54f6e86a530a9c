;;;; cl-urdf: what a URDF file tells of a robot, as objects that programs look at and change.

(defpackage #:cl-urdf
  (:use #:common-lisp)
  (:export #:parse-urdf #:generate-urdf-xml #:generate-urdf-string
           #:urdf-type-not-supported #:urdf-attribute-not-supported #:urdf-malformed #:*display-ignored-warning*
           #:robot #:name #:links #:joints #:root-link #:materials
           #:link #:from-joint #:to-joints #:inertial #:mass #:inertia #:visual #:visuals #:collision #:collisions
           #:joint #:joint-type #:type #:axis #:origin #:parent #:child #:limits #:lower #:upper #:effort #:velocity
           #:mimics #:multiplier #:offset
           #:geometry #:box #:size #:cylinder #:radius #:length #:cylinder-length #:sphere #:mesh #:filename #:scale
           #:material #:color #:texture
           #:get-link-chain #:get-joint-chain))
