;;;; Costmaps: two-dimensional arrays of numbers, how they are made, mixed and drawn.

(in-package #:courier-costmap)

(defstruct (costmap (:constructor %make-costmap (cells)) (:predicate costmap-p))
  (cells nil :type (array t (* *))))

(defmacro do-cells ((x y map &optional result) &body body)
  (once-only (map)
    `(dotimes (,y (map-height ,map) ,result)
       (dotimes (,x (map-width ,map))
         ,@body))))

(defun make-costmap (width height &key (initial 0) function)
  (let ((map (%make-costmap (make-array (list height width) :initial-element initial))))
    (when function
      (do-cells (x y map) (setf (value-at map x y) (funcall function x y))))
    map))

(defun map-width (map) (array-dimension (costmap-cells map) 1))
(defun map-height (map) (array-dimension (costmap-cells map) 0))

(declaim (inline value-at))
(defun value-at (map x y) (aref (costmap-cells map) y x))
(defun (setf value-at) (value map x y) (setf (aref (costmap-cells map) y x) value))

(defmacro cell (map point)
  "A place, through a macro."
  `(value-at ,map (point-x ,point) (point-y ,point)))

(defun row (map y)
  "Row Y as a vector that shares the map's memory."
  (make-array (map-width map) :displaced-to (costmap-cells map) :displaced-index-offset (* y (map-width map))))

(defun merge-costmaps (function &rest maps)
  (let ((first (first maps)))
    (assert (every (lambda (map) (and (= (map-width map) (map-width first)) (= (map-height map) (map-height first)))) maps)
            () "The maps differ in size: ~{~D x ~D~^, ~}."
            (loop for map in maps collect (map-width map) collect (map-height map)))
    (make-costmap (map-width first) (map-height first)
                  :function (lambda (x y) (apply function (mapcar (lambda (map) (value-at map x y)) maps))))))

(defun normalize (map)
  (let ((sum (loop for index below (array-total-size (costmap-cells map)) sum (row-major-aref (costmap-cells map) index))))
    (if (zerop sum)
        (error "Invalid costmap: the sum of its cells is zero.")
        (merge-costmaps (lambda (value) (/ value sum)) map))))

(defun gaussian (center width)
  "A function of x and y, highest at CENTER."
  (lambda (x y) (exp (- (/ (expt (distance center (make-point x y)) 2) (* 2 width width))))))

(defun hottest (map)
  (let (best where)
    (do-cells (x y map (values where best))
      (when (or (null best) (> (value-at map x y) best))
        (setf best (value-at map x y) where (make-point x y))))))

(defun sample (map)
  "A point by chance, likelier where values are higher."
  (let ((total 0))
    (do-cells (x y map) (incf total (value-at map x y)))
    (let ((wanted (* total (/ (roll 1000) 1000))))
      (do-cells (x y map)
        (when (minusp (decf wanted (value-at map x y)))
          (return-from sample (make-point x y)))))))

(defparameter *neighbourhoods*
  (make-array '(2 4 2) :initial-contents '(((1 0) (0 1) (-1 0) (0 -1)) ((1 1) (-1 1) (-1 -1) (1 -1)))))

(defun neighbours (map x y &key diagonal)
  (loop for kind from 0 to (if diagonal 1 0)
        nconc (loop for i below (array-dimension *neighbourhoods* 1)
                    for nx = (+ x (aref *neighbourhoods* kind i 0))
                    for ny = (+ y (aref *neighbourhoods* kind i 1))
                    if (and (array-in-bounds-p (costmap-cells map) ny nx) (not (blocked-p map nx ny)))
                      collect (list nx ny))))

(defun blocked-p (map x y) (eq (value-at map x y) :blocked))

(defun block-cells (map &rest corners)
  "Block the rectangles (x1 y1 x2 y2) of CORNERS."
  (loop for (x1 y1 x2 y2) in corners
        do (loop for x from x1 to x2
                 do (loop for y from y1 to y2
                          do (setf (value-at map x y) :blocked))))
  map)

(defun draw (map &key (stream *standard-output*) (legend " .:-=+*#%@") marks)
  "Draw MAP with one character a cell; MARKS is an alist from (x y) to a character."
  (let* ((highest (loop for y below (map-height map)
                        maximize (loop for value across (row map y) when (realp value) maximize value)))
         (top (1- (length legend))))
    (loop for y downfrom (1- (map-height map)) to 0
          do (format stream "~&~2D " y)
             (loop for x below (map-width map)
                   for value = (value-at map x y)
                   do (write-char (cond ((cdr (assoc (list x y) marks :test #'equal)))
                                        ((eq value :blocked) #\X)
                                        ((zerop highest) #\.)
                                        (t (char legend (round (* top value) highest))))
                                  stream))
             (terpri stream))
    (format stream "~&   ~{~D~}~%" (loop for x below (map-width map) collect (mod x 10)))))

(defmacro define-costmap (name (&rest parameters) (&key (width 12) (height 8) (mix '#'+)) &body layers)
  "A function NAME of PARAMETERS that adds LAYERS, each a function of x and y."
  `(defun ,name ,parameters
     (merge-costmaps ,mix ,@(loop for layer in layers
                                  collect `(make-costmap ,width ,height :function ,layer)))))
