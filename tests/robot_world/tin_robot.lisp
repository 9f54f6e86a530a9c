;;;; A robot of tin for tests: its facts are those of the PR2, its process modules only write down what they are told, and fail when a test
;;;; says so. It sees what *THINGS* holds.

(defpackage #:tin-robot
  (:use #:common-lisp #:cram-prolog)
  (:export #:*told* #:*events* #:*failures* #:*things* #:run #:pose #:seen #:forget #:summary))

(in-package #:tin-robot)

(asdf:load-system :cram-mobile-pick-place-plans)
(asdf:load-system :cram-pr2-description)
(asdf:load-system :cram-knowrob-pick-place)

(defvar *told* '() "What the modules were told, the latest first.")
(defvar *times* '() "When they were told it, in virtual time.")
(defvar *events* '() "The classes of the events, the latest first.")
(defvar *failures* '()
  "(COMMAND COUNT FAILURE ARGUMENT...): that many calls of the motion COMMAND with one of the arguments, or any, fail with FAILURE.")
(defvar *things* '() "What is seen: lists of type and name.")
(defvar *held* '() "(OBJECT ARM) of what is held.")

(defun forget ()
  (setf *told* '() *times* '() *events* '() *failures* '() *things* '() *held* '()))

(defun pose (x y z &optional (frame "base_footprint"))
  (cl-transforms-stamped:make-pose-stamped
   frame 0.0 (cl-transforms:make-3d-vector x y z) (cl-transforms:make-identity-rotation)))

(defun seen (type name &optional (pose (pose 0.7 0 0.8)))
  "The designator of an object that was seen."
  (desig:make-designator :object `((:type ,type) (:name ,name)
                                   (:pose ((:pose ,pose)
                                           (:transform ,(cram-tf:pose-stamped->transform-stamped pose "thing")))))))

(defun tell (desig)
  (destructuring-bind (command . arguments) (desig:reference desig)
    (push (cons command arguments) *told*)
    (push (cut:current-timestamp) *times*)
    (cpl:sleep 0.01)
    (let ((failure (assoc command *failures* :test #'string=)))
      (when (and failure (plusp (second failure)) (or (null (cdddr failure)) (intersection (cdddr failure) arguments)))
        (decf (second failure))
        (cpl:fail (third failure) :description "The robot is of tin.")))
    (values command arguments)))

(cpm:def-process-module body (desig) (tell desig))
(cpm:def-process-module hands (desig) (tell desig))
(cpm:def-process-module eyes (desig)
  (tell desig)
  (let* ((wanted (first (cdr (desig:reference desig))))
         (found (loop for (type name) in *things*
                      when (eq type (desig:desig-prop-value wanted :type)) collect (seen type name))))
    (cond ((null found) (cpl:fail 'common-fail:perception-object-not-found :object wanted))
          ((eq (desig:quantifier wanted) :all) found)
          (t (first found)))))

(def-fact-group modules (cpm:matching-process-module cpm:available-process-module)

  (<- (cpm:matching-process-module ?motion ?module)
    (desig:desig-prop ?motion (:type ?type))
    (member (?module . ?types) ((eyes :detecting :inspecting)
                                (hands :opening :closing :gripping :moving-gripper-joint)
                                (body :going :moving-torso :looking :moving-tcp :moving-arm-joints :moving-with-constraints)))
    (member ?type ?types))

  (<- (cpm:available-process-module ?module)
    (member ?module (eyes hands body))))

(def-fact-group belief (cpoe:object-in-hand)

  (<- (cpoe:object-in-hand ?object)
    (cpoe:object-in-hand ?object ?arm))

  (<- (cpoe:object-in-hand ?object ?arm)
    (symbol-value *held* ?held)
    (member (?object ?arm) ?held)))

(defmethod cram-occasions-events:on-event note-event ((event cram-occasions-events:event))
  (push (class-name (class-of event)) *events*))

(defun named (name)
  (find name (desig:get-all-designators)
        :test (lambda (name desig) (and (typep desig 'desig:object-designator) (eq (desig:desig-prop-value desig :name) name)))))

(defmethod cram-occasions-events:on-event hold ((event cpoe:object-attached))
  (push (list (named (cpoe:event-object-name event)) (cpoe:event-arm event)) *held*))

(defmethod cram-occasions-events:on-event let-go ((event cpoe:object-detached))
  (setf *held* (remove (cpoe:event-arm event) *held* :key #'second)))

(defmacro run (&body body)
  "The value of BODY, as a plan, with the robot's modules running."
  `(cpl:top-level
     (cpm:with-process-modules-running (body hands eyes)
       ,@body)))

(defun summary (&optional (told *told*))
  "What was told, from the first on: commands, with the heights of poses."
  (mapcar (lambda (told)
            (cons (first told)
                  (mapcar (lambda (argument)
                            (if (typep argument 'cl-transforms:pose)
                                (/ (round (cl-transforms:z (cl-transforms:origin argument)) 0.001) 1000.0)
                                argument))
                          (rest told))))
          (reverse told)))
