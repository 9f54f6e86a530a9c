;;;; The world that is current, copies of it, and forms that run in one.

(in-package #:cram-bullet-reasoning)

(defvar *current-bullet-world* (robot-world:make-world)
  "The world that functions and predicates mean when none is named.")

(defmacro with-current-bullet-world (world &body body)
  "Run BODY with WORLD as the current one."
  `(let ((*current-bullet-world* ,world)) ,@body))

(defun simulate (world seconds &optional (step 0.1) realtime)
  "Let what is free in WORLD fall for SECONDS, at most as long as Bullet would compute: a sixtieth of a second in each STEP."
  (declare (ignore realtime))
  (let-fall world (/ (ceiling seconds step) 60)))

(defun let-fall (world seconds &optional hand)
  "Let what is free in WORLD fall for SECONDS, or until it lies. The robot HAND does not touch what it has just let go."
  (robot-world:settle world seconds hand)
  (loop for (item other) in (robot-world:stuck-things world)
        do (warn "~s is inside of ~:[the floor~;~:*~s~] and cannot get out of it. It stays where it is: ~
                  (setf (btr:pose object) pose) puts it somewhere else."
                 (robot-world:thing-name item) (and other (robot-world:thing-name other))))
  nil)

(defmacro prolog-?w (&body clauses)
  "The solutions of CLAUSES, in which ?w is the current world."
  (let ((?w (intern "?W")))
    `(prolog (list* 'and (list 'bullet-world ',?w) ',clauses))))

;;; What a world was, to come back to it. As in the original, what a robot holds is not part of that.

(defun get-state (world)
  "Where all things in WORLD are, and how the joints stand."
  (loop for thing in (robot-world:things world)
        collect (list (robot-world:thing-name thing)
                      (robot-world:thing-pose thing)
                      (when (typep thing 'robot-object) (joint-list thing)))))

(defun restore-world-state (state world)
  "Put the things in WORLD where STATE, of `get-state', says."
  (loop for (name pose joints) in state
        for thing = (robot-world:find-thing world name)
        when thing
          do (when joints (set-robot-state-from-joints joints thing))
             (setf (pose thing) pose))
  world)

;;; Goals of Prolog that run in a world of their own.

(defun world-of (variable bindings)
  "The world that VARIABLE is bound to, or the current one."
  (let ((value (var-value variable bindings)))
    (if (is-var value) *current-bullet-world* value)))

(defun solutions-in (world goals bindings)
  "All solutions of GOALS, while WORLD is the current one."
  (let ((*current-bullet-world* world))
    (force-ll (prolog `(and ,@goals) bindings))))

(def-prolog-handler with-world (bindings ?world &rest goals)
  (solutions-in (world-of ?world bindings) goals bindings))

(def-prolog-handler with-stored-world (bindings ?world &rest goals)
  (let* ((world (world-of ?world bindings))
         (state (get-state world)))
    (unwind-protect (solutions-in world goals bindings)
      (restore-world-state state world))))

(def-prolog-handler with-copied-world (bindings ?world &rest goals)
  (let ((copy (copy-world (world-of ?world bindings))))
    (solutions-in copy (if (is-var ?world) (subst copy ?world goals) goals) bindings)))
