;;;; What plans ask about objects: where they are, what kind they are of, and how a gripper takes hold of them.

(defpackage #:cram-object-interfaces
  (:use #:common-lisp #:cram-prolog)
  (:nicknames #:obj-int)
  (:export
   ;; objects
   #:get-object-pose #:get-object-transform #:object-type-direct-subtype #:object-type-subtype #:object-rotationally-symmetric
   #:orientation-matters
   ;; grasps
   #:object-type-grasp #:get-object-type-grasps #:get-object-grasping-poses #:calculate-object-faces
   #:object-type-grasp->robot-grasp #:robot-grasp->object-type-grasp
   ;; gripper
   #:get-object-type-gripping-effort #:get-object-type-gripper-opening #:get-object-type-to-gripper-transform
   #:get-object-type-to-gripper-pregrasp-transform #:get-object-type-to-gripper-2nd-pregrasp-transform
   #:get-object-type-to-gripper-lift-transform #:get-object-type-to-gripper-2nd-lift-transform
   #:def-object-type-to-gripper-transforms
   #:*back-grasp-rotation* #:*front-grasp-rotation* #:*left-side-grasp-rotation* #:*right-side-grasp-rotation*
   #:*top-across-x-grasp-rotation* #:*top-across-y-grasp-rotation*))
