(in-package :barista-plans)

(defgeneric cup->message (thing &key owner)
  (:method ((thing bk:cup) &key (owner (roslisp-msg-protocol:symbol-code 'barista_msgs-msg:cup :nobody)))
    (declare (ignore owner))
    (roslisp:make-message
     "barista_msgs/Cup"
     (frame_id header) "map"
     name (string-downcase (thing-name thing))
     state (if (plusp (bk:cup-content thing))
               (roslisp-msg-protocol:symbol-code 'barista_msgs-msg:cup :full)
               (roslisp-msg-protocol:symbol-code 'barista_msgs-msg:cup :empty))
     dimensions (vector 0.08 0.08 (bk:cup-volume thing))
     (x position pose pose) (cl-transforms:x (cl-transforms:origin (thing-pose thing)))
     (y position pose pose) (cl-transforms:y (cl-transforms:origin (thing-pose thing)))
     (w orientation pose pose) 1)))

(defun tray-message (things)
  (roslisp:make-msg "barista_msgs/Tray" :cups (map 'vector #'cup->message things) :owner "the house"))

(defmethod message->list ((message barista_msgs-msg:cup))
  (roslisp:with-fields (name state (x (x position pose pose)) dimensions (frame (frame_id header))) message
    (list name state x (coerce dimensions 'list) frame)))

(defmethod message->list ((message barista_msgs-msg:tray))
  (roslisp:with-fields (cups owner) message
    (cons owner (map 'list #'message->list cups))))

(defun watch-trays (&aux (trays (make-fluent :name 'trays)))
  (values trays
          (roslisp:subscribe "/trays" "barista_msgs/Tray"
                             (lambda (message) (setf (value trays) (message->list message)))
                             :max-queue-length 5)))

(roslisp:def-service-callback barista_msgs-srv:Brew (drink strength)
  (report "brewing ~(~a~) of strength ~d" drink strength)
  (roslisp:make-response :ok (<= strength 9) :reason (if (> strength 9) "too strong" "")))

(defun start-brewing ()
  (roslisp:register-service "/brew" 'barista_msgs-srv:Brew))

(defun brew (drink &optional (strength 5))
  (roslisp:with-fields (ok reason) (roslisp:call-service "/brew" "barista_msgs/Brew" :drink (string drink) :strength strength)
    (if (eq ok t) drink (values nil reason))))
