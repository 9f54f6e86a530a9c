;;;; Reaching: whether an arm of a robot comes to a place, and what it would touch there. The original names these predicates, and has no
;;;; clauses for them.

(in-package #:cram-bullet-reasoning)

(defvar *reach-directions*
  (list (make-identity-rotation)
        (axis-angle->quaternion (make-3d-vector 0 0 1) (/ pi 4))
        (axis-angle->quaternion (make-3d-vector 0 0 1) (/ pi -4))
        (axis-angle->quaternion (make-3d-vector 0 0 1) (/ pi 2))
        (axis-angle->quaternion (make-3d-vector 0 0 1) (/ pi -2))
        (axis-angle->quaternion (make-3d-vector 0 1 0) (/ pi 2)))
  "From where a hand may come to a place, in the frame of the robot: from the robot, from its sides, and from above.")

(defparameter *tool-length* 0.2 "How far the tool is ahead of the wrist, in metres.")

(defun arm-of (robot side)
  "A list of the base link and the wrist link of the arm SIDE of ROBOT, nil when there is none."
  (let ((solution (lazy-car (prolog `(and (arm-base-links ,(name robot) ,side ?bases) (end-effector-link ,(name robot) ,side ?wrist))))))
    (and solution (list (first (var-value '?bases solution)) (var-value '?wrist solution)))))

(defun reaching-joints (robot side pose)
  "A list (joint . position) with which the tool of the arm SIDE is at POSE, in the world; nil when there is no such posture."
  (destructuring-bind (&optional base wrist) (arm-of robot side)
    (and base
         (robot-world:reach-with robot base wrist
                                 (transform-pose (pose->transform pose)
                                                 (make-pose (make-3d-vector (- *tool-length*) 0 0) (make-identity-rotation)))))))

(defun reaching-postures (robot side point)
  "The postures, as lists (joint . position), with which the tool of the arm SIDE is at POINT, in the world."
  (loop for direction in *reach-directions*
        for joints = (reaching-joints robot side (make-pose point (q* (orientation (pose robot)) direction)))
        when joints collect joints))

(defun middle (object)
  (bounding-box-center (aabb object)))

(defun touched-while-reaching (world robot object side)
  "The names of what the arm touches besides OBJECT when it reaches for it, in the posture in which that is least; :UNREACHABLE when there
is no posture."
  (let ((postures (reaching-postures robot side (middle object))))
    (if (null postures)
        :unreachable
        (first (sort (loop for joints in postures
                           for copy = (copy-world world)
                           for there = (object copy (name robot))
                           do (set-robot-state-from-joints joints there)
                           collect (set-difference (mapcar #'name (find-objects-in-contact copy there))
                                                   (cons (name object) (mapcar #'first (attached-objects robot)))
                                                   :test #'equal))
                     #'< :key #'length)))))

(def-fact-group reachability (object-grasp valid-grasp grasp side reachable point-reachable pose-reachable blocking)
  (<- (object-grasp ?world ?object ?grasp (?side))
    (item-type ?world ?object ?type)
    (%grasp-of-type ?type ?grasp)
    (robot ?robot)
    (arm ?robot ?side))

  (<- (valid-grasp ?world ?object ?grasp ?sides)
    (object-grasp ?world ?object ?grasp ?sides))

  (<- (valid-grasp ?world ?object ?grasp (?side))
    (not (object-grasp ?world ?object ?_ ?_))
    (robot ?robot)
    (grasp ?robot ?grasp)
    (side ?robot ?side))

  (<- (reachable ?world ?robot ?object)
    (once (reachable ?world ?robot ?object ?)))

  (<- (reachable ?world ?robot ?object ?side)
    (%object ?world ?object ?instance)
    (lisp-fun middle ?instance ?point)
    (point-reachable ?world ?robot ?point ?side))

  (<- (point-reachable ?world ?robot ?point)
    (once (point-reachable ?world ?robot ?point ?)))

  (<- (point-reachable ?world ?robot ?point ?side)
    (%object ?world ?robot ?instance)
    (arm ?robot ?side)
    (lisp-fun ensure-vector ?point ?vector)
    (lisp-pred reaching-postures ?instance ?side ?vector))

  (<- (pose-reachable ?world ?robot ?pose)
    (once (pose-reachable ?world ?robot ?pose ?)))

  (<- (pose-reachable ?world ?robot ?pose ?side)
    (%object ?world ?robot ?instance)
    (arm ?robot ?side)
    (lisp-fun ensure-pose ?pose ?goal)
    (lisp-pred reaching-joints ?instance ?side ?goal))

  (<- (blocking ?world ?robot ?object ?names)
    (once (blocking ?world ?robot ?object ? ?names)))

  (<- (blocking ?world ?robot ?object ?side ?names)
    (%object ?world ?robot ?instance)
    (%object ?world ?object ?thing)
    (arm ?robot ?side)
    (lisp-fun touched-while-reaching ?world ?instance ?thing ?side ?names)
    (not (== ?names :unreachable))))
