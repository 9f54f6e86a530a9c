;;;; CRAM-TF: the frames of the robot, and what plans do with poses and transforms.

(defpackage #:cram-tf
  (:use #:cl #:desig #:cut #:prolog #:cl-transforms-stamped #:cl-transforms #:cram-robot-interfaces)
  (:export
   ;; frames
   #:*transformer* #:*tf-default-timeout* #:*fixed-frame* #:*odom-frame* #:*robot-base-frame* #:*robot-torso-frame*
   #:*robot-torso-joint* #:*robot-left-tool-frame* #:*robot-right-tool-frame*
   #:ensure-pose-in-frame #:ensure-point-in-frame #:frame-to-pose-in-fixed-frame #:robot-current-pose #:tf-frame-converged
   ;; poses
   #:pose->flat-list #:pose->flat-list-w-first #:pose->list #:flat-list->pose #:flat-list-w-first->pose #:list->pose
   #:poses-equal-p #:translate-pose #:rotate-pose
   ;; transforms
   #:pose->transform-stamped #:pose-stamped->transform-stamped #:transform-stamped-inv #:strip-transform-stamped
   #:copy-transform-stamped #:translate-transform-stamped #:multiply-transform-stampeds #:apply-transform
   ;; designators
   #:make-euclidean-distance-filter #:pose #:pose-stamped #:position #:orientation #:poses-equal #:location-pose
   ;; telling others
   #:*broadcaster* #:*tf-broadcasting-enabled* #:*tf-broadcasting-topic* #:*tf-broadcasting-interval*
   #:make-tf-broadcaster #:add-transform #:remove-transform #:publish-transforms #:start-publishing-transforms
   #:stop-publishing-transforms #:visualize-marker))
