;;;; Searching.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun next-place-apart (location)
  "The next solution of LOCATION that is more than a step away from the current one, or nil."
  (handler-case
      (let ((location (desig:current-desig location)))
        (desig:next-filtered-designator-solution location (cram-tf:make-euclidean-distance-filter (desig:reference location) 0.3)))
    (desig:designator-error () nil)))

(cpl:def-cram-function search-for-object (?object-designator ?search-location &optional (retries 9))
  "Look for an object at the solutions of a location, RETRIES times more than once; when it has one only, from another place each time.
Returns what was seen."
  (let ((?see-from (place-to-see-from ?search-location)))
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
        (with-other-solutions (retries (fd-plans search-for-object)
                               common-fail:navigation-goal-in-collision
                               common-fail:looking-high-level-failure
                               common-fail:perception-low-level-failure)
            ((next-place) (give-up))
          (exe:perform (desig:an action (type navigating) (location ?see-from)))
          (exe:perform (desig:an action (type turning-towards) (target ?search-location)))
          (exe:perform (desig:an action (type detecting) (object ?object-designator))))))))
