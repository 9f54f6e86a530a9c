(in-package :barista-plans)

(defun drive-to (?goal &key (?speed 1.0))
  (perform (a motion (type going) (to ?goal) (speed ?speed))))

(defun look-for (?object)
  (with-failure-handling
      ((bc:cup-not-found (failure)
         (report "no ~(~a~)" (bc:cup-not-found-name failure))
         (cpl:fail 'bc:barista-failure :description "nothing to fetch")))
    (perform (a motion (type looking) (for ?object)))))

(def-cram-function fetch (?object ?arm)
  "Drive beside ?OBJECT and take it with ?ARM."
  (let* ((?seen (look-for ?object))
         (?location (location-near (thing-pose (reference ?seen)))))
    (with-retry-counters ((slips 2) (places 3))
      (with-failure-handling
          ((bc:cannot-reach (failure)
             (report "~a" failure)
             (do-retry slips
               (retry))
             (do-retry places
               (setf ?location (next-solution ?location))
               (when ?location (retry))))
           (cpl:simple-plan-failure (failure)
             (report "given up: ~a" (type-of failure))))
        (drive-to ?location)
        (perform (desig:a motion (type gripping) (arm ?arm) (object ?seen)))))
    (report "took ~(~a~) with the ~(~a~) arm" (thing-name (reference ?seen)) ?arm)
    ?seen))

(defun location-near (pose)
  (make-designator :location `((:near ,(cl-transforms:origin pose)) (:distance 1) (:side (:x :negative)))))

(def-cram-function serve (?object ?location)
  (let* ((?fetched (perform (let ((?what ?object)) (an action (type fetching) (object ?what)))))
         (?arm (car (rassoc (reference ?fetched) (value *held*))))
         (?pose (reference ?location)))
    (unwind-protect
         (progn
           (pursue
             (drive-to ?pose :?speed 2.0)
             (seq
               (wait-for (cpl:not (fl-member ?arm)))
               (cpl:fail 'bc:barista-failure :description "lost it on the way")))
           (perform (a motion (type releasing) (arm ?arm) (object ?fetched) (place ?pose))))
      (report "hands: ~a" (length (value *held*))))
    (reference ?fetched)))

(defun fl-member (arm)
  (fl-funcall (lambda (held) (and (assoc arm held) t)) *held*))

(def-cram-function pour-into (?drink ?object ?amount)
  (with-failure-handling
      ((bc:pour-failed (failure)
         (report "~a; a little less" failure)
         (setf ?amount (/ ?amount 2))
         (retry)))
    (bk:pour ?drink (object-designator-data-thing ?object) ?amount)))

(declaim (inline held-things))
(defun held-things () (mapcar #'cdr (value *held*)))

(def-top-level-cram-function serve-guests (guests)
  "Serve each of GUESTS, lists of a cup, a drink and a place."
  (with-barista
    (loop for (?name ?drink (x y)) in guests
          for ?place = (place x y)
          for ?object = (an object (type cup) (name ?name))
          for ?location = (a location (pose ?place))
          collect (with-failure-handling
                      ((bc:barista-failure (failure)
                         (return (list :failed (princ-to-string failure)))))
                    (perform (an action (type serving) (object ?object) (location ?location)))
                    (perform (an action (type pouring) (object ?object) (drink ?drink) (amount 0.4)))
                    (list ?name (cl-transforms:x (cl-transforms:origin (thing-pose (find-thing ?name)))))))))
