;;;; Poses as lists and back; poses that are near each other; poses moved and turned.

(in-package #:cram-tf)

(defun pose->list (pose)
  "POSE as ((X Y Z) (QX QY QZ QW))."
  (with-slots (origin orientation) pose
    (list (list (x origin) (y origin) (z origin))
          (list (x orientation) (y orientation) (z orientation) (w orientation)))))

(defun pose->flat-list (pose)
  "POSE as (X Y Z QX QY QZ QW)."
  (apply #'append (pose->list pose)))

(defun pose->flat-list-w-first (pose)
  "POSE as (X Y Z QW QX QY QZ)."
  (destructuring-bind (position (qx qy qz qw)) (pose->list pose)
    (append position (list qw qx qy qz))))

(defun list->pose (pose-list)
  "The pose of ((X Y Z) (QX QY QZ QW))."
  (destructuring-bind (position rotation) pose-list
    (make-pose (apply #'make-3d-vector position) (apply #'make-quaternion rotation))))

(defun flat-list->pose (pose-list)
  "The pose of (X Y Z QX QY QZ QW)."
  (list->pose (list (subseq pose-list 0 3) (subseq pose-list 3))))

(defun flat-list-w-first->pose (pose-list)
  "The pose of (X Y Z QW QX QY QZ)."
  (destructuring-bind (x y z qw qx qy qz) pose-list
    (list->pose (list (list x y z) (list qx qy qz qw)))))

(defun poses-equal-p (pose-1 pose-2 dist-sigma ang-sigma)
  "Whether two poses are nearer to each other than DIST-SIGMA metres and ANG-SIGMA radians."
  (and (< (v-dist (origin pose-1) (origin pose-2)) dist-sigma)
       (< (abs (angle-between-quaternions (orientation pose-1) (orientation pose-2))) ang-sigma)))

(defun copy-of-pose (pose &key (origin (origin pose)) (orientation (orientation pose)))
  "A pose as POSE, stamped if that is."
  (if (typep pose 'pose-stamped)
      (copy-pose-stamped pose :origin origin :orientation orientation)
      (make-pose origin orientation)))

(defun moved (vector x-offset y-offset z-offset)
  (v+ vector (make-3d-vector x-offset y-offset z-offset)))

(defun translate-pose (pose &key (x-offset 0.0) (y-offset 0.0) (z-offset 0.0))
  "POSE, moved along the axes of its frame, and turned as it was."
  (copy-of-pose pose :origin (moved (origin pose) x-offset y-offset z-offset)))

(defun rotate-pose (pose axis angle)
  "POSE, where it was, turned by ANGLE radians about an axis of its frame: :X, :Y or :Z."
  (let ((axis-vector (case axis
                       (:x (make-3d-vector 1 0 0))
                       (:y (make-3d-vector 0 1 0))
                       (:z (make-3d-vector 0 0 1))
                       (t (error "[CRAM-TF:ROTATE-POSE] axis ~a not specified properly" axis)))))
    (copy-of-pose pose :orientation (normalize (q* (axis-angle->quaternion axis-vector angle) (orientation pose))))))
