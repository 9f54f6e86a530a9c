(in-package :barista-plans)

(defvar *robot-pose* nil "Where the robot is, a fluent of a pose in the map.")
(defvar *held* (make-fluent :name 'held :value '()) "What the hands hold: an alist from arm to thing.")
(defvar *cups-fluent* (make-fluent :name :cups :allow-tracing nil))
(defvar *drop-next* 0 "How many cups will be dropped.")
(defvar *log* '())

(declaim (type (integer 0) *drop-next*))

(defun report (control &rest arguments)
  (let ((line (apply #'format nil control arguments)))
    (setf *log* (nconc *log* (list line)))
    (values line (length *log*))))

(defun place (x y &optional (z 0) (frame "map"))
  (cl-transforms-stamped:make-pose-stamped frame 0.0 (cl-transforms:make-3d-vector x y z) (cl-transforms:make-identity-rotation)))

(defun reset-world ()
  (bk:forget-things)
  (btf:init-frames)
  (setf *robot-pose* (make-fluent :name 'robot-pose :value (place 0 0))
        (value *held*) nil
        *drop-next* 0
        *log* nil)
  (loop for (kind name x y . more) in '((bk:cup cup-1 2 1) (bk:mug mug-1 2 -1 :handle :left) (bk:glass glass-1 3 0) (bk:tray tray-1 -1 0))
        do (setf (thing-pose (apply #'bk:add-thing kind name more)) (place x y 0.8)))
  (btf:set-base-pose (value *robot-pose*))
  (loop for key being each hash-key of bk:*things* using (hash-value thing)
        collect (cons key (bk:thing-kind thing)) into found
        finally (return (sort found #'string< :key #'car))))

(defun distance-to (pose)
  (fl-funcall (lambda (here) (btf:pose-distance here pose)) *robot-pose*))
