(in-package :btf)

(defgeneric pose->list (thing)
  (:documentation "THING as lists of numbers.")
  (:method ((thing 3d-vector)) (with-slots (x y z) thing (list x y z)))
  (:method ((thing quaternion)) (list (x thing) (y thing) (z thing) (w thing)))
  (:method ((thing pose)) (list (pose->list (origin thing)) (pose->list (orientation thing))))
  (:method :around ((thing pose-stamped))
    (cons (frame-id thing) (call-next-method))))

(defun list->pose (list)
  (destructuring-bind ((x y z) &optional ((qx qy qz qw) '(0 0 0 1))) list
    (make-pose (make-3d-vector x y z) (make-quaternion qx qy qz qw))))

(defgeneric ensure-pose (thing &key frame)
  (:method ((thing pose-stamped) &key frame)
    (if (or (null frame) (string= (frame-id thing) frame))
        thing
        (transform-pose-stamped *transformer* :pose thing :target-frame frame :timeout 0.0)))
  (:method ((thing pose) &key (frame *fixed-frame*))
    (make-pose-stamped frame 0.0 (origin thing) (orientation thing)))
  (:method ((thing 3d-vector) &key (frame *fixed-frame*))
    (make-pose-stamped frame 0.0 thing (make-identity-rotation)))
  (:method ((thing transform-stamped) &key &allow-other-keys)
    (make-pose-stamped (frame-id thing) (stamp thing) (translation thing) (rotation thing)))
  (:method ((thing list) &rest arguments &key &allow-other-keys)
    (apply #'ensure-pose (list->pose thing) arguments))
  (:method ((thing bc:position) &key frame)
    (declare (ignore frame))
    (ensure-pose (make-3d-vector (bc:position-x thing) (bc:position-y thing) 0) :frame (bc::position-frame thing))))

(defun translate-pose (pose &key (x 0.0) (y 0.0) (z 0.0))
  (copy-pose-stamped
   pose
   :origin (v+ (origin pose) (make-3d-vector x y z))))

(defun rotate-pose-around-z (pose angle)
  (copy-pose-stamped
   pose :orientation (q* (axis-angle->quaternion (make-3d-vector 0 0 1) angle) (orientation pose))))

(defun look-from-to (from to)
  "The rotation around z that looks from FROM to TO."
  (let ((way (v- to from)))
    (axis-angle->quaternion (make-3d-vector 0 0 1) (atan (y way) (x way)))))

(defun pose-towards (place target)
  (make-pose-stamped *fixed-frame* 0.0 place (look-from-to place (origin target))))

(defun pose-distance (from to)
  (v-dist (origin from) (origin to)))

(defun poses-equal-p (pose other &key (position-tolerance 0.01) (angle-tolerance (/ pi 180)))
  (and (<= (pose-distance pose other) position-tolerance)
       (<= (abs (angle-between-quaternions (orientation pose) (orientation other))) angle-tolerance)))

(defun strip-stamp (thing)
  (etypecase thing
    (pose-stamped (make-pose (origin thing) (orientation thing)))
    (transform-stamped (make-transform (translation thing) (rotation thing)))
    ((or pose transform) thing)))

(defun pose-in-frame (frame pose)
  (ensure-pose pose :frame frame))

(defun poses-near (pose &key (distance 0.5) (count 4))
  "A lazy list of poses around POSE, endlessly."
  (lazy-list ((index 0))
    (let ((angle (* index (/ (* 2 pi) count))))
      (cont (translate-pose pose :x (* distance (cos angle)) :y (* distance (sin angle)))
            (mod (1+ index) count)))))

(def-fact-group barista-poses ()
  (<- (pose ?thing ?pose)
    (lisp-type ?thing cl-transforms:pose)
    (lisp-fun ensure-pose ?thing ?pose))
  (<- (frame ?pose ?frame)
    (bound ?pose)
    (lisp-fun frame-id ?pose ?frame))
  (<- (poses-close ?one ?other)
    (lisp-fun pose-distance ?one ?other ?distance)
    (cram-prolog:< ?distance 0.5)))
