;;;; What CRAM's branch devel has of this system, and master has not. The predicates about a robot have other names in devel, too: what the
;;;; two say is found here under one name.

(in-package #:cram-bullet-reasoning)

(export '(*all-meshes-as-compound* *robot-model-alpha* *mesh-path-whitelist* get-world-objects-pose-info restore-world-poses
          looking-at-object-p looking-at-pose-p looking-in-direction-p object-in-view-p png-from-camera-view
          make-robot-joint-state-msg robot-converged-to-goal-joint-states robot-attached-objects-in-collision find-levels-under-link
          detach-all-from-link get-loose-attached-objects remove-loose-attachment-for link-attached-object-names
          object-name-attached-links get-objects-for-type *static-plane-texture* *static-plane-gray-texture*
          *static-plane-gray-thin-texture* *static-plane-black-inverted-texture* *static-plane-texture-64x64))

;;; The names of predicates.

(macrolet ((named (&rest names)
             "The first of NAMES that CRAM-ROBOT-INTERFACES exports."
             `',(loop for name in names
                      do (multiple-value-bind (symbol status) (find-symbol (string name) '#:cram-robot-interfaces)
                           (when (eq status :external) (return symbol))))))
  (defparameter *neck-links* (named #:robot-neck-links #:robot-pan-tilt-links))
  (defparameter *neck-joints* (named #:robot-neck-joints #:robot-pan-tilt-joints))
  (defparameter *links-of-hands* (named #:hand-link #:gripper-link)))

(def-prolog-handler %neck (bindings ?robot &rest links-and-joints)
  (destructuring-bind (pan-link tilt-link pan-joint tilt-joint) links-and-joints
    (force-ll (prolog `(and (,*neck-links* ,?robot ,pan-link ,tilt-link) (,*neck-joints* ,?robot ,pan-joint ,tilt-joint)) bindings))))

