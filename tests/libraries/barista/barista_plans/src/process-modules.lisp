(in-package :barista-plans)

(def-process-module barista-base (motion)
  (destructuring-bind (command &rest arguments) (reference motion)
    (ecase command
      (drive
       (destructuring-bind (goal &key (speed 1.0)) arguments
         (let* ((start (value *robot-pose*))
                (steps (max 1 (ceiling (btf:pose-distance start goal) speed))))
           (dotimes (i steps)
             (cpl:sleep 1)
             (let ((ratio (/ (1+ i) steps)))
               (setf (value *robot-pose*)
                     (btf:ensure-pose
                      (cl-transforms:v+ (cl-transforms:v* (cl-transforms:origin start) (- 1 ratio))
                                        (cl-transforms:v* (cl-transforms:origin goal) ratio))))))
           (btf:set-base-pose (value *robot-pose*))
           (report "at ~{~,1f~^ ~}" (butlast (btf:pose->list (cl-transforms:origin (value *robot-pose*)))))
           (value *robot-pose*)))))))

(def-process-module barista-eyes (motion)
  (destructuring-bind (command description) (reference motion)
    (declare (ignorable command))
    (cpl:sleep 0.5)
    (let* ((name (desig-prop-value description :name))
           (thing (find-thing name)))
      (setf (value *cups-fluent*) name)
      (make-effective-designator
       description
       :new-properties (copy-alist (properties description))
       :data-object thing))))

(def-process-module barista-hands (motion)
  (destructuring-bind (command arm &optional thing place) (reference motion)
    (cpl:sleep 2)
    (flet ((hold (thing)
             (if thing
                 (setf (value *held*) (acons arm thing (value *held*)))
                 (setf (value *held*) (remove arm (value *held*) :key #'car)))))
      (ecase command
        (close-hand
         (when (plusp *drop-next*)
           (decf *drop-next*)
           (cpl:fail 'bc:cannot-reach :pose (thing-pose thing) :description (format nil "~(~a~) slips" (thing-name thing))))
         (hold thing)
         (on-event (make-instance 'cup-taken :arm arm :object thing)))
        (open-hand
         (hold nil)
         (when place (setf (thing-pose thing) place))
         (on-event (make-instance 'cup-put :arm arm :object thing)))))))

(def-fact-group barista-process-modules (matching-process-module available-process-module)
  (<- (matching-process-module ?motion barista-base) (desig-prop ?motion (:type :going)))
  (<- (matching-process-module ?motion barista-eyes) (desig-prop ?motion (:type :looking)))
  (<- (matching-process-module ?motion barista-hands)
    (or (desig-prop ?motion (:type :gripping)) (desig-prop ?motion (:type :releasing))))
  (<- (available-process-module ?module)
    (member ?module (barista-base barista-eyes barista-hands))
    (not (projection-running ?_))))

(defmacro with-barista (&body body)
  `(with-process-modules-running (barista-base barista-eyes barista-hands)
     ,@body))
