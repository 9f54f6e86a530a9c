(in-package :btf)

(defvar *fixed-frame* nil "The frame that does not move.")
(defvar *base-frame* nil)
(defvar *transformer* nil "What knows the frames.")

(defmacro with-frames ((&key (fixed '*fixed-frame*) (base '*base-frame*)) &body body)
  "Run BODY with other frames."
  `(let ((*fixed-frame* ,fixed) (*base-frame* ,base))
     (declare (special *fixed-frame* *base-frame*))
     ,@body))

(defun init-frames (&key (fixed "map") (base "base_footprint"))
  (setf *fixed-frame* fixed
        *base-frame* base
        *transformer* (make-instance 'cl-tf:transformer)))

(defun destroy-frames ()
  (setf *transformer* nil))

(roslisp-utilities:register-ros-init-function init-frames)
(roslisp-utilities:register-ros-cleanup-function destroy-frames)

(defun set-base-pose (pose &optional (time 0.0))
  "Tell the transformer that the base is at POSE."
  (declare (type cl-transforms:pose pose))
  (cl-tf:set-transform
   *transformer*
   (transform->transform-stamped *fixed-frame* *base-frame* time (pose->transform pose))))

(defun base-pose (&key (time 0.0))
  (handler-case
      (let ((found (lookup-transform *transformer* *fixed-frame* *base-frame* :time time)))
        (make-pose-stamped *fixed-frame* time (translation found) (rotation found)))
    (transform-stamped-error (problem)
      (cpl:fail 'bc:barista-failure :description (format nil "Where is the base? ~a" (type-of problem))))))