(def-prolog-handler link-of-hand (bindings ?robot ?link)
  (force-ll (prolog `(,*links-of-hands* ,?robot ?_ ,?link) bindings)))

;; Which grasps a type has says CRAM-OBJECT-INTERFACES, which devel has not.
(def-prolog-handler %grasp-of-type (bindings ?type ?grasp)
  (when (eq *links-of-hands* 'cram-robot-interfaces::gripper-link)
    (force-ll (prolog `(,(find-symbol "OBJECT-TYPE-GRASP" '#:cram-object-interfaces) ,?type ,?grasp) bindings))))

;;; Where everything is.

(defun get-world-objects-pose-info (&optional (world *current-bullet-world*))
  "Where all objects are, and how joints stand, for `restore-world-poses'."
  (get-state world))

(defun restore-world-poses (pose-info &optional (world *current-bullet-world*))
  "Put all objects where they were when `get-world-objects-pose-info' was called. No object may have come or gone since then."
  (let ((then (mapcar #'first pose-info)) (now (mapcar #'name (objects world))))
    (when (set-exclusive-or then now :test #'equal)
      (error "[btr:restore-world-poses] The world has other objects now: ~{~s~^, ~}; then it had ~{~s~^, ~}." now then))
    (restore-world-state pose-info world)))

(defun get-objects-for-type (type)
  "The items of the current world that are of TYPE."
  (find-objects *current-bullet-world* (lambda (object) (and (typep object 'item) (member type (item-types object))))))

;;; What a camera looks at. Its picture is as wide and as high as that of `camera'.

(defparameter *half-height* (tan (/ (* 50 pi) 360)) "Half the height of the picture, one metre ahead of the camera.")
(defparameter *half-width* (* 1.6 *half-height*))

(defun in-picture-p (camera-pose point)
  "Whether POINT is in the picture of a camera, whatever stands before it."
  (let* ((local (transform-point (transform-inv (pose->transform (ensure-pose camera-pose))) point))
         (ahead (z local)))
    (and (plusp ahead)
         (<= (abs (x local)) (* ahead *half-width*))
         (<= (abs (y local)) (* ahead *half-height*)))))

(defun part-in-picture (camera-pose object)
  "Which part of the corners of the box around OBJECT, and of its middle, is in the picture of a camera: 0 to 1."
  (let* ((box (aabb object))
         (half (v* (bounding-box-dimensions box) 0.5))
         (points (cons (bounding-box-center box)
                       (loop for right in '(-1 1)
                             append (loop for deep in '(-1 1)
                                          append (loop for up in '(-1 1)
                                                       collect (v+ (bounding-box-center box)
                                                                   (make-3d-vector (* right (x half)) (* deep (y half))
                                                                                   (* up (z half))))))))))
    (/ (count-if (lambda (point) (in-picture-p camera-pose point)) points) (length points))))

(defun looking-at-object-p (world camera-pose object &optional (threshold *visibility-threshold*))
  "Whether THRESHOLD of OBJECT, or more, is in the picture of a camera, even if something hides it."
  (declare (ignore world))
  (>= (part-in-picture camera-pose object) threshold))

(defun object-in-view-p (world camera-pose object &optional threshold)
  "Whether something of OBJECT is in the picture of a camera, even if something hides it. THRESHOLD, in pixels, counts for nothing."
  (declare (ignore world threshold))
  (plusp (part-in-picture camera-pose object)))

(defun looking-at-pose-p (world camera-pose pose &optional threshold)
  "Whether POSE is in the picture of a camera."
  (declare (ignore world threshold))
  (in-picture-p camera-pose (origin (ensure-pose pose))))

(defun looking-in-direction-p (robot camera-frame angle-horizontal angle-vertical direction)
  "Whether DIRECTION, a 3d-vector in the world, is in the picture of the camera, which is that many radians wide and high."
  (let ((local (rotate (q-inv (orientation (link-pose robot camera-frame))) (v* direction (/ (v-norm direction))))))
    (and (< (abs (asin (max -1 (min 1 (x local))))) (/ angle-horizontal 2))
         (< (abs (asin (max -1 (min 1 (y local))))) (/ angle-vertical 2)))))

(defun png-from-camera-view (&key (camera-pose (make-identity-pose)) robot-camera-view (png-path #p"/tmp/cram.png")
                               (png-width 640) (png-height 480))
  "Write what is seen from CAMERA-POSE, or with ROBOT-CAMERA-VIEW by the camera of the robot, to the PNG file PNG-PATH; returns that."
  (save-picture png-path :camera (if robot-camera-view :robot camera-pose) :width png-width :height png-height)
  png-path)

;;; Joints.

(defun make-robot-joint-state-msg (robot &key (joint-names (joint-names robot)) (time 0))
  "A sensor_msgs/JointState of how joints of ROBOT stand."
  (make-joint-state-message (map 'list (lambda (joint) (list joint (joint-state robot joint))) joint-names) :time-stamp time))

(defun robot-converged-to-goal-joint-states (goal-states delta)
  "Whether no joint of the robot is further than DELTA from where the list GOAL-STATES, of (name position), wants it."
  (let ((robot (get-robot-object)))
    (loop for (joint goal) in goal-states
          always (<= (abs (- (joint-state robot joint) goal)) delta))))

;;; What is held.

(defun detach-all-from-link (robot link)
  "Let go all that LINK of ROBOT holds."
  (dolist (name (link-attached-object-names robot link))
    (detach-object robot (object (world robot) name) :link link)))

(defun link-attached-object-names (robot link)
  "The names of what LINK of ROBOT holds."
  (loop for (name . links) in (attached-objects robot)
        when (member link links :test #'equal) collect name))

(defun object-name-attached-links (robot name)
  "The links of ROBOT that hold the object of that name."
  (cdr (assoc name (attached-objects robot) :test #'equal)))

(defun get-loose-attached-objects (object)
  "The names of the items that hold OBJECT loosely: none, since here only robots and furniture hold something."
  (declare (ignore object))
  nil)

(defun remove-loose-attachment-for (object)
  "Nothing: see `get-loose-attached-objects'."
  (declare (ignore object))
  nil)

(defun robot-attached-objects-in-collision ()
  "What something that the robot holds touches: a list of objects, but for the robot, and what else it holds or holds it; nil if none does."
  (let* ((robot (get-robot-object)) (held (mapcar #'first (attached-objects robot))))
    (loop for name in held
          for item = (object *current-bullet-world* name)
            thereis (remove-if (lambda (other)
                                 (or (eq other robot)
                                     (member (name other) held :test #'equal)
                                     (and (typep other 'robot-object) (object-attached other item))))
                               (find-objects-in-contact *current-bullet-world* item)))))

;;; Furniture.

(defun find-levels-under-link (link)
  "The links below LINK, of CL-URDF, whose names say that things can stand on them: boards, levels, shelves, floors. The last first."
  (let ((levels ()))
    (labels ((descend (link)
               (dolist (joint (cl-urdf:to-joints link) levels)
                 (let ((child (cl-urdf:child joint)))
                   (if (some (lambda (part) (search part (cl-urdf:name child))) '("_board" "_level" "_shelf" "Floor"))
                       (push child levels)
                       (descend child))))))
      (descend link))))

;;; How the original draws: here the page does.

(defvar *all-meshes-as-compound* t "Whether meshes keep their dents: here they do.")
(defvar *robot-model-alpha* 0.7 "How much of a robot's colour is seen.")
(defvar *mesh-path-whitelist* nil "Files of meshes that are looked at: here all are.")
(defvar *static-plane-texture* nil)
(defvar *static-plane-gray-texture* nil)
(defvar *static-plane-gray-thin-texture* nil)
(defvar *static-plane-black-inverted-texture* nil)
(defvar *static-plane-texture-64x64 nil)
