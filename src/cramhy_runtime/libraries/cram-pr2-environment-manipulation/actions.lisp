;;;; (an action (type opening) (object a-container) ...) and closing. With :gripper instead of :object they are about a gripper.

(in-package #:cram-pr2-environment-manipulation)

(defun poses-on (side arm container grasp distance)
  "The three lists of poses of the arm on SIDE; three times nil where ARM is another one."
  (if (eq side arm) (poses-of container arm grasp distance) (list nil nil nil)))

(defun joint-name (container)
  (cl-urdf:name (joint-of (link-of container))))

(def-fact-group environment-manipulation (action-grounding)

  (<- (action-grounding ?designator (open-container . ?arguments))
    (spec:property ?designator (:type :opening))
    (container-and-poses ?designator 1 ?arguments))

  (<- (action-grounding ?designator (close-container . ?arguments))
    (spec:property ?designator (:type :closing))
    (container-and-poses ?designator -1 ?arguments))

  (<- (container-and-poses ?designator ?sign (?arm ?opening ?distance ?left-reach ?right-reach ?left-grasp ?right-grasp
                                                   ?left-move ?right-move ?joint ?environment))
    (spec:property ?designator (:object ?object))
    (current-designator ?object ?container)
    (container ?container)
    (desig-prop ?container (:part-of ?environment-name))
    (-> (spec:property ?designator (:arm ?given))
        (equal ?arm ?given)
        (and (cram-robot-interfaces:robot ?robot)
             (cram-robot-interfaces:arm ?robot ?arm)))
    (once (or (spec:property ?designator (:distance ?distance))
              (equal ?distance 0.3)))
    (lisp-fun * ?sign ?distance ?way)
    (member ?grasp (:handle :handle-turned))
    (lisp-fun obj-int:get-object-type-gripper-opening :container-prismatic ?opening)
    (lisp-fun joint-name ?container ?joint)
    (lisp-fun as-keyword ?environment-name ?environment)
    (lisp-fun poses-on :left ?arm ?container ?grasp ?way (?left-reach ?left-grasp ?left-move))
    (lisp-fun poses-on :right ?arm ?container ?grasp ?way (?right-reach ?right-grasp ?right-move))))

(defun as-keyword (name)
  (intern (string-upcase name) :keyword))
