;;;; Stamped transforms: made of poses, inverted, moved, and multiplied.

(in-package #:cram-tf)

(defun pose->transform-stamped (parent-frame child-frame stamp pose)
  "The transform that puts CHILD-FRAME at POSE in PARENT-FRAME."
  (make-transform-stamped parent-frame child-frame stamp (origin pose) (orientation pose)))

(defun pose-stamped->transform-stamped (pose-stamped child-frame-id)
  "The transform that puts CHILD-FRAME-ID at a stamped pose."
  (pose->transform-stamped (frame-id pose-stamped) child-frame-id (stamp pose-stamped) pose-stamped))

(defun transform-stamped-inv (transform-stamped)
  "The transform back."
  (let ((inverse (transform-inv transform-stamped)))
    (make-transform-stamped (child-frame-id transform-stamped) (frame-id transform-stamped) (stamp transform-stamped)
                            (translation inverse) (rotation inverse))))

(defun strip-transform-stamped (transform-stamped)
  "Where a transform puts its child frame: a stamped pose."
  (make-pose-stamped (frame-id transform-stamped) (stamp transform-stamped)
                     (translation transform-stamped) (rotation transform-stamped)))

(defun copy-transform-stamped (transform-stamped
                               &key (frame-id (frame-id transform-stamped)) (child-frame-id (child-frame-id transform-stamped))
                                 (stamp (stamp transform-stamped)) (translation (translation transform-stamped))
                                 (rotation (rotation transform-stamped)))
  "A transform as TRANSFORM-STAMPED, but for what is given."
  (make-transform-stamped frame-id child-frame-id stamp translation rotation))

(defun translate-transform-stamped (transform-stamped &key (x-offset 0.0) (y-offset 0.0) (z-offset 0.0))
  "TRANSFORM-STAMPED, moved along the axes of its parent frame."
  (copy-transform-stamped transform-stamped
                          :translation (moved (translation transform-stamped) x-offset y-offset z-offset)))

(defun multiply-transform-stampeds (x-frame z-frame x-y-transform y-z-transform &key (result-as-pose-or-transform :transform))
  "Where Z-FRAME is in X-FRAME: the product of the transforms from there to a frame between and on from it, with the older of their stamps,
as a stamped :TRANSFORM or :POSE. Frames that do not fit together are warned of."
  (flet ((check (what frame expected)
           (unless (string= (unslash-frame frame) (unslash-frame expected))
             (warn "[CRAM-TF:MULTIPLY-TRANSFORM-STAMPEDS] ~a is ~s and should be ~s." what frame expected))))
    (check "The frame of the first transform" (frame-id x-y-transform) x-frame)
    (check "The frame of the second transform" (frame-id y-z-transform) (child-frame-id x-y-transform))
    (check "The child frame of the second transform" (child-frame-id y-z-transform) z-frame))
  (let* ((product (transform* x-y-transform y-z-transform))
         (result (make-transform-stamped x-frame z-frame (min (stamp x-y-transform) (stamp y-z-transform))
                                         (translation product) (rotation product))))
    (ecase result-as-pose-or-transform
      (:transform result)
      (:pose (strip-transform-stamped result)))))

(defun apply-transform (left-hand-side-transform right-hand-side-transform)
  "The product of two stamped transforms, from the frame of the first to the child frame of the second."
  (multiply-transform-stampeds (frame-id left-hand-side-transform) (child-frame-id right-hand-side-transform)
                               left-hand-side-transform right-hand-side-transform))
