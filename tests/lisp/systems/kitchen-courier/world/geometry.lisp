;;;; Points and poses, in double-floats.

(in-package #:courier-world)

(deftype coordinate () 'double-float)
(deftype fraction (&optional (limit 1)) `(real 0 ,limit))
(deftype angle () `(double-float ,(- pi) ,pi))

(defstruct (point (:constructor make-point (x y)) (:copier copy-point))
  (x 0d0 :type real)
  (y 0d0 :type real))

(defstruct (pose (:include point (x 0d0)) (:constructor make-pose (x y &optional (heading 0d0)))
                 (:print-object (lambda (pose stream)
                                  (format stream "@(~,2F ~,2F ~,3F)" (pose-x pose) (pose-y pose) (pose-heading pose)))))
  (heading 0d0 :type angle))

(defmethod print-object ((point point) stream)
  (if *print-readably*
      (call-next-method)
      (format stream "(~A, ~A)" (point-x point) (point-y point))))

(defun normalize-angle (angle)
  "ANGLE in radians within -pi and pi."
  (loop while (> angle pi) do (decf angle (* 2 pi)))
  (loop while (< angle (- pi)) do (incf angle (* 2 pi)))
  angle)

(defgeneric distance (from to)
  (:documentation "How far two things are apart.")
  (:method ((from point) (to point))
    (sqrt (coerce (+ (expt (- (point-x to) (point-x from)) 2) (expt (- (point-y to) (point-y from)) 2)) 'double-float)))
  (:method ((from pose) (to pose))
    (values (call-next-method) (normalize-angle (- (pose-heading to) (pose-heading from)))))
  (:method ((from real) (to real)) (abs (- to from)))
  (:method ((from list) (to list)) (reduce #'+ (mapcar #'distance from to)))
  (:method ((from string) (to string)) (count nil (map 'list #'char= from to))))

(defun heading-to (from to)
  (normalize-angle (atan (coerce (- (point-y to) (point-y from)) 'double-float)
                         (coerce (- (point-x to) (point-x from)) 'double-float))))

(defun between (from to &optional (fraction 1/2))
  (check-type fraction fraction)
  (flet ((mix (a b) (+ a (* fraction (- b a)))))
    (make-point (mix (point-x from) (point-x to)) (mix (point-y from) (point-y to)))))

;;; A place with two values: (setf (polar point) (values radius angle)).

(defun polar (point)
  (values (distance (make-point 0 0) point) (heading-to (make-point 0 0) point)))

(defun set-polar (point radius angle)
  (setf (point-x point) (* radius (cos angle))
        (point-y point) (* radius (sin angle)))
  (values radius angle))

(defsetf polar (point) (radius angle) `(set-polar ,point ,radius ,angle))
