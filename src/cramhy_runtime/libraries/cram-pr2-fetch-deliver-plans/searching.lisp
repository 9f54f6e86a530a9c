;;;; Searching.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun next-place-apart (location)
  "The next solution of LOCATION that is more than a step away from the current one, or nil."
  (handler-case
      (let ((location (desig:current-desig location)))
        (desig:next-filtered-designator-solution location (cram-tf:make-euclidean-distance-filter (desig:reference location) 0.3)))
    (desig:designator-error () nil)))

(defparameter *least-before-container* 0.25
  "How near before what it looks at the robot may stand, metres.")

(defparameter *most-before-container* 0.8
  "How far before it that helps to look over the front of a container, metres.")

(defun place-above (location)
  "Where the robot stands as near as it can before a drawer that LOCATION is in, to look over its front: a location designator; nil for
what is in no drawer, and where it cannot stand there."
  (when (eq (container-type location) :drawer)
    (let* ((way (pr2-em::opening-way (desig:current-desig (desig:desig-prop-value location :in))))
           (there (cl-transforms:origin (desig:reference location)))
           (turn (cl-transforms:axis-angle->quaternion (cl-transforms:make-3d-vector 0 0 1)
                                                       (atan (- (cl-transforms:y way)) (- (cl-transforms:x way)))))
           (?pose (pr2-proj-reasoning::first-free-pose
                   (loop for metres from *least-before-container* to *most-before-container* by 0.05
                         for origin = (cl-transforms:v+ there (cl-transforms:v* way metres))
                         collect (cl-transforms-stamped:make-pose-stamped
                                  cram-tf:*fixed-frame* 0.0 (cl-transforms:copy-3d-vector origin :z 0.0d0) turn)))))
      (when ?pose
        (desig:a location (pose ?pose))))))

(defun raise-torso ()
  "Bring the torso as high as it goes."
  (let ((?height (pr2-proj-reasoning::highest-torso)))
    (exe:perform (desig:a motion (type moving-torso) (joint-angle ?height)))))

(defun look-into-container-or-at (?place-above ?search-location ?see-from)
  "Go to ?PLACE-ABOVE a drawer with the torso up, or, where that is nil, to ?SEE-FROM, and look at ?SEARCH-LOCATION."
  (when ?place-above
    (raise-torso))
  (let ((?place (or ?place-above ?see-from)))
    (exe:perform (desig:an action (type navigating) (location ?place))))
  (exe:perform (desig:an action (type turning-towards) (target ?search-location))))

(defparameter *retries-with-torso-up* 15
  "How often the robot looks again with its torso up, over what stands before.")

(cpl:def-cram-function search-for-object (?object-designator ?search-location &optional (retries 9))
  "Look for an object at the solutions of a location, RETRIES times more than once, and then with the torso up; when it has one solution only,
from another place each time. Into a drawer the robot looks from above. Returns what was seen."
  (let ((?see-from (place-to-see-from ?search-location))
        (tries 0))
    (flet ((give-up (&optional (description "The object is at none of the places that were searched."))
             (cpl:fail 'common-fail:object-nowhere-to-be-found :object ?object-designator :description description))
           (next-place ()
             (let ((next (next-solution ?search-location)))
               (if next
                   (setf ?search-location next
                         ?see-from (place-to-see-from next))
                   (let ((elsewhere (next-place-apart ?see-from)))
                     (when elsewhere (setf ?see-from elsewhere)))))))
      (cpl:with-failure-handling
          ((desig:designator-error (problem)
             (roslisp:ros-warn (fd-plans search-for-object) "~a" problem)
             (give-up "Search location designator could not be resolved.")))
        (with-other-solutions ((+ retries *retries-with-torso-up*) (fd-plans search-for-object)
                               common-fail:navigation-goal-in-collision
                               common-fail:looking-high-level-failure
                               common-fail:perception-low-level-failure)
            ((progn
               (when (= (incf tries) (1+ retries)) (raise-torso))
               (next-place))
             (give-up))
          (look-into-container-or-at (place-above ?search-location) ?search-location ?see-from)
          (exe:perform (desig:an action (type detecting) (object ?object-designator))))))))
