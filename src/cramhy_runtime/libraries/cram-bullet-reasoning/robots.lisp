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

(defun joint-list (robot)
  "A list (name . position) for each joint of ROBOT."
  (loop for joint in (joint-names robot) collect (cons joint (joint-state robot joint))))

(defgeneric joint-states (robot)
  (:documentation "A hash table of the positions of the joints of ROBOT by their names. It is made anew each time.")
  (:method ((robot robot-object))
    (let ((table (make-hash-table :test 'equal)))
      (loop for (joint . position) in (joint-list robot) do (setf (gethash joint table) position))
      table)))

(defun make-joint-state-message (joint-states &key (time-stamp 0))
  "A sensor_msgs/JointState of a list of (name position)."
  (flet ((zeros () (make-array (length joint-states) :initial-element 0.0)))
    (roslisp:make-msg "sensor_msgs/JointState"
                      (:stamp :header) time-stamp
                      :name (map 'vector #'first joint-states) :position (map 'vector #'second joint-states)
                      :velocity (zeros) :effort (zeros))))

(defgeneric set-robot-state-from-joints (joint-states robot)
  (:documentation "Set joints of ROBOT from a list of (name position) or (name . position), from a hash table, or from a message
sensor_msgs/JointState. Joints that it does not have are passed over.")
  (:method ((joint-states hash-table) (robot robot-object))
    (loop for joint being the hash-keys of joint-states using (hash-value position)
          do (robot-world:set-machine-joint robot joint position)))
  (:method ((joint-states roslisp-msg-protocol:ros-message) (robot robot-object))
    (roslisp:with-fields (name position) joint-states
      (map nil (lambda (joint value) (robot-world:set-machine-joint robot joint value)) name position)))
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
  (:documentation "Put ROBOT, and its joints, where the transformer TF says. What TF does not know is warned about; nothing
moves where TF does not know the root of ROBOT.")
  (:method (tf (robot robot-object) &key (reference-frame *fixed-frame*) (timestamp 0.0) only-these-links)
    (flet ((place-of (link)
             (handler-case (lookup-transform tf (or reference-frame "map") link :time timestamp :timeout *tf-default-timeout*)
               (transform-stamped-error (problem)
                 (roslisp:ros-warn (set-robot-state-from-tf) "Failed with transform-stamped-error: ~a" problem)
                 nil))))
      (let* ((base (root-link robot)) (transform (place-of base)))
        (when transform
          (setf (link-pose robot base) (make-pose (translation transform) (rotation transform)))
          (dolist (link (remove base (or only-these-links (moved-links robot)) :test #'equal))
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

(defun calculate-pan-tilt (robot pan-link tilt-link pose
                           &optional pan-axis pan-sign tilt-axis tilt-sign pan-lower pan-upper tilt-lower tilt-upper)
  "A list (pan tilt): the positions of the joints above two links of the neck with which ROBOT looks at POSE, a pose or a point. The second
value is that list as it would be without the limits PAN-LOWER to TILT-UPPER. The axes that look ahead, and their signs, are those of the
description."
  (declare (ignore pan-axis pan-sign tilt-axis tilt-sign))
  (destructuring-bind (pan tilt)
      (robot-world:pan-and-tilt robot pan-link tilt-link (if (typep pose '3d-vector) pose (origin (ensure-pose pose))))
    (flet ((within (value lower upper)
             (cond ((and lower (< value lower)) lower)
                   ((and upper (> value upper)) upper)
                   (t value))))
      (values (list (within pan pan-lower pan-upper) (within tilt tilt-lower tilt-upper)) (list pan tilt)))))

;;; What is held.

(defun link-first (arguments)
  "ARGUMENTS with :LINK before them where they begin with a link: the link is the third argument in CRAM's branch master, and a keyword
argument in devel."
  (if (or (null arguments) (keywordp (first arguments))) arguments (cons :link arguments)))

(defgeneric attach-object (robot object &rest link-loose-grasp)
  (:documentation "Let LINK hold OBJECT, where it is now: (attach-object robot object link) or (attach-object robot object :link link).
:LOOSE: another link, that holds it too, says where it goes. :GRASP: how it is held, for `object-attached' to tell.")
  (:method ((robot robot-object) (object item) &rest link-loose-grasp)
    (destructuring-bind (&key link loose grasp &allow-other-keys) (link-first link-loose-grasp)
      (unless (member link (link-names robot) :test #'equal)
        (error "Link ~a unknown" link))
      (unless (member link (object-attached robot object) :test #'equal)
        (robot-world:attach robot object link :loose loose :grasp grasp)))))

(defgeneric detach-object (robot object &rest link)
  (:documentation "Let OBJECT go, by LINK or by all links. It falls when the world is simulated.")
  (:method ((robot robot-object) (object item) &rest link)
    (destructuring-bind (&key link) (link-first link)
      (robot-world:detach robot object link))))

(defgeneric attached-objects (object)
  (:documentation "A list (name . links) for each object that a robot holds. An item holds nothing.")
  (:method ((robot robot-object)) (robot-world:attachments robot))
  (:method ((item item)) nil))

(defgeneric object-attached (robot object &key loose)
  (:documentation "The links of ROBOT that hold OBJECT, and the grasps of each; with :LOOSE only those that hold it loosely.
Only robots hold objects, and only items are held.")
  (:method ((robot robot-object) (item item) &key loose)
    (let ((grips (remove-if-not (lambda (grip) (or (not loose) (second grip))) (robot-world:grips robot item))))
      (values (mapcar #'first grips) (mapcar #'third grips))))
  (:method ((holder object) (object object) &key loose)
    (declare (ignore loose))
    nil))

(defun detach-all-objects (robot)
  "Let go all that ROBOT holds."
  (loop for (name) in (attached-objects robot)
        do (detach-object robot (object (robot-world:thing-world robot) name))))

;;; The robot and the kitchen of the current world.

;;; CRAM-ROBOT-INTERFACES of the branch devel knows both by their names, which the descriptions on the parameter server say.

(unless (fboundp 'get-robot-name)
  (defun get-robot-name ()
    "The name of the robot that a fact (robot name) tells of, or nil."
    (cdr (assoc '?name (lazy-car (prolog '(robot ?name)))))))

(defun get-robot-object ()
  "The robot in the current world, or nil."
  (object *current-bullet-world* (get-robot-name)))

(defun environment-name ()
  "What the furniture is called: :KITCHEN, where CRAM-ROBOT-INTERFACES has no GET-ENVIRONMENT-NAME that says it."
  (let ((asked (find-symbol "GET-ENVIRONMENT-NAME" '#:cram-robot-interfaces)))
    (if (and asked (fboundp asked)) (funcall asked) :kitchen)))

(defun get-environment-object ()
  "The furniture in the current world, or nil."
  (object *current-bullet-world* (environment-name)))

(defun robot-colliding-objects-without-attached (&optional others)
  "The names of the objects that the robot touches and does not hold, without those in the list OTHERS."
  (let ((robot (get-robot-object)))
    (remove-if (lambda (name) (or (assoc name (attached-objects robot) :test #'equal) (member name others :test #'equal)))
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
