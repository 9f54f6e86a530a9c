;;;; Validators: whether an object that is put at a place of a relation touches others there.

(in-package #:cram-btr-spatial-relations-costmap)

(defun item-for (designator)
  "The item of the current world that a location is for, or nil."
  (let ((for (desig:desig-prop-value designator :for)))
    (and (typep for 'desig:object-designator)
         (btr-belief:get-designator-object (desig:current-desig for)))))

(defun relation-of (designator)
  "One of the four relations beside a thing, and the thing, of a location; nil when it has none."
  (loop for relation in '(:left-of :right-of :in-front-of :behind)
        for object = (desig:desig-prop-value designator relation)
        for thing = (and (typep object 'desig:object-designator) (thing-of object))
        when thing return (list relation thing)))

(defun potential-field-costmap-pose-validator (designator pose)
  "Accept places that lie well in the direction of a relation: nearly straight for what belongs beside a plate."
  (let ((relation (and (typep pose 'cl-transforms:pose) (relation-of designator)))
        (for (desig:desig-prop-value designator :for)))
    (if (not (and relation for))
        :unknown
        (destructuring-bind (relation thing) relation
          (let ((value (funcall (make-relation-cost thing relation)
                                (cl-transforms:x (cl-transforms:origin pose)) (cl-transforms:y (cl-transforms:origin pose)))))
            (if (> value (if (member (type-of-designator for) '(:plate :fork :spoon :knife :cup)) 0.8 0.2))
                :accept
                :reject))))))

(defun collision-pose-validator (designator pose)
  "Accept places at which the item that is put there touches no other item."
  (let ((item (and (typep pose 'cl-transforms:pose)
                   (some (lambda (key) (desig:desig-prop-value designator key)) '(:on :in :left-of :right-of :in-front-of :behind :near :far-from))
                   (item-for designator))))
    (if (null item)
        :unknown
        (let* ((world (btr:copy-world btr:*current-bullet-world*))
               (copy (btr:object world (btr:name item))))
          (setf (btr:pose copy) (btr:ensure-pose pose))
          (if (some (lambda (other) (and (typep other 'btr:item) (btr:item-types other)))
                    (btr:find-objects-in-contact world copy))
              :reject
              :accept)))))

(desig:register-location-validation-function 5 potential-field-costmap-pose-validator "The place lies well on the side that is wanted.")
(desig:register-location-validation-function 6 collision-pose-validator "What is put there touches nothing else.")
