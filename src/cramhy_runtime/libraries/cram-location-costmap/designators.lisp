;;;; How location designators find places: a generator draws them from the costmap of the designator, and a validator judges those of
;;;; other generators by it.

(in-package #:cram-location-costmap)

(defvar *costmap-valid-solution-threshold* 0.10
  "The validator accepts a place whose value is more than this part of the greatest value of the costmap.")

(defvar *costmaps* (make-hash-table :test #'eq :weakness :key)
  "The costmap of a designator, by the first designator of its chain.")

(defun designator-costmap (designator)
  "The merged costmap of DESIGNATOR, or nil if no rule gives one. It is remembered for the whole chain of the designator."
  (let ((first (first-desig designator)))
    (or (gethash first *costmaps*)
        (let ((solution (lazy-car (prolog `(merged-desig-costmap ,designator ?costmap)))))
          (when solution
            (setf (gethash first *costmaps*) (var-value '?costmap solution)))))))

(defun reset-costmap-cache ()
  "Forget the costmaps of all designators, so that their rules are asked anew."
  (clrhash *costmaps*))

(defun get-cached-costmap (designator)
  "See `designator-costmap'."
  (designator-costmap designator))

(defun get-cached-costmap-maxvalue (costmap)
  "The greatest value of COSTMAP."
  (%map-maximum costmap))

(defmethod desig:reset :after ((designator location-designator))
  (remhash (first-desig designator) *costmaps*))

(defun location-costmap-generator (designator)
  "Poses drawn from the costmap of DESIGNATOR, without end; none without a costmap, or from one that is 0 everywhere."
  (let ((costmap (designator-costmap designator)))
    (when costmap
      (handler-case
          (progn
            (%ready costmap)
            (on-visualize-costmap costmap)
            (%remark costmap)
            (costmap-samples costmap))
        (no-cost-functions-registered () nil)
        (cram-math:invalid-probability-distribution ()
          (ros-warn (location-costmap) "No place fits ~A. ~A" designator (%why-empty costmap))
          nil)))))

(defun in-fixed-frame (pose)
  "POSE in the frame of costmaps, where cram-tf is there to transform it."
  (let ((transform (and (typep pose 'pose-stamped)
                        (not (equal (frame-id pose) (fixed-frame)))
                        (find-package '#:cram-tf)
                        (find-symbol "ENSURE-POSE-IN-FRAME" '#:cram-tf))))
    (if transform
        (funcall transform pose (fixed-frame) :use-zero-time t)
        pose)))

(defun location-costmap-validator (designator pose)
  "Accept a pose whose cell has more than *COSTMAP-VALID-SOLUTION-THRESHOLD* of the greatest value, at a height that the height
generators know."
  (let ((costmap (and (typep pose 'cl-transforms:pose) (designator-costmap designator))))
    (if (null costmap)
        :unknown
        (handler-case
            (let* ((place (origin (in-fixed-frame pose)))
                   (x (x place)) (y (y place)))
              (if (and (%above costmap x y *costmap-valid-solution-threshold*)
                       (or (not (%has-height-generators costmap))
                           (some (lambda (height) (<= (abs (- (z place) height)) *height-tolerance*)) (%heights-at costmap x y))))
                  :accept
                  :reject))
          (no-cost-functions-registered () :unknown)
          (cram-math:invalid-probability-distribution () :maybe-reject)))))

(register-location-generator 20 location-costmap-generator "Poses drawn from the costmap of the designator.")
(register-location-validation-function 20 location-costmap-validator "Accepts what is probable by the costmap of the designator.")
