;;;; A broadcaster of transforms: it keeps the last transform to each child frame, and publishes all of them again and again.

(in-package #:cram-tf)

(defvar *broadcaster* nil
  "The broadcaster of the plan.")

(defvar *tf-broadcasting-enabled* nil
  "Whether broadcasters publish by themselves.")

(defvar *tf-broadcasting-topic* "tf")

(defvar *tf-broadcasting-interval* 0.1
  "Seconds between two messages.")

(defclass tf-broadcaster ()
  ((publication :initarg :publication :reader publication)
   (interval :initarg :interval :reader interval)
   (transforms :initform (make-hash-table :test 'equal) :reader transforms)
   (stopper :initform nil :accessor stopper))
  (:documentation "Transforms by their child frames, and where they are published."))

(defun make-tf-broadcaster (tf-topic pub-interval-secs)
  "A broadcaster that publishes on TF-TOPIC, every PUB-INTERVAL-SECS seconds once it is started."
  (make-instance 'tf-broadcaster :publication (cl-tf:make-transform-broadcaster :topic tf-topic) :interval pub-interval-secs))

(defgeneric add-transform (broadcaster transform)
  (:documentation "Let BROADCASTER publish TRANSFORM, in place of what it had for that child frame.")
  (:method ((broadcaster tf-broadcaster) transform)
    (setf (gethash (child-frame-id transform) (transforms broadcaster)) transform)))

(defgeneric remove-transform (broadcaster transform)
  (:documentation "Publish no transform to a child frame any more: TRANSFORM is one to it, or its name.")
  (:method ((broadcaster tf-broadcaster) transform)
    (remhash (if (stringp transform) transform (child-frame-id transform)) (transforms broadcaster))))

(defgeneric publish-transforms (broadcaster)
  (:documentation "Publish all transforms of BROADCASTER now, stamped now.")
  (:method ((broadcaster tf-broadcaster))
    (let ((now (roslisp:ros-time)))
      (apply #'cl-tf:send-transforms (publication broadcaster)
             (loop for transform being the hash-values of (transforms broadcaster)
                   collect (copy-transform-stamped transform :stamp now))))))

(defgeneric start-publishing-transforms (broadcaster)
  (:documentation "Publish the transforms of BROADCASTER in the background until `stop-publishing-transforms', where
`*tf-broadcasting-enabled*' says so.")
  (:method ((broadcaster tf-broadcaster))
    (when (and *tf-broadcasting-enabled* (null (stopper broadcaster)))
      (setf (stopper broadcaster)
            (uiop:symbol-call (py:import-module "cramhy_runtime.tf.broadcasting") '#:repeat-beside
                              (publication broadcaster) (interval broadcaster) (lambda () (publish-transforms broadcaster)))))))

(defgeneric stop-publishing-transforms (broadcaster)
  (:documentation "Publish no more by itself.")
  (:method ((broadcaster tf-broadcaster))
    (when (stopper broadcaster)
      (py:call (shiftf (stopper broadcaster) nil)))))

(defun init-broadcaster ()
  "Make the broadcaster of the plan."
  (setf *broadcaster* (make-tf-broadcaster *tf-broadcasting-topic* *tf-broadcasting-interval*)))

(defun destroy-broadcaster ()
  (setf *broadcaster* nil))

(roslisp-utilities:register-ros-init-function init-broadcaster)
(roslisp-utilities:register-ros-cleanup-function destroy-broadcaster)
