;;;; Seeing.

(in-package #:cram-pr2-projection)

(defparameter *most-unlike* 0.002
  "How much the lengths of two meshes may differ that look the same, metres.")

(defun lengths-of-mesh (type)
  (let ((size (btr::mesh-dimensions type)))
    (and size (list (cl-transforms:x size) (cl-transforms:y size) (cl-transforms:z size)))))

(defun alike-p (type other)
  "Whether the meshes of two types of objects are equally large: such things are not told apart by looking."
  (let ((lengths (lengths-of-mesh type)) (others (lengths-of-mesh other)))
    (and lengths others (every (lambda (one two) (< (abs (- one two)) *most-unlike*)) lengths others))))

(defun looks-like-p (item type)
  "Whether ITEM is of TYPE, or looks so, as a :CEREAL looks like a :BREAKFAST-CEREAL."
  (let ((types (btr:item-types item)))
    (or (member type types)
        (and types (alike-p (first types) type)))))

(defun visible-items (designator)
  "The items that DESIGNATOR may mean and that the robot sees, in the order of the world."
  (let ((name (desig:desig-prop-value designator :name))
        (type (desig:desig-prop-value designator :type)))
    (btr:find-objects
     btr:*current-bullet-world*
     (lambda (thing)
       (and (typep thing 'btr:item)
            (or (null name) (eq name (btr:name thing)))
            (or (null type) (looks-like-p thing type))
            (robot-world:sees-p (robot) (parts) thing btr:*visibility-threshold*))))))

(defun seen-object (designator item)
  "A copy of DESIGNATOR that says which ITEM it is, and where. Its type is the one that was asked for."
  (let* ((name (btr:name item))
         (frame (substitute #\_ #\- (string-downcase name)))
         (pose (btr-belief:object-pose-in-frame item cram-tf:*robot-base-frame*))
         (told `((:type ,(or (desig:desig-prop-value designator :type) (first (btr:item-types item))))
                 (:name ,name)
                 (:pose ((:pose ,pose) (:transform ,(cram-tf:pose-stamped->transform-stamped pose frame)))))))
    (desig:copy-designator designator :new-description told)))

(defun detect (designator)
  "What the robot sees of what DESIGNATOR means: one object, or all of them."
  (let ((items (visible-items designator)))
    (when (null items)
      (cpl:fail 'common-fail:perception-object-not-found
                :object designator :description (format nil "Could not find object ~a." designator)))
    (case (desig:quantifier designator)
      ((:a :an) (seen-object designator (first items)))
      (:all (mapcar (lambda (item) (seen-object designator item)) items))
      (t (error "[PROJECTION DETECT]: Quantifier can only be a/an or all.")))))
