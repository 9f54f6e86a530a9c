;;;; The cost functions of the relations.

(in-package #:cram-btr-spatial-relations-costmap)

(defun box-on-floor (thing)
  "(middle-x middle-y length-x length-y) of the box around THING."
  (list (cl-transforms:x (thing-center thing)) (cl-transforms:y (thing-center thing))
        (cl-transforms:x (thing-lengths thing)) (cl-transforms:y (thing-lengths thing))))

(defun make-box-cost (thing)
  "1 above or in THING."
  (robot-world:make-boxes-cost (list (box-on-floor thing))))

(defparameter *rim* 0.06
  "How far from the edge of furniture the middle of a thing is put of which it is not known how large it is, metres.")

(defun make-surface-cost (thing for)
  "1 above THING, where FOR does not stand out over its edge; everywhere above it when it is not furniture, or less than four rims wide."
  (destructuring-bind (middle-x middle-y length-x length-y) (box-on-floor thing)
    (let* ((lengths (lengths-of for))
           (rim (if lengths (/ (size-on-plane (type-of-designator for) lengths) 2) *rim*)))
      (flet ((inside (length) (if (and (furniture-p thing) (> length (* 4 rim))) (- length (* 2 rim)) length)))
        (robot-world:make-boxes-cost (list (list middle-x middle-y (inside length-x) (inside length-y))))))))

(defun make-free-space-cost (padding)
  "0 where the furniture is, and up to PADDING metres around each of its links."
  (let ((furniture (furniture)))
    (robot-world:make-boxes-cost (mapcar (lambda (body) (box-on-floor (thing-of-object furniture (btr::body-link body))))
                                         (btr:rigid-bodies furniture))
                                 padding :invert t)))

(defun make-side-cost (thing side)
  "1 on one side of the middle line of THING, along the axes of the map: front is where x is smaller, left where y is greater."
  (destructuring-bind (axis predicate)
      (ecase side (:front '(:x <)) (:back '(:x >)) (:left '(:y >)) (:right '(:y <)))
    (location-costmap:make-axis-boundary-cost-function
     axis (funcall (if (eq axis :x) #'cl-transforms:x #'cl-transforms:y) (cl-transforms:origin (thing-pose thing)))
     (symbol-function predicate))))

(defun view-direction (thing)
  "The direction (dx dy) in which somebody looks who stands at the nearest edge of what THING stands on."
  (let ((supporter (supporter-of thing)))
    (if (null supporter)
        '(1 0)
        (destructuring-bind (middle-x middle-y length-x length-y) (box-on-floor supporter)
          (let* ((x (- (cl-transforms:x (thing-center thing)) middle-x))
                 (y (- (cl-transforms:y (thing-center thing)) middle-y))
                 (edges (list (list (- (/ length-x 2) x) '(-1 0)) (list (+ (/ length-x 2) x) '(1 0))
                              (list (- (/ length-y 2) y) '(0 -1)) (list (+ (/ length-y 2) y) '(0 1)))))
            (second (first (sort edges #'< :key #'first))))))))

(defun make-relation-cost (thing relation)
  "How well a place is :LEFT-OF, :RIGHT-OF, :BEHIND or :IN-FRONT-OF THING, for somebody at the nearest edge of what THING stands on."
  (destructuring-bind (dx dy) (view-direction thing)
    (destructuring-bind (x y)
        (ecase relation
          (:behind (list dx dy))
          (:in-front-of (list (- dx) (- dy)))
          (:left-of (list (- dy) dx))
          (:right-of (list dy (- dx))))
      (robot-world:make-direction-cost (cl-transforms:x (thing-center thing)) (cl-transforms:y (thing-center thing)) x y))))

(defun make-supporter-cost (thing for)
  "1 above what THING stands on, where FOR does not stand out over its edge; everywhere, when it stands on no furniture."
  (let ((supporter (supporter-of thing)))
    (if supporter (make-surface-cost supporter for) (robot-world:make-boxes-cost '((0 0 1000 1000))))))

(defun ring (relation thing for)
  "A list of the smallest and the largest distance of what is :NEAR to, or :FAR-FROM, THING; FOR is put there."
  (let* ((size (size-on-plane (thing-type thing) (thing-lengths thing)))
         (own (size-on-plane (type-of-designator for) (lengths-of for)))
         (padding (padding-of (thing-type thing)))
         (own-padding (padding-of (type-of-designator for)))
         (mean (/ (+ size own) 2)))
    (ecase relation
      (:near (let ((least (+ (/ size 2) padding own-padding (/ own 2))))
               (list least (+ least mean))))
      (:far-from (let* ((big (max size own)) (small (min size own))
                        (big-padding (if (>= size own) padding own-padding))
                        (small-padding (if (>= size own) own-padding padding))
                        (least (+ (* big 1.5) (* 3 big-padding) small-padding (/ small 2))))
                   (list least (+ least (* 5 mean))))))))

;;; Setting a table.

(defun slots (thing for count)
  "COUNT places (x y) in two rows along the long sides of THING, and how far a place may be from the middle of its slot."
  (destructuring-bind (middle-x middle-y length-x length-y) (box-on-floor thing)
    (let* ((along-x (>= length-x length-y))
           (long (max length-x length-y))
           (deep (min length-x length-y))
           (columns (ceiling count 2))
           (wide (/ long columns))
           (inset (min (/ deep 4) (+ 0.05 (/ (size-on-plane (type-of-designator for) (lengths-of for)) 2)))))
      (list (loop for number below count
                  for (column row) = (multiple-value-list (floor number 2))
                  for far = (* wide (- (+ column 0.5) (/ columns 2)))
                  for near = (* (if (zerop row) -1 1) (- (/ deep 2) inset))
                  collect (if along-x
                              (list (+ middle-x far) (+ middle-y near))
                              (list (+ middle-x near) (+ middle-y far))))
            (if (eq (type-of-designator for) :plate) 0.08 0.1)))))

(defun make-slots-cost (thing for count)
  (destructuring-bind (places radius) (slots thing for count)
    (robot-world:make-slots-cost places radius)))

;;; Heights.

(defun make-height-on (thing for)
  "The height of what is put on THING: of its origin, when it is known what FOR is."
  (location-costmap:make-constant-height-function
   (+ (cl-transforms:z (thing-center thing)) (/ (cl-transforms:z (thing-lengths thing)) 2) (height-above-ground for))))

(defun make-height-in (thing)
  (location-costmap:make-constant-height-function
   (+ (- (cl-transforms:z (thing-center thing)) (/ (cl-transforms:z (thing-lengths thing)) 2)) 0.035)))

(defun make-height-beside (thing for)
  "The height of what is put beside THING: on what THING stands on."
  (let ((supporter (supporter-of thing)))
    (if supporter
        (make-height-on supporter for)
        (location-costmap:make-constant-height-function
         (+ (- (cl-transforms:z (thing-center thing)) (/ (cl-transforms:z (thing-lengths thing)) 2)) (height-above-ground for))))))
