;;;; Frames: the world says where the links of the robot are.

(in-package #:cram-bullet-reasoning-belief-state)

(defun set-tf-from-bullet (&key (transformer cram-tf:*transformer*) (fixed-frame cram-tf:*fixed-frame*)
                             (odom-frame cram-tf:*odom-frame*) (base-frame cram-tf:*robot-base-frame*)
                             (time (roslisp:ros-time)) display-warnings)
  "Let TRANSFORMER know where the base of the robot and its links are in the current world, at TIME."
  (declare (ignore display-warnings))
  (let* ((robot (btr:get-robot-object))
         (base (cl-transforms:pose->transform (btr:pose robot)))
         (to-base (cl-transforms:transform-inv base)))
    (flet ((tell (frame child transform)
             (cl-tf:set-transform transformer
                                  (cl-transforms-stamped:make-transform-stamped
                                   frame child time (cl-transforms:translation transform) (cl-transforms:rotation transform)))))
      (when odom-frame
        (tell fixed-frame odom-frame (cl-transforms:make-identity-transform)))
      (tell (or odom-frame fixed-frame) base-frame base)
      (dolist (link (btr:link-names robot))
        (unless (string= link base-frame)
          (tell base-frame link (cl-transforms:transform* to-base (cl-transforms:pose->transform (btr:link-pose robot link)))))))))

(defun update-bullet-transforms ()
  "Publish where the links are, if transforms are to be published at all."
  (when cram-tf:*tf-broadcasting-enabled*
    (set-tf-from-bullet)))

(defun object-pose-in-frame (object frame)
  "Where OBJECT is, as a stamped pose in FRAME."
  (cram-tf:ensure-pose-in-frame
   (cl-transforms-stamped:pose->pose-stamped cram-tf:*fixed-frame* 0.0 (btr:pose object)) frame :use-zero-time t))
