;;;; Looking ahead: a part of a plan is run several times in copies of the world, and then for real with what worked best.

(in-package #:cram-pr2-projection-reasoning)

(defvar *projection-reasoning-enabled* nil
  "Whether `with-projected-task-tree' looks ahead. In a simulation it never does.")

(defun driving-distance (designators)
  "How far, in metres, the robot drives along those of DESIGNATORS that are places: a cost."
  (loop with here = (cl-transforms:origin (btr:pose (btr:get-robot-object)))
        for designator in designators
        when (typep designator 'desig:location-designator)
          sum (let ((there (cl-transforms:origin (desig:reference designator))))
                (prog1 (sqrt (+ (expt (- (cl-transforms:x there) (cl-transforms:x here)) 2)
                                (expt (- (cl-transforms:y there) (cl-transforms:y here)) 2)))
                  (setf here there)))))

(defun begun-anew (designator run)
  "DESIGNATOR for the run of this number: each begins with another solution, as long as there are any."
  (let ((current (desig:current-desig designator)))
    (or (and (plusp run) (handler-case (desig:next-solution current) (desig:designator-error () nil)))
        current)))

(defun projected-run (function designators cost-function)
  "Run FUNCTION in a copy of the world. Two values: the designators as they are then, and what they cost; nil if the run fails."
  (let ((world (btr:copy-world btr:*current-bullet-world*)))
    (handler-case
        (progn
          (btr:with-current-bullet-world world
            (pr2-proj:with-simulated-robot (apply function designators)))
          (let ((after (mapcar #'desig:current-desig designators)))
            (values after (funcall cost-function after))))
      (cpl:plan-failure (failure)
        (roslisp:ros-info (projection reasoning) "A run ahead failed: ~a" failure)
        nil))))

(defun best-projected-designators (function designators runs cost-function)
  "The designators of the cheapest of so many RUNS of FUNCTION, which takes them; those given, when no run succeeds."
  (let ((best designators) (least nil))
    (dotimes (run runs best)
      (multiple-value-bind (after cost)
          (projected-run function (mapcar (lambda (designator) (begun-anew designator run)) designators) cost-function)
        (when (and after (or (null least) (< cost least)))
          (setf best after least cost))))))

(defmacro with-projected-task-tree (designators number-of-projections cost-function &body body)
  "Do BODY. Where `*projection-reasoning-enabled*' is true and the robot is a real one, BODY is first run so many times in copies of the
world; DESIGNATORS, a list of variables, then have the solutions of the run for which COST-FUNCTION, of the list of them, is least."
  (let ((function (gensym "BODY")))
    `(flet ((,function ,designators ,@body))
       (if (or (simulated-p) (not *projection-reasoning-enabled*))
           (,function ,@designators)
           (apply #',function
                  (best-projected-designators #',function (list ,@designators) ,number-of-projections ,cost-function))))))
