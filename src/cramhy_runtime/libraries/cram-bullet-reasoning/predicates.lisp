;;;; What Prolog can ask of a world, and change in it. A world that is not bound is the current one.

(in-package #:cram-bullet-reasoning)

(defun poses-near-p (pose other)
  "Whether two poses differ by no more than a centimetre and a hundredth of a radian."
  (and (< (v-dist (origin pose) (origin other)) 0.01)
       (< (abs (nth-value 1 (quaternion->axis-angle (q* (q-inv (orientation pose)) (orientation other))))) 0.01)))

(defun bottom-pose (object)
  "The pose of OBJECT, at the height of its lowest point."
  (let ((pose (pose object)) (box (aabb object)))
    (copy-pose pose :origin (make-3d-vector (x (origin pose)) (y (origin pose))
                                            (- (z (bounding-box-center box)) (/ (z (bounding-box-dimensions box)) 2))))))

(defun world-items (world)
  (find-objects world (lambda (object) (typep object 'item))))

(defun put-object (world type name pose arguments)
  "Add an object, or give one of that name its own pose again: as in the original, POSE counts for new ones only."
  (let ((old (object world name)))
    (if old
        (setf (pose old) (pose old))
        (apply #'add-object world type name pose arguments))))

(defun put-bottom (object pose)
  "Put OBJECT so that its lowest point is at the height of POSE."
  (let ((pose (ensure-pose pose)))
    (setf (pose object) pose)
    (let ((up (- (z (origin pose)) (z (origin (bottom-pose object))))))
      (setf (pose object) (copy-pose pose :origin (v+ (origin pose) (make-3d-vector 0 0 up)))))))

(def-fact-group bullet-world-facts (bullet-world clear-bullet-world simulate simulate-realtime step debug-window debug-costmap)
  (<- (bullet-world ?world)
    (not (bound ?world))
    (lisp-fun get-current-world ?world))

  (<- (bullet-world ?world)
    (bound ?world)
    (lisp-type ?world bt-reasoning-world))

  (<- (bullet-world ?world ?name)
    (bullet-world ?world)
    (object ?world ?name))

  (<- (clear-bullet-world)
    (lisp-fun clear-world ?))

  (<- (clear-bullet-world ?world)
    (not (bound ?world))
    (lisp-fun robot-world:make-world ?world))

  (<- (simulate ?world ?seconds)
    (bullet-world ?world)
    (lisp-fun simulate ?world ?seconds ?))

  (<- (simulate ?world ?seconds ?step)
    (bullet-world ?world)
    (lisp-fun simulate ?world ?seconds ?step ?))

  (<- (simulate-realtime ?world ?seconds)
    (simulate ?world ?seconds))

  (<- (step ?world)
    (step ?world 0.01))

  (<- (step ?world ?seconds)
    (bullet-world ?world)
    (lisp-fun step-simulation ?world ?seconds ?))

  (<- (debug-window ?world)
    (bullet-world ?world)
    (lisp-fun add-debug-window ?world ?))

  (<- (debug-costmap ?costmap)
    (lisp-fun add-costmap-function-object ?costmap ?)))

(defun get-current-world ()
  "The current world; there is always one."
  (or *current-bullet-world* (setf *current-bullet-world* (robot-world:make-world))))

(defun clear-world ()
  "Begin with a world in which there is nothing."
  (setf *current-bullet-world* (robot-world:make-world)))

(def-fact-group bullet-objects (assert retract object %object item-type object-type object-pose pose object-bottom-pose)
  (<- (assert (object ?world ?type ?name ?pose . ?arguments))
    (assert ?world (object ?type ?name ?pose . ?arguments)))

  (<- (assert ?world (object ?type ?name ?pose . ?arguments))
    (bullet-world ?world)
    (lisp-fun put-object ?world ?type ?name ?pose ?arguments ?))

  (<- (assert (object-pose ?world ?name ?pose))
    (assert ?world (object-pose ?name ?pose)))

  (<- (assert ?world (object-pose ?name ?pose))
    (%object ?world ?name ?object)
    (lisp-fun move-to ?object ?pose ?))

  (<- (assert (object-pose-on ?world ?name ?pose))
    (assert ?world (object-pose-on ?name ?pose)))

  (<- (assert (joint-state ?world ?robot ?states))
    (assert ?world (joint-state ?robot ?states)))

  (<- (assert (attached ?world ?robot ?link ?name))
    (assert ?world (attached ?robot ?link ?name)))

  (<- (assert ?world (attached ?robot ?link ?name))
    (%object ?world ?robot ?instance)
    (%object ?world ?name ?object)
    (lisp-fun attach-object ?instance ?object ?link ?))

  (<- (retract ?world (attached ?robot ?link ?name))
    (%object ?world ?robot ?instance)
    (%object ?world ?name ?object)
    (lisp-fun detach-object ?instance ?object ?link ?))

  (<- (retract (attached ?world ?robot ?link ?name))
    (retract ?world (attached ?robot ?link ?name)))

  (<- (assert ?world (object-pose-on ?name ?pose))
    (%object ?world ?name ?object)
    (lisp-fun put-bottom ?object ?pose ?))

  (<- (assert ?world (joint-state ?robot ?states))
    (%object ?world ?robot ?object)
    (lisp-fun set-robot-state-from-joints ?states ?object ?))

  (<- (retract (object ?world ?name))
    (retract ?world (object ?name)))

  (<- (retract ?world (object ?name))
    (object ?world ?name)
    (lisp-fun remove-object ?world ?name ?))

  (<- (object ?world ?name)
    (%object ?world ?name ?))

  (<- (%object ?world ?name ?object)
    (bullet-world ?world)
    (bound ?name)
    (lisp-fun object ?world ?name ?object)
    (lisp-pred identity ?object))

  (<- (%object ?world ?name ?object)
    (bullet-world ?world)
    (not (bound ?name))
    (lisp-fun objects ?world ?objects)
    (member ?object ?objects)
    (lisp-fun name ?object ?name))

  (<- (item-type ?world ?name ?type)
    (%object ?world ?name ?object)
    (lisp-type ?object item)
    (lisp-fun item-types ?object ?types)
    (member ?type ?types))

  (<- (item ?world ?name)
    (%object ?world ?name ?object)
    (lisp-type ?object item))

  (<- (object-type ?world ?name ?type)
    (item-type ?world ?name ?type))

  (<- (object-type ?world ?name ?type)
    (%object ?world ?name ?object)
    (lisp-fun kind-of ?object ?type))

  (<- (object-pose ?world ?name ?pose)
    (not (bound ?pose))
    (%object ?world ?name ?object)
    (lisp-fun pose ?object ?pose))

  (<- (object-pose ?world ?name ?pose)
    (bound ?pose)
    (%object ?world ?name ?object)
    (lisp-fun pose ?object ?is)
    (lisp-fun ensure-pose ?pose ?wanted)
    (lisp-pred poses-near-p ?is ?wanted))

  (<- (pose ?world ?name ?pose)
    (object-pose ?world ?name ?pose))

  (<- (%pose ?object ?pose)
    (lisp-fun pose ?object ?pose))

  (<- (pose ?world ?name ?position ?orientation)
    (object-pose ?world ?name ?pose)
    (lisp-fun origin ?pose ?position)
    (lisp-fun orientation ?pose ?orientation))

  (<- (object-bottom-pose ?world ?name ?pose)
    (%object ?world ?name ?object)
    (lisp-fun bottom-pose ?object ?pose)))

(defun kind-of (object)
  "The class of OBJECT, as a symbol."
  (if (typep object 'item) 'item 'robot-object))

(defun move-to (object pose)
  (setf (pose object) (ensure-pose pose)))

(defun same-place-p (object other)
  "Whether two objects are at the same place, up to 5 mm and 0.15 radians."
  (let ((pose (pose object)) (other-pose (pose other)))
    (and (< (v-dist (origin pose) (origin other-pose)) 0.005)
         (< (angle-between-quaternions (orientation pose) (orientation other-pose)) 0.15))))

(def-fact-group force-dynamic-states (contact object-not-in-collision stable stable-items above below supported-by supporting)
  (<- (contact ?world ?name ?other-name)
    (%object ?world ?name ?object)
    (lisp-fun find-objects-in-contact ?world ?object ?others)
    (member ?other ?others)
    (lisp-fun name ?other ?other-name))

  (<- (contact ?world ?name ?other-name ?link)
    (%object ?world ?name ?object)
    (lisp-fun touching-links ?world ?object ?others)
    (member (?other-name . ?link) ?others))

  (<- (object-not-in-collision ?world ?name)
    (%object ?world ?name ?object)
    (forall (contact ?world ?name ?other)
            (contact-does-not-count ?world ?name ?other)))

  (<- (contact-does-not-count ?world ?name ?other)
    (attached ?world ?other ? ?name))

  (<- (contact-does-not-count ?world ?name ?other)
    (attached ?world ?name ? ?other))

  (<- (contact-does-not-count ?world ?name ?other)
    (lisp-fun disabled-collision-objects ?world ?pairs)
    (or (member (?name . ?other) ?pairs)
        (member (?other . ?name) ?pairs)))

  (<- (copied-world ?world ?copy)
    (lisp-fun copy-world ?world ?copy))

  (<- (object-pose-different ?world ?other-world ?name)
    (bound ?world)
    (bound ?other-world)
    (%object ?world ?name ?object)
    (%object ?other-world ?name ?other)
    (not (lisp-pred same-place-p ?object ?other)))

  (<- (ik-solution-not-in-collision ?world ?robot-name ?joint-states)
    (lisp-fun copy-world ?world ?copy)
    (%object ?copy ?robot-name ?robot)
    (lisp-fun set-robot-state-from-joints ?joint-states ?robot ?_)
    (object-not-in-collision ?copy ?robot-name))

  (<- (ik-solution-not-in-collision ?world ?robot-name ?joint-states :grasping)
    (lisp-fun copy-world ?world ?copy)
    (%object ?copy ?robot-name ?robot)
    (lisp-fun set-robot-state-from-joints ?joint-states ?robot ?_)
    (forall (contact ?copy ?robot-name ?name ?link)
            (or (attached ?copy ?robot-name ?_ ?name)
                (link-of-hand ?robot-name ?link))))

  (<- (stable ?world ?name)
    (%object ?world ?name ?object)
    (lisp-type ?object item)
    (lisp-pred stable-p ?object))

  (<- (stable ?world)
    (bullet-world ?world)
    (lisp-fun world-items ?world ?items)
    (forall (member ?item ?items) (lisp-pred stable-p ?item)))

  (<- (stable-items ?world)
    (stable ?world))

  (<- (above ?world ?name ?other-name)
    (%object ?world ?name ?object)
    (%object ?world ?other-name ?other)
    (not (== ?name ?other-name))
    (lisp-pred above-p ?object ?other))

  (<- (above ?world ?name ?other-name ?link)
    (%object ?world ?name ?object)
    (%object ?world ?other-name ?other)
    (not (== ?name ?other-name))
    (solid-link ?other ?link)
    (lisp-pred above-link-p ?object ?other ?link))

  (<- (below ?world ?name ?other-name)
    (above ?world ?other-name ?name))

  (<- (solid-link ?robot ?link)
    (lisp-type ?robot robot-object)
    (lisp-fun solid-links ?robot ?links)
    (member ?link ?links))

  (<- (below ?world ?name ?other-name ?link)
    (%object ?world ?name ?object)
    (%object ?world ?other-name ?other)
    (not (== ?name ?other-name))
    (solid-link ?other ?link)
    (lisp-pred below-link-p ?object ?other ?link))

  (<- (supporting ?world ?bottom ?top)
    (supported-by ?world ?top ?bottom))

  (<- (supported-by ?world ?top ?bottom)
    (supported-by ?world ?top ?bottom ?))

  (<- (supported-by ?world ?top ?bottom ?link)
    (%object ?world ?top ?object)
    (lisp-fun contacts-with-links ?world ?object ?others)
    (member (?bottom . ?link) ?others)
    (%object ?world ?bottom ?other)
    (lisp-pred rests-on-p ?object ?other ?link)))

(defun above-link-p (object robot link)
  "Whether the middle of OBJECT is as high as that of a link, or higher."
  (>= (z (bounding-box-center (aabb object))) (z (first (robot-world:part-bounds robot link)))))

(defun below-link-p (object robot link)
  "Whether the middle of OBJECT is as low as that of a link, or lower."
  (<= (z (bounding-box-center (aabb object))) (z (first (robot-world:part-bounds robot link)))))

(defun touching-links (world object)
  "A list (name . link) of the objects that touch OBJECT: first with the links of OBJECT at which they do, then with their own."
  (let ((contacts (robot-world:contacts world object)))
    (remove-duplicates
     (append (loop for (nil own-link other nil) in contacts when (and other own-link) collect (cons (name other) own-link))
             (loop for (nil nil other link) in contacts when (and other link) collect (cons (name other) link)))
     :test #'equal :from-end t)))

(defun contacts-with-links (world object)
  "A list (name . link) for each object that touches OBJECT; the link is that of whichever has links."
  (remove-duplicates
   (loop for (nil own-link other link) in (robot-world:contacts world object)
         when other collect (cons (name other) (or link own-link)))
   :test #'equal :from-end t))

(defun rests-on-p (object other link)
  "Whether the middle of OBJECT is above that of OTHER; of the one that has links the middle of LINK counts."
  (flet ((height (thing)
           (z (if (and link (typep thing 'robot-object))
                  (first (robot-world:part-bounds thing link))
                  (bounding-box-center (aabb thing))))))
    (>= (height object) (height other))))

(defun free-arms ()
  "The arms of the robot that hold nothing in the current world."
  (let* ((robot (get-robot-object))
         (holding (and robot (reduce #'append (mapcar #'rest (attached-objects robot))))))
    (loop for solution in (force-ll (prolog '(and (robot ?robot) (arm ?robot ?arm) (end-effector-link ?robot ?arm ?link))))
          unless (member (var-value '?link solution) holding :test #'equal)
            collect (var-value '?arm solution))))

(def-fact-group robot-model (link link-pose joint-state attached available-arms)
  (<- (available-arms ?object ?arms)
    (lisp-fun free-arms ?arms)
    (lisp-pred identity ?arms))

  (<- (link ?world ?robot ?link)
    (%object ?world ?robot ?object)
    (lisp-type ?object robot-object)
    (lisp-fun link-names ?object ?links)
    (member ?link ?links))

  (<- (link-pose ?robot ?link ?pose)
    (link-pose ?world ?robot ?link ?pose))

  (<- (link-pose ?world ?robot ?link ?pose)
    (link ?world ?robot ?link)
    (%object ?world ?robot ?object)
    (lisp-fun link-pose ?object ?link ?pose))

  (<- (joint-state ?world ?robot ?joint ?state)
    (%object ?world ?robot ?object)
    (lisp-type ?object robot-object)
    (lisp-fun joint-list ?object ?states)
    (member (?joint . ?state) ?states))

  (<- (attached ?world ?robot ?link ?name)
    (attached ?world ?robot ?link ?name ?_))

  (<- (attached ?world ?robot ?link ?name ?grasp)
    (%object ?world ?robot ?object)
    (lisp-type ?object robot-object)
    (lisp-fun attached-objects ?object ?attached)
    (member (?name . ?_) ?attached)
    (%object ?world ?name ?item)
    (lisp-fun robot-world:grips ?object ?item ?grips)
    (member (?link ?_ ?grasp) ?grips)))

(defun point-head (robot pan-joint pan tilt-joint tilt)
  (set-robot-state-from-joints `((,pan-joint ,pan) (,tilt-joint ,tilt)) robot))

(def-fact-group bullet-heads (head-pointing-at)
  (<- (head-pointing-at ?world ?robot ?pose)
    (%object ?world ?robot ?object)
    (%neck ?robot ?pan-link ?tilt-link ?pan-joint ?tilt-joint)
    (lisp-fun calculate-pan-tilt ?object ?pan-link ?tilt-link ?pose (?pan ?tilt))
    (lisp-fun point-head ?object ?pan-joint ?pan ?tilt-joint ?tilt ?)))

(defun camera-poses (robot-or-pose world)
  "The poses of the cameras of a robot that it has, by its name; or the pose itself."
  (let ((robot (and (symbolp robot-or-pose) (object world robot-or-pose))))
    (if robot
        (loop for solution in (force-ll (prolog `(camera-frame ,robot-or-pose ?frame)))
              for pose = (link-pose robot (var-value '?frame solution))
              when pose collect pose)
        (and (not (symbolp robot-or-pose)) (list (ensure-pose robot-or-pose))))))

(def-fact-group visibility (visible visible-from occluding-objects occluding-object)
  (<- (visible ?world ?robot ?name)
    (%object ?world ?robot ?machine)
    (lisp-type ?machine robot-object)
    (%object ?world ?name ?object)
    (not (== ?name ?robot))
    (lisp-fun camera-poses ?robot ?world ?cameras)
    (once (and (member ?camera ?cameras)
               (lisp-pred object-visible-p ?world ?camera ?object))))

  (<- (visible-from ?world ?camera-pose ?name)
    (%object ?world ?name ?object)
    (lisp-fun ensure-pose ?camera-pose ?camera)
    (lisp-pred object-visible-p ?world ?camera ?object))

  (<- (occluding-objects ?world ?robot-or-pose ?name ?names)
    (%object ?world ?name ?object)
    (lisp-fun camera-poses ?robot-or-pose ?world (?camera . ?))
    (lisp-fun occluding-objects ?world ?camera ?object ?objects)
    (lisp-fun mapcar name ?objects ?names))

  (<- (occluding-object ?world ?camera-pose ?name ?hiding)
    (occluding-objects ?world ?camera-pose ?name ?names)
    (member ?hiding ?names)))
