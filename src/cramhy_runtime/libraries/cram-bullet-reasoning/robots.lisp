;;;; Robots and furniture: joints, links, and what they hold.

(in-package #:cram-bullet-reasoning)

(defgeneric urdf (robot)
  (:documentation "The description of ROBOT, an object of CL-URDF.")
  (:method ((robot robot-object)) (cl-urdf::robot-of (robot-world:machine-description robot))))

(defun joints-in-file (robot)
  "What `robot-world:description-joints' tells of ROBOT."
  (robot-world:description-joints (robot-world:machine-description robot)))

(defgeneric joint-names (robot)
  (:documentation "The names of the joints of ROBOT that move.")
  (:method ((robot robot-object)) (robot-world:machine-joints robot)))

(defgeneric joint-state (robot name)
  (:documentation "The position of a joint, nil when ROBOT has none of that name.")
  (:method ((robot robot-object) name) (robot-world:machine-joint robot name)))

(defgeneric (setf joint-state) (new-value robot name)
  (:documentation "Set a joint, whatever its limits are. What hangs on it, and what that holds, goes along.")
  (:method (new-value (robot robot-object) name)
    (unless (robot-world:set-machine-joint robot name new-value)
      (error "Joint ~a unknown" name))
    new-value))

(defgeneric joint-states (robot)
  (:documentation "A list (name . position) for each joint of ROBOT.")
  (:method ((robot robot-object))
    (loop for joint in (joint-names robot) collect (cons joint (joint-state robot joint)))))

(defun make-joint-state-message (joint-states &key (time-stamp 0))
  "A sensor_msgs/JointState of a list of (name position)."
  (flet ((zeros () (make-array (length joint-states) :initial-element 0.0)))
    (roslisp:make-msg "sensor_msgs/JointState"
                      (:stamp :header) time-stamp
                      :name (map 'vector #'first joint-states) :position (map 'vector #'second joint-states)
                      :velocity (zeros) :effort (zeros))))

(defgeneric set-robot-state-from-joints (joint-states robot)
  (:documentation "Set joints of ROBOT from a list of (name position) or (name . position). Joints that it does not have are passed over.")
  (:method ((joint-states list) (robot robot-object))
    (loop for (joint . value) in joint-states
          do (robot-world:set-machine-joint robot joint (if (consp value) (first value) value)))))

(defgeneric link-names (robot)
  (:documentation "The names of the links of ROBOT.")
  (:method ((robot robot-object)) (robot-world:machine-links robot)))

(defgeneric links (robot)
  (:documentation "A hash table of the bodies of ROBOT by the names of their links; only links that have shapes are there.")
  (:method ((robot robot-object))
    (let ((table (make-hash-table :test 'equal)))
      (dolist (body (rigid-bodies robot) table)
        (setf (gethash (body-link body) table) body)))))

(defgeneric link-pose (robot name)
  (:documentation "Where a link is in the world, nil when ROBOT has none of that name.")
  (:method ((robot robot-object) name) (robot-world:machine-link robot name)))

(defgeneric (setf link-pose) (new-value robot name)
  (:documentation "Bring a link as near to a pose as the joint above it allows, its limits apart. What hangs on the link goes along.")
  (:method (new-value (robot robot-object) name)
    (unless (robot-world:pull-link robot name (ensure-pose new-value))
      (error "Link ~a unknown" name))
    new-value))

(defgeneric set-robot-state-from-tf (tf robot &key reference-frame timestamp only-these-links)
  (:documentation "Put ROBOT, and its joints, where the transformer TF says. What TF does not know is warned about.")
  (:method (tf (robot robot-object) &key (reference-frame *fixed-frame*) (timestamp 0.0) only-these-links)
    (flet ((place-of (link)
             (handler-case (lookup-transform tf (or reference-frame "map") link :time timestamp :timeout *tf-default-timeout*)
               (transform-stamped-error (problem)
                 (roslisp:ros-warn (set-robot-state-from-tf) "Failed with transform-stamped-error: ~a" problem)
                 nil))))
      (let ((base (root-link robot)))
        (dolist (link (cons base (remove base (or only-these-links (moved-links robot)) :test #'equal)))
          (unless (and only-these-links (not (member link only-these-links :test #'equal)))
            (let ((transform (place-of link)))
              (when transform
                (setf (link-pose robot link) (make-pose (translation transform) (rotation transform)))))))))))

(defun root-link (robot)
  "The link of ROBOT that no joint leads to."
  (loop with children = (mapcar #'fourth (joints-in-file robot))
        for link in (link-names robot)
        unless (member link children :test #'equal) return link))

(defun moved-links (robot)
  "The links of ROBOT that a joint moves, from the root on."
  (loop for (nil type nil child) in (joints-in-file robot)
        unless (eq type :fixed) collect child))

(defun calculate-pan-tilt (robot pan-link tilt-link pose)
  "A list (pan tilt): the positions of the joints above two links of the neck with which ROBOT looks at POSE."
  (robot-world:pan-and-tilt robot pan-link tilt-link (origin (ensure-pose pose))))

;;; What is held.

(defgeneric attach-object (robot object link &key loose)
  (:documentation "Let LINK hold OBJECT, where it is now. LOOSE: another link, that holds it too, says where it goes.")
  (:method ((robot robot-object) (object item) link &key loose)
    (unless (member link (link-names robot) :test #'equal)
      (error "Link ~a unknown" link))
    (unless (member link (object-attached robot object) :test #'equal)
      (robot-world:attach robot object link :loose loose))))

(defgeneric detach-object (robot object &optional link)
  (:documentation "Let OBJECT go, by LINK or by all links. It falls when the world is simulated.")
  (:method ((robot robot-object) (object item) &optional link)
    (robot-world:detach robot object link)))

(defun attached-objects (robot)
  "A list (name . links) for each object that ROBOT holds."
  (robot-world:attachments robot))

(defun object-attached (robot object)
  "The links of ROBOT that hold OBJECT."
  (cdr (assoc (name object) (attached-objects robot) :test #'equal)))

(defun detach-all-objects (robot)
  "Let go all that ROBOT holds."
  (loop for (name) in (attached-objects robot)
        do (detach-object robot (object (robot-world:thing-world robot) name))))

;;; The robot and the kitchen of the current world.

(defun get-robot-name ()
  "The name of the robot that a fact (robot name) tells of, or nil."
  (cdr (assoc '?name (lazy-car (prolog '(robot ?name))))))

(defun get-robot-object ()
  "The robot in the current world, or nil."
  (object *current-bullet-world* (get-robot-name)))

(defun get-environment-object ()
  "The furniture in the current world, whose name is :KITCHEN, or nil."
  (object *current-bullet-world* :kitchen))

(defun robot-colliding-objects-without-attached ()
  "The names of the objects that the robot touches and does not hold."
  (let ((robot (get-robot-object)))
    (remove-if (lambda (name) (assoc name (attached-objects robot) :test #'equal))
               (mapcar #'name (find-objects-in-contact *current-bullet-world* robot)))))

(defun link-contacts (robot)
  "A list (object . link) for each link of ROBOT that touches an object."
  (remove-duplicates
   (loop for (nil link other) in (robot-world:contacts (robot-world:thing-world robot) robot)
         when other collect (cons other link))
   :test #'equal :from-end t))

;;; Programs read some slots of objects by their names.

(defmethod slot-missing (class (object object) slot-name operation &optional new-value)
  (declare (ignore new-value))
  (let ((reader (and (eq operation 'slot-value)
                     (cdr (assoc slot-name '((name . name) (world . robot-world:thing-world) (types . item-types) (urdf . urdf)
                                             (links . links) (joint-states . joint-states) (attached-objects . attached-objects)
                                             (rigid-bodies . rigid-bodies)))))))
    (if reader
        (funcall reader object)
        (call-next-method))))
