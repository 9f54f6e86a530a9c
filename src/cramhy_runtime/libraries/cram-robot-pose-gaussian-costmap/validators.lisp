;;;; Validators: whether a place for the robot is on the floor, near enough, and turned towards what is to be reached or seen.

(in-package #:cram-robot-pose-guassian-costmap)

(defun setting (&rest goal)
  "The value of ?VALUE in the first solution of GOAL, or nil."
  (let ((solution (cut:lazy-car (prolog goal))))
    (and solution (cut:var-value '?value solution))))

(defun pose-p (thing)
  (typep thing 'cl-transforms:pose))

(defun robot-location-on-floor (designator pose)
  "Accept what is lower than 5 cm, for places from which a robot reaches or sees."
  (cond ((not (and (pose-p pose)
                   (or (cram-robot-interfaces:reachability-designator-p designator)
                       (cram-robot-interfaces:visibility-designator-p designator))))
         :unknown)
        ((< (cl-transforms:z (cl-transforms:origin (in-fixed-frame pose))) 0.05) :accept)
        (t :reject)))

(defun place-of (target)
  "The point of TARGET, a pose or a point."
  (if (pose-p target) (cl-transforms:origin target) target))

(defun distance-on-floor (point other)
  (sqrt (+ (expt (- (cl-transforms:x point) (cl-transforms:x other)) 2)
           (expt (- (cl-transforms:y point) (cl-transforms:y other)) 2))))

(defun turned-towards-p (pose point angle)
  "Whether POSE is turned to POINT up to ANGLE radians."
  (let* ((origin (cl-transforms:origin pose))
         (direction (atan (- (cl-transforms:y point) (cl-transforms:y origin))
                          (- (cl-transforms:x point) (cl-transforms:x origin)))))
    (<= (abs (cl-transforms:normalize-angle (- (cl-transforms:get-yaw (cl-transforms:orientation pose)) direction)))
        (+ angle 1d-6))))

(defun judge (designator pose kind minimal-distance distance)
  "The verdict about POSE by the targets of DESIGNATOR for KIND: each is between the distances, and their mean is in front. The distances are
names of settings, the minimal one nil for none. Settings are asked for only where there are targets."
  (let* ((targets (and (pose-p pose) (setting 'target-places designator kind '?value)))
         (distance (and targets (setting distance '?value)))
         (minimal-distance (cond ((null distance) nil)
                                 (minimal-distance (setting minimal-distance '?value))
                                 (t 0)))
         (samples (and minimal-distance (setting 'orientation-samples '?value)))
         (step (and samples (setting 'orientation-sample-step '?value))))
    (if (not step)
        :unknown
        (let* ((pose (in-fixed-frame pose))
               (place (cl-transforms:origin pose))
               (points (mapcar #'place-of (cut:force-ll targets))))
          (if (and (every (lambda (point)
                            (<= (- minimal-distance 1d-6) (distance-on-floor place point) (+ distance 1d-6)))
                          points)
                   (turned-towards-p pose (points-mean points) (* step (ceiling samples 2))))
              :accept
              :reject)))))

(defun reachable-location-validator (designator pose)
  "Accept a pose that is as far from what is to be reached as the settings say, and turned towards it."
  (judge designator pose :reach 'costmap-reach-minimal-distance 'costmap-in-reach-distance))

(defun visible-location-validator (designator pose)
  "Accept a pose that is as near to what is to be seen as the settings say, and turned towards it."
  (judge designator pose :see nil 'visibility-costmap-size))

(register-location-validation-function 1 robot-location-on-floor "Robots stand on the floor.")
(register-location-validation-function 5 reachable-location-validator "The robot reaches its target from there.")
(register-location-validation-function 5 visible-location-validator "The robot looks at its target from there.")
