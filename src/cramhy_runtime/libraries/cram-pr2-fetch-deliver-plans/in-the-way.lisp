;;;; Things in the way: what stands so near to an object that no hand gets at it is put aside, as a person would. The original gives up there.

(in-package #:cram-pr2-fetch-deliver-plans)

(defparameter *in-the-way* 0.35
  "How near to an object things may be that keep hands from it, metres.")

(defparameter *room-for-a-hand* 0.2
  "How far at least from any other thing something is put aside, metres.")

(defparameter *farthest-aside* 0.6
  "How far from where it stood something is put aside at most, metres.")

(defvar *wanted* ()
  "The names of what the robot is about to take: none of these things is put aside for another of them.")

(defun distance-between (item other)
  (cl-transforms:v-dist (cl-transforms:origin (btr:pose item)) (cl-transforms:origin (btr:pose other))))

(defun loose-p (item)
  "Whether ITEM may be put aside: nothing holds it, and it lies in no drawer."
  (notany (lambda (owner)
            (and owner (btr:object-attached owner item)))
          (list (btr:get-robot-object) (btr:get-environment-object))))

(defun neighbours (item)
  "The names of the things that may keep hands from ITEM and that can be put aside, the nearest first."
  (mapcar #'btr:name
          (sort (btr:find-objects btr:*current-bullet-world*
                                  (lambda (other)
                                    (and (typep other 'btr:item)
                                         (btr:item-types other)
                                         (not (eq other item))
                                         (not (member (btr:name other) *wanted*))
                                         (< (distance-between item other) *in-the-way*)
                                         (loose-p other))))
                #'< :key (lambda (other) (distance-between item other)))))

(defun take-out (names)
  "Put the things of these NAMES where they are in nobody's way."
  (dolist (name names)
    (setf (btr:pose (btr:object btr:*current-bullet-world* name)) (btr:ensure-pose '((0 0 -10) (0 0 0 1))))))

(defun place-without (names item try)
  "A pose of the robot from which ITEM could be taken if the things of these NAMES were not there, or nil. The function TRY fails where it
could not."
  (pr2-proj-reasoning::in-simulation
    (pr2-proj-reasoning::in-world-for-now
      (take-out names)
      (pr2-proj-reasoning::first-possible-pose (poses-around (btr:pose item)) try))))

(defun in-the-way (item try)
  "The names of the things without which ITEM could be taken, and from which pose of the robot: one thing where that is enough, else all that
stand beside it; nil where it could not be taken even then. Two values."
  (let ((names (neighbours item)))
    (loop for some in (append (mapcar #'list names) (when (rest names) (list names)))
          for pose = (place-without some item try)
          when pose
            return (values some pose))))

(defun poses-aside (item stand)
  "Poses at which ITEM would stand upright and as high as now, with room for a hand between it and all other things. First come those that are
near to where it stands, and to the pose STAND of the robot, whose arms are short."
  (let* ((pose (btr:pose item))
         (others (remove item (btr:find-objects btr:*current-bullet-world* (lambda (other) (and (typep other 'btr:item) (btr:item-types other)))))))
    (flet ((moved (metres turn)
             (let ((way (cl-transforms:make-3d-vector (* metres (cos turn)) (* metres (sin turn)) 0)))
               (cl-transforms:copy-pose pose :origin (cl-transforms:v+ (cl-transforms:origin pose) way))))
           (way (one other)
             (cl-transforms:v-dist (cl-transforms:origin one) (cl-transforms:origin other))))
      (let ((poses (loop for metres from 0.1 to *farthest-aside* by 0.05
                         append (loop for turn below 16 collect (moved metres (* turn (/ pi 8)))))))
        (sort (remove-if-not (lambda (pose)
                               (every (lambda (other) (> (way pose (btr:pose other)) *room-for-a-hand*)) others))
                             poses)
              #'< :key (lambda (there) (+ (way there pose) (way there stand))))))))

(defun serves-p (pose name others stand try)
  "Whether the thing of that NAME stays at POSE when it is let go there, and the function TRY then does not fail with the robot at the pose
STAND. The things OTHERS will not be there either."
  (pr2-proj-reasoning::in-world-for-now
    (take-out others)
    (let ((thing (btr:object btr:*current-bullet-world* name)))
      (setf (btr:pose thing) pose)
      (btr:simulate btr:*current-bullet-world* 1)
      (when (pr2-proj-reasoning::same-place-p (btr:pose thing) pose)
        (pr2-proj-reasoning::park-for-now)
        (pr2-proj-reasoning::possible-p (lambda ()
                                          (pr2-proj::drive stand)
                                          (funcall try)))))))

(defun turned-by (pose turn)
  "A stamped POSE in the room, turned about z by so many radians: a hand that took a thing in one way does not reach with it everywhere."
  (cl-transforms-stamped:pose->pose-stamped
   cram-tf:*fixed-frame* 0.0
   (cl-transforms:copy-pose
    pose :orientation (cl-transforms:q* (cl-transforms:axis-angle->quaternion (cl-transforms:make-3d-vector 0 0 1) turn)
                                        (cl-transforms:orientation pose)))))

(defun places-aside (name others stand try)
  "Locations where the thing of that NAME is in nobody's way (see `serves-p'): six at most, a hand's width apart, each turned four ways."
  (let ((poses ()))
    (flet ((apart-p (pose)
             (every (lambda (other) (> (cl-transforms:v-dist (cl-transforms:origin pose) (cl-transforms:origin other)) 0.1)) poses)))
      (pr2-proj-reasoning::in-simulation
        (loop for pose in (poses-aside (btr:object btr:*current-bullet-world* name) stand)
              while (< (length poses) 6)
              do (when (and (apart-p pose) (serves-p pose name others stand try))
                   (push pose poses)))))
    (loop for pose in (nreverse poses)
          append (loop for turn in (list 0.0d0 (/ pi 2) (- (/ pi 2)) pi)
                       collect (let ((?pose (turned-by pose turn)))
                                 (desig:a location (pose ?pose)))))))

(defun put-down-aside (?object places)
  "Put OBJECT, which is held, at the first of PLACES that is reached from where the robot is, else at one that is reached from elsewhere."
  (let* ((here (find-if (lambda (place) (reached-from-here-p ?object place)) places))
         (?stand (when here (place-of-robot)))
         (?place (or here (first places)
                     (failing-as (common-fail:object-undeliverable :object ?object) "Nothing near is free for ~a."
                                 (desig:desig-prop-value ?object :name)))))
    (exe:perform (desig:an action (type delivering) (object ?object) (target ?place) (desig:when ?stand (robot-location ?stand))))))

(defun put-aside (?name places)
  "Take the thing of that name and put it down at one of PLACES; what cannot be put there is dropped at the sink. Returns whether it lies
elsewhere then."
  (let* ((item (btr:object btr:*current-bullet-world* ?name))
         (before (btr:pose item))
         (?type (first (btr:item-types item)))
         (?thing (pr2-proj::seen-object (desig:an object (type ?type) (name ?name)) item)))
    (roslisp:ros-warn (fd-plans fetch) "~a is in the way. It is put aside." ?name)
    (cpl:with-failure-handling
        (((or common-fail:low-level-failure common-fail:high-level-failure desig:designator-error) (failure)
           (roslisp:ros-warn (fd-plans fetch) "~a" failure)
           (when (in-hand-p ?thing) (try-to-drop-at-sink))
           (return)))
      (put-down-aside (exe:perform (desig:an action (type fetching) (object ?thing))) places))
    (not (or (in-hand-p ?thing)
             (pr2-proj-reasoning::same-place-p before (btr:pose (btr:object btr:*current-bullet-world* ?name)))))))

(defun reached-from-here-p (object place)
  "Whether OBJECT, which is held, can be put at PLACE from where the robot is."
  (pr2-proj-reasoning::possible-here-p
   (lambda () (pr2-proj-reasoning:check-placing-collisions (placing nil object place)))))

(defun make-room-for (item try)
  "Put aside what keeps every hand from ITEM, for which the function TRY fails. Returns the pose of the robot from which it can then be
taken as far as is known, or nil where nothing was moved."
  (when (pr2-proj-reasoning::simulated-p)
    (let ((*wanted* (cons (btr:name item) *wanted*)))
      (multiple-value-bind (names pose) (in-the-way item try)
        (loop for (name . others) on names
              for moved = (put-aside name (places-aside name others pose try))
              count moved into count
              finally (return (and (plusp count) pose)))))))
