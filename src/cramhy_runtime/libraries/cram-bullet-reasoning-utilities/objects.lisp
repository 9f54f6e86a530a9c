;;;; Objects by their names.

(in-package #:cram-bullet-reasoning-utilities)

(def-fact-group scenario-objects-database (scenario-objects-init-pose scenario-objects-default-color scenario-object-color
                                   scenario-object-shape scenario-object-extra-attributes)
  (<- (scenario-objects-init-pose ((2 0 0) (0 0 0 1))))
  (<- (scenario-objects-default-color (0.5 0.5 0.5)))
  (<- (scenario-object-color ?scenario ?type ?color)
    (once (or (color-of-kind ?type ?color)
              (scenario-objects-default-color ?color))))
  (<- (color-of-kind :plate (0.8 0.58 0.35)))
  (<- (color-of-kind :fork (0.2 0.1 0.3)))
  (<- (color-of-kind :knife (0.5 0 0)))
  (<- (color-of-kind :mug (0.8 0.3 0)))
  (<- (color-of-kind :pot (0.1 0.2 0.3)))
  (<- (color-of-kind :bowl (0 0.3 0)))
  (<- (color-of-kind :mondamin (0.5 0.1 0)))
  (<- (color-of-kind :spatula (0.1 0.1 0.1)))
  (<- (scenario-object-shape ?type :mesh))
  (<- (scenario-object-extra-attributes ?scenario ?type (:mesh ?type))
    (once (and (bagof ?shape (scenario-object-shape ?type ?shape) ?shapes)
               (== ?shapes (:mesh))))))

(def-fact-group bullet-reasoning-utilities ()
  (<- (assert-object-pose ?name ?pose)
    (bullet-world ?world)
    (assert ?world (object-pose ?name ?pose)))

  (<- (assert-object-pose-on ?name ?location)
    (bullet-world ?world)
    (current-designator ?location ?current)
    (desig-reference ?current ?pose)
    (-> (and (desig-prop ?current (:for ?)) (not (desig-prop ?current (:pose ?))))
        (assert ?world (object-pose ?name ?pose)) ; a place for something is already as high as its origin is to be
        (assert ?world (object-pose-on ?name ?pose)))))

(defun answer (variable goal)
  "The value of VARIABLE in the first solution of GOAL, or nil."
  (cdr (assoc variable (lazy-car (prolog goal)))))

(defun last-answer (variable goal)
  "The value of VARIABLE in the last solution of GOAL, or nil: what a program states comes after what is stated here."
  (cdr (assoc variable (first (last (force-ll (prolog goal)))))))

(defun color-of (type)
  (last-answer '?color `(scenario-object-color ?_ ,type ?color)))

(defun init-pose ()
  (answer '?pose '(scenario-objects-init-pose ?pose)))

(defun object-instance (name)
  "The object of that name in the current world, or nil."
  (object *current-bullet-world* name))

(defun object-pose (name)
  "Where the object of that name is: a pose in the room."
  (pose (object-instance name)))

(defun object-exists (name)
  "Whether there is an object of that name."
  (and (object-instance name) t))

(defun item-exists (name)
  "Whether there is an object of that name that is neither robot nor furniture."
  (typep (object-instance name) 'item))

(defgeneric spawn-object (name type &key pose color mass world)
  (:documentation "Put an object of TYPE into the world, and return it. One of that name that is there already is moved to POSE, if one is given.")
  (:method (name type &key pose color (mass 0.2) (world *current-bullet-world*))
    (cond ((not (object world name))
           (let ((shape (last-answer '?shape `(scenario-object-shape ,type ?shape))))
             (apply #'add-object world shape name (or pose (init-pose)) :mass mass :color (or color (color-of type))
                    (last-answer '?more `(scenario-object-extra-attributes ?_ ,type ?more)))))
          (pose
           (prolog `(assert ,world (object-pose ,name ,pose)))))))

(defun move-object (name &optional (new-pose (init-pose)))
  "Put an object somewhere else."
  (prolog `(assert ?world (object-pose ,name ,new-pose))))

(defun translate-object (name &optional (x 0.0) (y 0.0) (z 0.0))
  "Move an object by so many metres along the axes of the room."
  (let ((pose (object-pose name)))
    (move-object name (cl-transforms:copy-pose
                       pose :origin (cl-transforms:v+ (cl-transforms:origin pose) (cl-transforms:make-3d-vector x y z))))))

(defun kill-object (name)
  "Take an object out of the world."
  (remove-object *current-bullet-world* name))

(defun kill-all-objects ()
  "Take all objects that have a type out of the world; robot, furniture, planes and boxes stay."
  (dolist (item (find-objects *current-bullet-world* (lambda (thing) (and (typep thing 'item) (item-types thing)))))
    (kill-object (name item))))

(defun respawn-object (object)
  "Take an object out, and put one like it where it was."
  (let ((name (name object)) (types (item-types object)) (pose (pose object)))
    (kill-object name)
    (add-object *current-bullet-world* :mesh name pose :mesh (first types) :types types)))
