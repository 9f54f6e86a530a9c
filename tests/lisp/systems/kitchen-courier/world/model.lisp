;;;; The world model: what is where.

(in-package #:courier-world)

(define-condition unknown-object (error)
  ((name :initarg :name :reader unknown-object-name)
   (suggestions :initarg :suggestions :initform nil :reader suggestions))
  (:report (lambda (condition stream)
             (format stream "Nothing is called ~A~@[; is it ~{~A~#[~; or ~:;, ~]~}~]."
                     (unknown-object-name condition) (suggestions condition)))))

(define-condition container-full (error)
  ((container :initarg :container :reader full-container))
  (:report (lambda (condition stream)
             (let ((container (full-container condition)))
               (format stream "~A holds ~D thing~:P and no more." (name container) (capacity container))))))

(defclass world ()
  ((objects :initform (make-hash-table :test #'eq) :reader objects)
   (places :initform (make-hash-table) :reader places)
   (clock :initform 0 :accessor world-clock)
   (notes :initform (make-hash-table :test #'equalp) :reader notes)))

(defvar *world*)
(setf (documentation '*world* 'variable) "The world that functions without a world are about.")

(defun make-world () (make-instance 'world))

(defmacro with-world ((&optional (world '(make-world))) &body body)
  `(let ((*world* ,world)) (values (progn ,@body) *world*)))

(defmacro do-objects ((variable &optional (type t) (world '*world*)) &body body)
  "BODY for each object of TYPE, in the order of their names."
  (with-gensyms (object)
    `(dolist (,object (objects-of ',type ,world))
       (let ((,variable ,object)) ,@body))))

(defun objects-of (type &optional (world *world*))
  (sort (loop for object being each hash-value of (objects world)
              when (typep object type)
                collect object)
        #'string< :key #'name))

(defun similar-names (name)
  (loop for key being the hash-keys in (objects *world*) using (hash-value object)
        when (and (typep object 'thing) (char= (char (string key) 0) (char (string name) 0)))
          collect key into names
        finally (return (sort names #'string<))))

(defun object-named (name &optional (error t))
  (multiple-value-bind (object found) (gethash name (objects *world*))
    (cond (found object)
          (error (restart-case (error 'unknown-object :name name :suggestions (similar-names name))
                   (use-value (other)
                     :report "Take another object."
                     :interactive (lambda () (list (read *query-io*)))
                     (object-named other))
                   (continue () nil)))
          (t nil))))

(defun add-object (object &key in)
  (setf (gethash (name object) (objects *world*)) object)
  (when in (put-into object (if (symbolp in) (object-named in) in)))
  object)

(defun remove-object (object)
  (take-out object)
  (remhash (name object) (objects *world*)))

(defun where-is (object)
  (gethash (name object) (places *world*)))

(defgeneric put-into (object place)
  (:method ((object symbol) place) (put-into (object-named object) place))
  (:method (object (place symbol)) (put-into object (object-named place)))
  (:method :before ((object thing) (place openable))
    (unless (open-p place)
      (cerror "Open it." "~A is closed." (name place))
      (setf (open-p place) t)))
  (:method ((object thing) (place container))
    (when (>= (length (contents place)) (capacity place))
      (error 'container-full :container place))
    (take-out object)
    (push object (contents place))
    (setf (gethash (name object) (places *world*)) place
          (position object) (position place))
    object))

(defun take-out (object)
  (when-let (place (where-is object))
    (setf (contents place) (remove object (contents place)))
    (remhash (name object) (places *world*))
    place))

(defun holds (place &optional (type t))
  (remove-if-not (lambda (object) (typep object type)) (contents place)))

;;; (setf (location-of 'cup) 'table): a setf function; (setf (note "k") v): a short defsetf; CELL and VALUE-AT belong to
;;; the world's own grid of rooms, and quarrel with those of the costmap.

(defun location-of (name)
  (let ((place (where-is (object-named name))))
    (and place (name place))))

(defun (setf location-of) (place name)
  (put-into name place)
  place)

(defun note (key &optional default)
  (gethash key (notes *world*) default))

(defun set-note (key &optional (default nil default-p) (value default))
  (declare (ignore default-p))
  (setf (gethash key (notes *world*)) value))

(defsetf note (key &optional default) (value)
  `(progn ,default (set-note ,key nil ,value)))

(define-modify-macro advance-by (&optional (seconds 1)) +)

(defun advance-clock (&optional (seconds 1) (world *world*))
  (advance-by (world-clock world) seconds))

(defun value-at (room) (format nil "the room ~A" room))
(defun cell (room) (list :room room))
(defun sample () :a-room)

;;; Snapshots are lists; the difference of two says what moved.

(defun snapshot (&optional (world *world*))
  (let ((*world* world))
    (loop for object in (objects-of 'movable)
          collect (list (name object) :in (location-of (name object))
                                      :at (let ((at (position object))) (list (point-x at) (point-y at)))))))

(defun difference (before after)
  (loop for (name . now) in after
        for then = (cdr (assoc name before))
        unless (equal now then)
          collect (destructuring-bind (&key ((:in from)) &allow-other-keys) then
                    (destructuring-bind (&key ((:in to)) at) now
                      (declare (ignore at))
                      (list name from '-> to)))))
