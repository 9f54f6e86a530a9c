;;;; Places on top of things, and what a robot may open.

(in-package #:cram-bullet-reasoning)

(defun top-of (object)
  "The box on whose upper side things stand: a list of its middle and its lengths."
  (let ((box (aabb object)))
    (list (bounding-box-center box) (bounding-box-dimensions box))))

(defun place-on (bottom right back)
  "The pose on top of BOTTOM at the shares RIGHT and BACK, from 0 to 1, of its lengths."
  (destructuring-bind (center lengths) (top-of bottom)
    (make-pose (make-3d-vector (+ (x center) (* (- right 0.5) (x lengths)))
                               (+ (y center) (* (- back 0.5) (y lengths)))
                               (+ (z center) (/ (z lengths) 2)))
               (make-identity-rotation))))

(defgeneric poses-on (top bottom &key n)
  (:documentation "N poses for TOP that lie in a grid on the upper side of BOTTOM; TOP is as high as it must be to stand there.")
  (:method (top bottom &key (n 9))
    (let ((side (ceiling (sqrt n))))
      (loop for number below n
            for (row column) = (multiple-value-list (floor number side))
            collect (standing top (place-on bottom (/ (+ column 0.5) side) (/ (+ row 0.5) side)))))))

(defun random-poses (n top bottom)
  "N poses for TOP anywhere on the upper side of BOTTOM."
  (loop repeat n collect (standing top (place-on bottom (random 1.0) (random 1.0)))))

(defun standing (object pose)
  "POSE, as much higher as the origin of OBJECT is above its lowest point."
  (let ((up (- (z (origin (pose object))) (z (origin (bottom-pose object))))))
    (copy-pose pose :origin (v+ (origin pose) (make-3d-vector 0 0 up)))))

(defun some-poses-of (designator n)
  "The first N poses of a location designator."
  (loop repeat n
        for solution = designator then (cram-designators:next-solution solution)
        while solution collect (cram-designators:reference solution)))

(defun joint-above (robot link)
  "The name of the nearest joint that moves LINK, nil when there is none."
  (loop with joints = (joints-in-file robot)
        for joint = (find link joints :key #'fourth :test #'equal) then (find (third joint) joints :key #'fourth :test #'equal)
        while joint
        unless (eq (second joint) :fixed) return (first joint)))

(defun move-to-limit (robot link end)
  "Open or close what LINK is part of: the joint goes to its upper or lower limit. Nil when there is no such joint."
  (let* ((joint (joint-above robot link))
         (limits (and joint (robot-world:joint-limits robot joint)))
         (value (ecase end (:open (second limits)) (:close (first limits)))))
    (when value
      (setf (joint-state robot joint) value)
      t)))

(def-fact-group places (poses-on n-poses-on random-poses-on execute)
  (<- (poses-on ?world ?top ?bottom ?poses)
    (n-poses-on ?world 9 ?top ?bottom ?poses))

  (<- (n-poses-on ?world ?n ?top ?bottom ?poses)
    (%object ?world ?top ?above)
    (%object ?world ?bottom ?below)
    (lisp-fun poses-on ?above ?below :n ?n ?poses))

  (<- (random-poses-on ?world ?n ?top ?bottom ?poses)
    (%object ?world ?top ?above)
    (%object ?world ?bottom ?below)
    (lisp-fun random-poses ?n ?above ?below ?poses))

  (<- (desig-poses ?designator ?poses)
    (desig-poses ?designator 10 ?poses))

  (<- (desig-poses ?designator ?n ?poses)
    (lisp-fun some-poses-of ?designator ?n ?poses))

  (<- (execute ?world (open ?object ?link))
    (%object ?world ?object ?instance)
    (lisp-type ?instance robot-object)
    (lisp-pred move-to-limit ?instance ?link :open))

  (<- (execute ?world (close ?object ?link))
    (%object ?world ?object ?instance)
    (lisp-type ?instance robot-object)
    (lisp-pred move-to-limit ?instance ?link :close)))
