;;;; Events change the world.

(in-package #:cram-bullet-reasoning-belief-state)

(defun end-effector (arm)
  "The link that holds what ARM grips."
  (let ((solution (cut:lazy-car (prolog `(and (cram-robot-interfaces:robot ?robot)
                                              (cram-robot-interfaces:end-effector-link ?robot ,arm ?link))))))
    (when solution (cut:var-value '?link solution))))

(defmethod cram-occasions-events:on-event btr-attach-object ((event cpoe:object-attached))
  (let* ((name (cpoe:event-object-name event))
         (object (btr:object btr:*current-bullet-world* name))
         (robot (btr:get-robot-object))
         (furniture (btr:get-environment-object))
         (link (end-effector (cpoe:event-arm event))))
    (cond ((null object))
          ((null link) (error "[BTR-BELIEF OBJECT-ATTACHED] Couldn't find robot's EE link."))
          (t
           (when (and furniture (btr:object-attached furniture object))
             (btr:detach-object furniture object))
           (btr:attach-object robot object link :loose (and (btr:object-attached robot object) t))
           (robot-world:remark-seen (btr:name object) nil)))))

(defmethod cram-occasions-events:on-event btr-detach-object ((event cpoe:object-detached))
  (let ((object (btr:object btr:*current-bullet-world* (cpoe:event-object-name event)))
        (link (end-effector (cpoe:event-arm event))))
    (when (and object link)
      (btr:detach-object (btr:get-robot-object) object link)
      (btr::let-fall btr:*current-bullet-world* 5/3 (btr:get-robot-object)) ; as long as (btr:simulate world 10)
      (robot-world:remark-seen (btr:name object) (btr:pose object)))))

(defvar *joint-state-publication* nil "Where the joints of the furniture are told, once they were.")

(defun forget-joint-state-publication ()
  (setf *joint-state-publication* nil))

(roslisp-utilities:register-ros-cleanup-function forget-joint-state-publication)

(defun publish-environment-joint-state (joint-states)
  "Tell ROS, on the topic kitchen/cram_joint_states, where joints of the furniture are: a list of (name position) or (name . position), or
a hash table. Nothing is told while no node runs."
  (let ((states (if (hash-table-p joint-states)
                    (loop for name being the hash-keys of joint-states using (hash-value position) collect (list name position))
                    (loop for (name . position) in joint-states collect (list name (if (consp position) (first position) position))))))
    (when (eq (roslisp:node-status) :running)
      (unless *joint-state-publication*
        (setf *joint-state-publication* (roslisp:advertise "kitchen/cram_joint_states" "sensor_msgs/JointState")))
      (roslisp:publish-msg *joint-state-publication*
        (:stamp :header) (roslisp:ros-time)
        :name (map 'vector #'first states)
        :position (map 'vector (lambda (state) (coerce (second state) 'double-float)) states)))))

(defun move-container (event sign)
  (let* ((furniture (btr:object btr:*current-bullet-world* (or (cpoe:environment-event-object event) :kitchen)))
         (joint (cpoe:environment-event-joint-name event)))
    (when furniture
      (incf (btr:joint-state furniture joint) (* sign (cpoe:environment-event-distance event)))
      (publish-environment-joint-state `((,joint ,(btr:joint-state furniture joint)))))))

(defmethod cram-occasions-events:on-event btr-open-container ((event cpoe:container-opening-event))
  (move-container event 1))

(defmethod cram-occasions-events:on-event btr-close-container ((event cpoe:container-closing-event))
  (move-container event -1))

(defmethod cram-occasions-events:on-event btr-note-name ((event cpoe:object-perceived-event))
  (let ((designator (cpoe:event-object-designator event)))
    (setf (gethash (desig:first-desig designator) *names*) (desig:desig-prop-value designator :name))
    (when (robot-world:looked-on-p)
      (note-place designator))))

(defun note-place (designator)
  "Tell those who look on where an object was seen."
  (let ((pose (second (assoc :pose (desig:desig-prop-value designator :pose)))))
    (when (typep pose 'cl-transforms-stamped:pose-stamped)
      (robot-world:remark-seen (desig:desig-prop-value designator :name)
                               (cram-tf:ensure-pose-in-frame pose cram-tf:*fixed-frame* :use-zero-time t)))))

(defmethod cram-occasions-events:on-event btr-note-motion ((event cpoe:robot-state-changed))
  (btr:timeline-advance btr:*current-timeline*
                        (btr:make-event btr:*current-bullet-world* `(location-change ,(btr:get-robot-name)))))
