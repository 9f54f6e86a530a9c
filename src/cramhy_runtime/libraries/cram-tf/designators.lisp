;;;; Designators and poses: (a location (pose ?p)), where a designator is, how far from another, and which of its solutions are the same.

(in-package #:cram-tf)

(defun position-of (pose)
  "The place of POSE, or of a vector, as a list (x y z)."
  (let ((vector (if (typep pose '3d-vector) pose (origin pose))))
    (list (x vector) (y vector) (z vector))))

(defun orientation-of (pose)
  "The orientation of POSE, or a quaternion, as a list (x y z w)."
  (let ((quaternion (if (typep pose 'quaternion) pose (orientation pose))))
    (list (x quaternion) (y quaternion) (z quaternion) (w quaternion))))

(defun pose-from (position orientation)
  "The pose of two lists, or of a vector and a quaternion."
  (make-pose (if (listp position) (apply #'make-3d-vector position) position)
             (if (listp orientation) (apply #'make-quaternion orientation) orientation)))

(def-fact-group poses (pose pose-stamped position orientation poses-equal)

  (<- (position ?pose ?position)
    (bound ?pose)
    (lisp-fun position-of ?pose ?position))

  (<- (position ?vector (?x ?y ?z))
    (not (bound ?vector))
    (lisp-fun make-3d-vector ?x ?y ?z ?vector))

  (<- (orientation ?pose ?orientation)
    (bound ?pose)
    (lisp-fun orientation-of ?pose ?orientation))

  (<- (orientation ?quaternion (?x ?y ?z ?w))
    (not (bound ?quaternion))
    (lisp-fun make-quaternion ?x ?y ?z ?w ?quaternion))

  (<- (pose ?pose ?position ?orientation)
    (bound ?pose)
    (lisp-type ?pose pose)
    (position ?pose ?position)
    (orientation ?pose ?orientation))

  (<- (pose ?pose ?position ?orientation)
    (not (bound ?pose))
    (ground ?position)
    (ground ?orientation)
    (lisp-fun pose-from ?position ?orientation ?pose))

  (<- (pose ?pose (?position ?orientation))
    (pose ?pose ?position ?orientation))

  (<- (pose-stamped ?pose ?frame ?stamp ?position ?orientation)
    (bound ?pose)
    (lisp-type ?pose pose-stamped)
    (lisp-fun frame-id ?pose ?frame)
    (lisp-fun stamp ?pose ?stamp)
    (pose ?pose ?position ?orientation))

  (<- (pose-stamped ?pose ?frame ?stamp ?position ?orientation)
    (not (bound ?pose))
    (pose ?plain ?position ?orientation)
    (lisp-fun pose->pose-stamped ?frame ?stamp ?plain ?pose))

  (<- (poses-equal ?pose-1 ?pose-2 (?dist-sigma ?ang-sigma))
    (lisp-type ?pose-1 pose)
    (lisp-type ?pose-2 pose)
    (lisp-pred poses-equal-p ?pose-1 ?pose-2 ?dist-sigma ?ang-sigma)))

(def-fact-group desig-tf-solutions (location-pose location-grounding)

  (<- (location-pose ?location ?pose)
    (loc-desig? ?location)
    (current-designator ?location ?current)
    (desig-reference ?current ?pose))

  (<- (location-grounding ?designator ?pose)
    (loc-desig? ?designator)
    (current-designator ?designator ?current)
    (spec:property ?current (:pose ?pose))
    (lisp-type ?pose pose)))

(defmethod reference :around ((designator location-designator) &optional role)
  "A pose without a frame is in the fixed one."
  (declare (ignore role))
  (let ((solution (call-next-method)))
    (if (and (typep solution 'pose) (not (typep solution 'pose-stamped)))
        (pose->pose-stamped (or *fixed-frame* (error "cram-tf:*fixed-frame* must be set.")) 0.0 solution)
        solution)))

(defmethod designator-pose ((designator location-designator))
  (reference designator))

(defmethod designator-distance ((designator-1 location-designator) (designator-2 location-designator))
  (let ((pose-1 (reference designator-1))
        (pose-2 (reference designator-2)))
    (v-dist (origin pose-1) (origin (in-frame-of pose-1 pose-2)))))

(defun in-frame-of (pose other)
  "The pose OTHER in the frame of POSE, where both have frames."
  (if (and (typep pose 'pose-stamped) (typep other 'pose-stamped))
      (ensure-pose-in-frame other (frame-id pose) :use-zero-time t)
      other))

(defconstant +same-place+ 0.025
  "Metres within which two solutions are the same.")

(defconstant +same-turn+ (* 5 (/ pi 180))
  "Radians within which two solutions are the same.")

(defmethod designator-solutions-equal ((solution-1 pose) (solution-2 pose))
  "Whether two poses are the same place, compared in one frame."
  (poses-equal-p solution-1 (in-frame-of solution-1 solution-2) +same-place+ +same-turn+))

(defun make-euclidean-distance-filter (pose distance-threshold)
  "A filter of solutions of locations, which keeps those that are farther from POSE than DISTANCE-THRESHOLD metres."
  (lambda (solution)
    (> (v-dist (origin pose) (origin (in-frame-of pose solution))) distance-threshold)))
