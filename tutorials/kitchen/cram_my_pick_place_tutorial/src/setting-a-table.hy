(require cramhy *)
(in-package :kitchen)

(defparameter *table-top* 0.746d0 "how high the dining table is, in metres")
(defparameter *beside-table* (pose -2.2d0 1.9d0 0 -125) "where the robot stands when it is done")

(defparameter *camera* '((-0.6 -0.5 2.5) (-2.9 0.7 0.6)) "from where the table is seen: the eye, and where it looks")

(def-fact-group table-for-two (seat cover belongs)

  ;; where a guest sits at the table, and in which direction he looks
  (<- (seat :left -3.28d0 -0.33d0 90))
  (<- (seat :right -3.28d0 0.95d0 -90))

  ;; what each guest needs: how far before him it is, how far to his left, and how high its middle is above the table
  (<- (cover :bowl 0.27d0 0 0.04d0))
  (<- (cover :spoon 0.27d0 -0.12d0 0.01d0))
  (<- (cover :cup 0.42d0 0.12d0 0.05d0))

  ;; what belongs on the table, and where: a cover for each guest, and a bottle for both
  (<- (belongs ?type ?pose)
    (seat ?guest ?x ?y ?direction)
    (cover ?type ?ahead ?left ?up)
    (lisp-fun place-before ?x ?y ?direction ?ahead ?left ?up ?pose))
  (<- (belongs :bottle ?pose)
    (lisp-fun pose -3.28d0 0.31d0 0.85d0 ?pose)))

(defun place-before (x y direction ahead left up)
  "The pose on the table that is so far ahead and to the left of a guest."
  (let ((angle (radians direction)))
    (pose (+ x (* ahead (cos angle)) (- (* left (sin angle))))
          (+ y (* ahead (sin angle)) (* left (cos angle)))
          (+ *table-top* up)
          direction)))

(defun what-belongs ()
  "Lists of a type of thing and the pose on the table where one belongs."
  (mapcar (lambda (solution)
            (list (cut:var-value '?type solution) (cut:var-value '?pose solution)))
          (cut:force-ll (prolog '(belongs ?type ?pose)))))

(defun there-p (type pose)
  "Whether a thing of that type is at a pose, or less than five centimetres away from it."
  (some (lambda (thing)
          (and (member type (btr:item-types thing))
               (< (cl-transforms:v-dist (cl-transforms:origin (btr:pose thing)) (cl-transforms:origin pose)) 0.05)))
        (btr:find-objects btr:*current-bullet-world* (lambda (thing) (typep thing 'btr:item)))))

(defun in-hand (type)
  "The designator of a thing of that type which the robot holds, or nil."
  (loop for solution in (cut:force-ll (prolog '(cpoe:object-in-hand ?thing)))
        for thing = (current-desig (cut:var-value '?thing solution))
        when (eq (desig-prop-value thing :type) type)
          return thing))

(defun search-counter (type)
  "Goes to the counter and finds a thing of that type there."
  (go-to *before-counter*)
  (find-thing type *bottle-on-counter*))

(defun bring (type ?place)
  "Brings a thing of that type from the counter, or from the robot's hand, to a place."
  (roslisp:ros-info (kitchen) "Bringing a ~(~a~)." type)
  (deliver (or (in-hand type)
               (fetch (search-counter type)))
           ?place))

(def-fact-group kitchen-actions (action-grounding)

  (<- (action-grounding ?action (bring ?type ?place))
    (desig-prop ?action (:type :bringing))
    (desig-prop ?action (:thing ?type))
    (desig-prop ?action (:to ?place)))

  (<- (action-grounding ?action (set-table))
    (desig-prop ?action (:type :setting))
    (desig-prop ?action (:object :table))))

(defun set-table ()
  "Brings what belongs on the table and is not there yet."
  (get-ready)
  (loop for (?type ?place) in (what-belongs)
        unless (there-p ?type ?place)
          do (perform (an action (type bringing) (thing ?type) (to ?place))))
  (go-to *beside-table*))

(defparameter *dishes*
  '((bowl-1 :bowl 0.2d0 (0.3 0.45 0.8)) (bowl-2 :bowl 0.42d0 (0.9 0.5 0.2))
    (cup-1 :cup 0.62d0 (0.3 0.45 0.8)) (cup-2 :cup 0.78d0 (0.9 0.5 0.2))
    (spoon-1 :spoon 0.95d0 (0.3 0.45 0.8)) (spoon-2 :spoon 1.1d0 (0.9 0.5 0.2))
    (bottle-1 :bottle -0.05d0 (0.2 0.5 0.25)))
  "name, type, place along the counter and colour of what a table for two needs")

(defun lay-out-dishes ()
  "Puts the dishes onto the counter."
  (loop for (name type y color) in *dishes*
        do (btr-utils:spawn-object name type :pose (pose 1.42d0 y 0.96d0) :color color))
  (btr:simulate btr:*current-bullet-world* 100))

(defun set-table-for-two ()
  "Sets the table with the dishes on the counter."
  (with-simulated-robot
    (perform (an action (type setting) (object table)))))
