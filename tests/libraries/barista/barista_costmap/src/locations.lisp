(in-package :barista-costmap)

(defvar *costmap-cache* (make-hash-table :test 'eq))

(defun clear-costmap-cache ()
  (clrhash *costmap-cache*))

(defun designator-costmap (designator)
  "The merged costmap of DESIGNATOR, kept; NIL if there is none."
  (let ((key (first-desig designator)))
    (multiple-value-bind (costmap found) (gethash key *costmap-cache*)
      (if found
          costmap
          (setf (gethash key *costmap-cache*)
                (let ((bindings (lazy-car (prolog `(merged-costmap ,key ?costmap)))))
                  (and bindings (var-value '?costmap bindings))))))))

(defun costmap-location-generator (designator)
  (alexandria:when-let ((costmap (designator-costmap designator)))
    (lazy-mapcar (alexandria:compose #'btf:ensure-pose #'identity) (sample-places costmap))))

(register-location-generator 20 costmap-location-generator "Poses from the costmaps of DESIG-COSTMAP.")

(defun costmap-location-validator (designator solution)
  (let ((costmap (and (typep solution 'pose) (designator-costmap designator))))
    (cond ((null costmap) :unknown)
          ((handler-case
               (> (/ (grid-cell (costmap-values costmap) (cl-transforms:x (origin solution)) (cl-transforms:y (origin solution)))
                     (bc:grid-maximum costmap))
                  0.1)
             (bc:out-of-grid () nil))
           :accept)
          (t :reject))))

(register-location-validation-function 20 costmap-location-validator "Is the value great enough?")
