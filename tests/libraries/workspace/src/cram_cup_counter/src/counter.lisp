(in-package #:cram-cup-counter)

(defstruct cup colour (owner nil))

(defun same-colour (one other)
  (string-equal (cup-colour one) (cup-colour other)))

(defun colour-hash (cup)
  (sxhash (string-upcase (cup-colour cup))))

(sb-ext:define-hash-table-test same-colour colour-hash)

(defclass counter ()
  ((lock :initform (bt:make-lock "counter") :reader lock)
   (counts :initform (make-hash-table :test 'same-colour) :reader counts)))

(defun make-counter ()
  (make-instance 'counter))

(defun count-cup (counter cup)
  (bt:with-lock-held ((lock counter))
    (incf (gethash cup (counts counter) 0))))

(defun count-of (counter colour)
  (bt:with-lock-held ((lock counter))
    (gethash (make-cup :colour colour) (counts counter) 0)))

(defun known-colours (counter)
  (sort (loop for cup being the hash-keys of (counts counter) collect (string-downcase (cup-colour cup))) #'string<))

(defun counted-in-parallel (counter cups workers)
  "Counts CUPS by that many WORKERS."
  (let* ((left (copy-list cups))
         (semaphore (bt:make-semaphore))
         (lock (bt2:make-lock :name "cups")))
    (dotimes (worker workers)
      (bt:make-thread (lambda ()
                        (loop for cup = (bt2:with-lock-held (lock) (pop left))
                              while cup
                              do (count-cup counter cup)
                                 (bt:thread-yield))
                        (bt:signal-semaphore semaphore))
                      :name (format nil "worker ~d" worker)))
    (dotimes (worker workers counter)
      (bt:wait-on-semaphore semaphore))))

(defvar *watched* (tg:make-weak-hash-table :test 'eq :weakness :key))

(defun watch (thing note)
  (setf (gethash thing *watched*) note)
  (tg:make-weak-pointer thing))

(defun slots-of (class-name)
  (let ((class (find-class class-name)))
    (c2mop:ensure-finalized class)
    (mapcar #'c2mop:slot-definition-name (c2mop:class-slots class))))
