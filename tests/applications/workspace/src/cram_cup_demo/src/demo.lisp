(in-package :cup-demo)

(defparameter *before-counter* (cl-transforms-stamped:make-pose-stamped
                                "map" 0.0 (cl-transforms:make-3d-vector 0.75d0 0.7d0 0.0d0) (cl-transforms:make-identity-rotation)))
(defparameter *before-island* (cl-transforms-stamped:make-pose-stamped
                               "map" 0.0 (cl-transforms:make-3d-vector -0.2d0 1.5d0 0.0d0) (cl-transforms:make-quaternion 0 0 1 0)))

(defmethod exe:generic-perform :before (designator)
  (format t "~%performing ~a" (desig-prop-value designator :type)))

(defun place-cup-on-counter ()
  (btr-utils:kill-all-objects)
  (btr-utils:spawn-object :cup-1 :cup :pose '((1.35 0.6 0.9) (0 0 0 1)) :color '(0 0 1))
  (btr:simulate btr:*current-bullet-world* 50))

(defun go-to (?pose)
  (perform (an action (type going) (target (a location (pose ?pose))))))

(cpl:def-cram-function bring-cup ()
  (json-prolog:prolog-simple "rdf_retractall(_, _, _, cups).")
  (cpl:par
    (perform (an action (type parking-arms)))
    (perform (a motion (type moving-torso) (joint-angle 0.3)))
    (go-to *before-counter*))
  (let* ((?there (cl-transforms-stamped:pose->pose-stamped "map" 0.0 (btr:object-pose :cup-1)))
         (?cup (progn
                 (perform (an action (type looking) (target (a location (pose ?there)))))
                 (perform (an action (type detecting) (object (an object (type cup))))))))
    (perform (an action (type picking-up) (arm (left)) (object ?cup)))
    (perform (an action (type positioning-arm) (left-configuration park) (right-configuration tucked)))
    (go-to *before-island*)
    (let ((?goal (cl-transforms-stamped:make-pose-stamped
                  "map" 0.0 (cl-transforms:make-3d-vector -0.8d0 1.35d0 0.9d0) (cl-transforms:make-identity-rotation))))
      (perform (an action (type placing) (arm left) (object ?cup) (target (a location (pose ?goal))))))
    (perform (an action (type parking-arms) (arms (left))))
    (desig-prop-value ?cup :name)))
