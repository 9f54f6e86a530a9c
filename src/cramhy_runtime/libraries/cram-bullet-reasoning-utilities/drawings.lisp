;;;; What shows more than the world has: boxes around objects, hands at poses, and the costmaps of locations.

(in-package #:cram-bullet-reasoning-utilities)

(defun name-of-box (name)
  (let ((box-name (format nil "~a-AABB-BOX" name)))
    (if (symbolp name) (intern box-name (symbol-package name)) box-name)))

(defun spawn-object-aabb-box (name &key (box-name (name-of-box name)) (world *current-bullet-world*))
  "Draw the box along the axes of the room that is around an object, and return its name, BOX-NAME. A box of that name is replaced. It is a
drawing: nothing touches it, and it hides nothing from a camera."
  (let ((box (aabb (or (object world name) (error "There is no object ~s in the world." name)))))
    (when (object world box-name)
      (remove-object world box-name))
    (add-object world :visualization-box box-name
                (cl-transforms:make-pose (bounding-box-center box) (cl-transforms:make-identity-rotation))
                :size (bounding-box-dimensions box))
    box-name))

(defun reached-p (pose arm)
  "Whether ARM reaches a stamped pose; true where nothing can tell."
  (or (null (compute-applicable-methods #'compute-iks (list pose)))
      (and (compute-iks pose :arm arm) t)))

(defun visualize-gripper (pose arm)
  "Show who looks on the gripper of ARM with its tool at POSE, in the room or in a frame, and whether it gets there. Returns that."
  (let* ((robot (or (get-robot-object) (error "There is no robot in the current world.")))
         (in-base (cl-transforms:transform-pose (cl-transforms:transform-inv (cl-transforms:pose->transform (pose robot)))
                                                (ensure-pose pose)))
         (frame (or *robot-base-frame* (progn (cram-tf::set-frames) *robot-base-frame*)))
         (reached (reached-p (cl-transforms-stamped:pose->pose-stamped frame 0.0 in-base) arm)))
    (robot-world:remark-grasp robot in-base reached)
    reached))

;;; Costmaps, as text here, and as pictures for who looks on.

(defun tell-costmap (costmap title)
  "Print what COSTMAP is made of and where it is greatest, and show it."
  (format t "[BTR-UTILS CM] ~a: ~(~{~a~^, ~}~).~%" title
          (or (mapcar #'name-of-function (location-costmap:cost-functions costmap)) '("no cost functions")))
  (handler-case
      (progn
        (location-costmap::%ready costmap)
        (location-costmap:on-visualize-costmap costmap)
        (location-costmap::%remark costmap)
        (let ((point (location-costmap:gen-costmap-sample-point costmap)))
          (format t "[BTR-UTILS CM]   a place of it: ~,2f ~,2f ~,2f~%"
                  (cl-transforms:x point) (cl-transforms:y point) (cl-transforms:z point))))
    (location-costmap:no-cost-functions-registered ()
      (format t "[BTR-UTILS CM]   it has no values of its own~%"))
    (cram-math:invalid-probability-distribution ()
      (format t "[BTR-UTILS CM]   it is 0 everywhere~%"))))

(defun name-of-function (generator)
  (let ((name (location-costmap:generator-name generator)))
    (if (symbolp name) name (type-of name))))

(defun visualize-designator-costmaps (desig)
  "Print the costmaps that the rules give for a location designator, and all of them merged, and show each to who looks on; nil."
  (let* ((goals `(location-costmap:desig-costmap ,desig ?costmap))
         (costmaps (mapcar (lambda (solution) (var-value '?costmap solution)) (force-ll (prolog goals)))))
    (format t "[BTR-UTILS CM] ~d costmap~:p for ~a~%" (length costmaps) desig)
    (loop for costmap in costmaps
          for number from 1
          do (tell-costmap costmap (format nil "costmap ~d" number)))
    (when (rest costmaps)
      (tell-costmap (location-costmap:merge-costmaps costmaps) "all of them"))
    nil))

(defun reset-debug-window ()
  "Nothing: there is no window that could hang, the page shows the world."
  nil)
