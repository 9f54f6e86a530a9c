;;;; What the designators in a location mean in the current world, and how large it is. Sizes and paddings in metres are the original's.

(in-package #:cram-btr-spatial-relations-costmap)

(defstruct thing
  "An object of the world, or one link of the furniture: its type, its place, and the middle and the lengths of the box around it."
  object link type pose center lengths)

(defun link-name (name)
  "The name of a link as URDF has it: :sink-area-surface is sink_area_surface."
  (if (stringp name) name (substitute #\_ #\- (string-downcase name))))

(defun thing-of-object (object &optional link type)
  (let ((box (if link (robot-world:part-bounds object link)
                 (let ((box (btr:aabb object))) (list (btr:bounding-box-center box) (btr:bounding-box-dimensions box))))))
    (make-thing :object object :link link
                :type (or type (and (typep object 'btr:item) (first (btr:item-types object))))
                :pose (if link (btr:link-pose object link) (btr:pose object))
                :center (first box) :lengths (second box))))

(defun furniture ()
  (or (btr:get-environment-object)
      (error "There is no furniture in the current world. (cram-occasions-events:clear-belief) builds the world anew.")))

(defun thing-of (designator)
  "What an object designator means: a link of the furniture, by its :URDF-NAME, or an item. Nil when there is none."
  (let* ((designator (desig:current-desig designator))
         (urdf-name (desig:desig-prop-value designator :urdf-name)))
    (if urdf-name
        (let ((link (link-name urdf-name)))
          (unless (btr:link-pose (furniture) link)
            (error "The furniture has no link ~a, which is the :urdf-name of ~a." link designator))
          (thing-of-object (furniture) link (desig:desig-prop-value designator :type)))
        (let ((object (or (btr-belief:get-designator-object designator) (item-of-type (desig:desig-prop-value designator :type)))))
          (and object (thing-of-object object))))))

(defun item-of-type (type)
  "The only item of TYPE in the current world, nil when there are none or several."
  (let ((items (btr:find-objects btr:*current-bullet-world*
                                 (lambda (object) (and type (typep object 'btr:item) (member type (btr:item-types object)))))))
    (and items (null (rest items)) (first items))))

(defun furniture-p (thing)
  (and (thing-link thing) t))

(defun lengths-of (designator)
  "The lengths of the box around what is to be put somewhere, a 3d-vector; nil when nothing is known of it."
  (let* ((designator (and designator (desig:current-desig designator)))
         (thing (and designator (btr-belief:get-designator-object designator)))
         (type (and designator (desig:desig-prop-value designator :type))))
    (cond (thing (btr:calculate-bb-dims thing))
          (type (ignore-errors (btr:item-dimensions type))))))

(defun type-of-designator (designator)
  (and designator (desig:desig-prop-value (desig:current-desig designator) :type)))

(defun height-above-ground (designator)
  "How far the origin of an object is above its lowest point; half its height for one that is not in the world."
  (let* ((object (and designator (btr-belief:get-designator-object (desig:current-desig designator))))
         (lengths (lengths-of designator)))
    (cond (object
           (let ((box (btr:aabb object)))
             (- (cl-transforms:z (cl-transforms:origin (btr:pose object)))
                (- (cl-transforms:z (btr:bounding-box-center box)) (/ (cl-transforms:z (btr:bounding-box-dimensions box)) 2)))))
          (lengths (/ (cl-transforms:z lengths) 2))
          (t 0.0))))

;;; How large things count as.

(defun shape-of (type)
  (case type
    ((:pot :mug) :complex)
    ((:bowl :plate :pancake-maker) :circle)
    (:mondamin :oval)
    (t :rectangle)))

(defun size-on-plane (type lengths)
  "How wide a thing counts as: by its shape."
  (if (null lengths)
      0.1
      (let ((x (cl-transforms:x lengths)) (y (cl-transforms:y lengths)))
        (ecase (shape-of type)
          (:circle x)
          (:oval (max x y))
          (:rectangle (min x y))
          (:complex (max 0.01 (- x (if (eq type :pot) 0.12 0.04))))))))

(defun padding-of (type)
  "How much room a thing needs around it."
  (case type
    ((:pot) 0.04) ((:bowl) 0.03) ((:mondamin) 0.006) ((:mug) 0.01) ((:plate :knife) 0.005) ((:pancake-maker) 0.018)
    ((:cup) 0.1) ((nil) 0.1) (t 0.01)))

(defun supporter-of (thing)
  "The link of the furniture that an item stands on, as a thing, or nil."
  (loop for (nil nil other link) in (robot-world:contacts btr:*current-bullet-world* (thing-object thing))
        when (and link (eq other (btr:get-environment-object)))
          return (thing-of-object other link)))
