;;;; A priority queue: a binary heap in an adjustable vector.

(in-package #:courier-util)

(defstruct (queue (:constructor %make-queue (heap test key))
                  (:print-function (lambda (queue stream depth)
                                     (declare (ignore depth))
                                     (print-unreadable-object (queue stream :type t)
                                       (format stream "of ~D" (queue-size queue))))))
  (heap #() :type (and vector (not simple-array)) :read-only t)
  (test #'< :type function)
  (key #'identity :type function))

(defun make-queue (&key (test #'<) (key #'identity) initial-contents)
  (let ((queue (%make-queue (make-array 8 :adjustable t :fill-pointer 0) test key)))
    (map nil (curry #'queue-push queue) initial-contents)
    queue))

(declaim (inline queue-size queue-empty-p))
(defun queue-size (queue) (fill-pointer (queue-heap queue)))
(defun queue-empty-p (queue) (zerop (queue-size queue)))

(defun before-p (queue i j)
  (let ((heap (queue-heap queue)) (key (queue-key queue)))
    (funcall (queue-test queue) (funcall key (aref heap i)) (funcall key (aref heap j)))))

(defun queue-push (queue thing)
  (with-accessors ((heap queue-heap)) queue
    (vector-push-extend thing heap)
    (do* ((child (1- (length heap)) parent)
          (parent (ash (1- child) -1) (ash (1- child) -1)))
         ((or (zerop child) (not (before-p queue child parent))) thing)
      (rotatef (aref heap child) (aref heap parent)))))

(defun queue-peek (queue &optional default)
  (if (queue-empty-p queue) (values default nil) (values (aref (queue-heap queue) 0) t)))

(defun queue-pop (queue)
  "The first thing and true, or NIL and false."
  (let* ((heap (queue-heap queue)))
    (if (queue-empty-p queue)
        (values nil nil)
        (let ((first (aref heap 0)) (last (vector-pop heap)) (parent 0))
          (unless (queue-empty-p queue)
            (setf (aref heap 0) last)
            (loop named sift
                  for left = (1+ (* 2 parent)) and right = (+ 2 (* 2 parent))
                  for child = (cond ((>= left (length heap)) (return-from sift))
                                    ((and (< right (length heap)) (before-p queue right left)) right)
                                    (t left))
                  while (before-p queue child parent)
                  do (rotatef (aref heap child) (aref heap parent))
                     (setf parent child)))
          (values first t)))))

(defmacro do-queue ((variable queue &optional result) &body body)
  "Take everything out of QUEUE, in order."
  (once-only (queue)
    (with-gensyms (found)
      `(loop (multiple-value-bind (,variable ,found) (queue-pop ,queue)
               (unless ,found (return ,result))
               ,@body)))))
