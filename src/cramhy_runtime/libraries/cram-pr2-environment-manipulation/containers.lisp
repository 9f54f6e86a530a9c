;;;; Containers: links of the furniture that a joint moves, and their handles.

(in-package #:cram-pr2-environment-manipulation)

(defun furniture ()
  (or (btr:get-environment-object)
      (error "There is no furniture in the current world. (cram-occasions-events:clear-belief) builds the world anew.")))

(defun link-of (container)
  "The link of the furniture that a designator means by its :URDF-NAME, an object of cl-urdf."
  (let* ((name (or (desig-prop-value (current-desig container) :urdf-name)
                   (error "~a has no :urdf-name, which says what link of the furniture it is." container)))
         (link-name (if (stringp name) name (substitute #\_ #\- (string-downcase name)))))
    (or (gethash link-name (cl-urdf:links (btr:urdf (furniture))))
        (error "The furniture has no link ~a, which is the :urdf-name of ~a. (btr:link-names (btr:get-environment-object)) lists them."
               link-name container))))

(defun joint-of (link)
  "The joint that moves LINK, straight in and out."
  (let ((joint (loop for joint = (cl-urdf:from-joint link) then (cl-urdf:from-joint (cl-urdf:parent joint))
                     while (and joint (eq (cl-urdf:joint-type joint) :fixed))
                     finally (return joint))))
    (cond ((null joint) (error "No joint moves ~a." (cl-urdf:name link)))
          ((eq (cl-urdf:joint-type joint) :prismatic) joint)
          (t (error "Manipulation of revolute joints not implemented.")))))

(defun opening-way (container)
  "The unit vector along which CONTAINER opens, in the frame of the room."
  (let ((joint (joint-of (link-of container))))
    (cl-transforms:rotate (cl-transforms:orientation (btr:link-pose (furniture) (cl-urdf:name (cl-urdf:child joint)))) (cl-urdf:axis joint))))

(defun handle-below (link)
  "The name of the first link below LINK whose name has \"handle\" in it, the nearest first."
  (loop with waiting = (list link)
        while waiting
        do (let ((next (pop waiting)))
             (when (search "handle" (cl-urdf:name next))
               (return (cl-urdf:name next)))
             (setf waiting (append waiting (mapcar #'cl-urdf:child (cl-urdf:to-joints next)))))
        finally (error "~a has no handle." (cl-urdf:name link))))

(defun handle-of (container)
  "The name of the link that is the handle of CONTAINER."
  (handle-below (cl-urdf:child (joint-of (link-of container)))))

(defun handle-pose (container)
  "Where the handle of CONTAINER is now: a stamped pose in the room, or nil for what is no link of the furniture."
  (when (and (desig-prop-value (current-desig container) :urdf-name) (btr:get-environment-object))
    (cl-transforms-stamped:pose->pose-stamped
     (or cram-tf:*fixed-frame* "map") 0.0 (btr:link-pose (furniture) (handle-of container)))))

(def-fact-group places-of-containers (desig-location-prop)

  (<- (container ?object)
    (obj-desig? ?object)
    (desig-prop ?object (:type ?type))
    (desig-prop ?object (:urdf-name ?name))
    (obj-int:object-type-subtype :container ?type))

  (<- (desig-location-prop ?object ?pose)
    (container ?object)
    (lisp-fun handle-pose ?object ?pose)
    (lisp-pred identity ?pose)))

;;; The gripper at a handle. The x axis of a handle's frame points out of the furniture; the bar is along y, and fingers close along z.

(obj-int:def-object-type-to-gripper-transforms :container-prismatic '(:left :right) :handle
  :grasp-translation '(0 0 0)
  :grasp-rot-matrix '((0 0 -1) (0 1 0) (1 0 0))
  :pregrasp-offsets '(0.10 0 0)
  :2nd-pregrasp-offsets '(0.10 0 0)
  :lift-offsets '(0.3 0 0)
  :2nd-lift-offsets '(0.4 0 0))

(obj-int:def-object-type-to-gripper-transforms :container-prismatic '(:left :right) :handle-turned
  :grasp-translation '(0 0 0)
  :grasp-rot-matrix '((0 0 -1) (0 -1 0) (-1 0 0))
  :pregrasp-offsets '(0.10 0 0)
  :2nd-pregrasp-offsets '(0.10 0 0)
  :lift-offsets '(0.3 0 0)
  :2nd-lift-offsets '(0.4 0 0))

(defun along (pose metres way)
  "POSE, moved so many METRES along the unit vector WAY."
  (cl-transforms-stamped:copy-pose-stamped
   pose :origin (cl-transforms:v+ (cl-transforms:origin pose) (cl-transforms:v* way metres))))

(defun poses-of (container arm grasp distance)
  "The poses of ARM, as a list of three lists: on the way to the handle, at it, and after it has moved by DISTANCE; negative is inwards."
  (let* ((handle (handle-of container))
         (base (cram-tf:ensure-pose-in-frame (handle-pose container) cram-tf:*robot-base-frame* :use-zero-time t))
         (way (cl-transforms:rotate (cl-transforms:q-inv (cl-transforms:orientation (btr:pose (btr:get-robot-object))))
                                    (opening-way container)))
         (poses (obj-int:get-object-grasping-poses
                 (intern (substitute #\- #\_ (string-upcase handle)) :keyword) :container-prismatic arm grasp
                 (cram-tf:pose-stamped->transform-stamped base handle)))
         (at-handle (third poses)))
    (list (subseq poses 0 2)
          (list at-handle)
          (list (along at-handle distance way) (along at-handle (+ distance 0.1) way)))))
