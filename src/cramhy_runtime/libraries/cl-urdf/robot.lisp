;;;; Robots are read by ROBOT-WORLD. The objects of this package are made of what it read when they are first asked for, and a world takes
;;;; their changes: another root, other places of joints, other shapes.

(in-package #:cl-urdf)

(defparameter *display-ignored-warning* nil
  "Whether the original warns of elements that it passes over. Here these are passed over without a word.")

(define-condition urdf-type-not-supported (simple-warning) ())
(define-condition urdf-attribute-not-supported (simple-warning) ())
(define-condition urdf-malformed (simple-error) ()
  (:documentation "A text that describes no robot."))

;;; Reading.

(defgeneric parse-urdf (input)
  (:documentation "The robot that a text, a file or a stream of URDF tells of. A text that is wrong is an `urdf-malformed' error.")
  (:method ((input string))
    (if (and (plusp (length input)) (not (find #\< input)) (ignore-errors (probe-file input)))
        (error 'urdf-malformed :format-control "~a is the name of a file, and PARSE-URDF takes a string for the text of a robot. ~
                                                A file is given as a pathname: (cl-urdf:parse-urdf ~s)"
                               :format-arguments (list input (pathname input)))
        (read-robot input "")))
  (:method ((input pathname))
    (if (equalp (pathname-type input) "xacro")
        (read-robot (robot-world:description-text (namestring (truename input))) (namestring input))
        (with-open-file (stream input)
          (parse-urdf stream))))
  (:method ((input stream))
    (read-robot (with-output-to-string (text)
                  (loop for line = (read-line input nil) while line do (write-line line text)))
                (let ((file (ignore-errors (pathname input)))) (if file (namestring file) "")))))

(defun read-robot (text file)
  "The robot that TEXT tells of. FILE: what the text is called in errors."
  (let ((description (handler-case (robot-world:read-description text file)
                       (error (problem)
                         (error 'urdf-malformed :format-control "~a" :format-arguments (list (princ-to-string problem)))))))
    (make-instance 'robot :name (robot-world:description-name description) :description description :text text)))

(defvar *robots* (make-hash-table :test 'eq :weakness :key)
  "The robots of descriptions that a world has, by these.")

(defun robot-of (description)
  "The robot with that DESCRIPTION of ROBOT-WORLD. It is the one that `description-of' was asked about, if there is one."
  (or (gethash description *robots*)
      (setf (gethash description *robots*)
            (make-instance 'robot :name (robot-world:description-name description) :description description))))

;;; The parts are made when one of them is first asked for.

(defmethod slot-unbound (class (robot robot) slot-name)
  (declare (ignore class))
  (cond ((and (member slot-name '(links joints root-link materials)) (description robot))
         (make-parts robot)
         (slot-value robot slot-name))
        ((member slot-name '(links joints materials))
         (setf (slot-value robot slot-name) (make-hash-table :test 'equal)))
        (t (call-next-method))))

(defun make-parts (robot)
  "Make the objects of ROBOT that were not given."
  (destructuring-bind (materials visuals mimics) (if (text robot) (parts-in-text (text robot)) '(nil nil nil))
    (flet ((fill-slot (slot-name value)
             (unless (slot-boundp robot slot-name) (setf (slot-value robot slot-name) value))))
      (let* ((links (make-links (description robot) visuals))
             (joints (make-joints (description robot) links mimics))
             (table (make-hash-table :test 'equal)))
        (dolist (material materials)
          (setf (gethash (first material) table) (make-material material)))
        (fill-slot 'links links)
        (fill-slot 'joints joints)
        (fill-slot 'materials table)
        (fill-slot 'root-link (loop for link being the hash-values of links
                                    unless (from-joint link) return link))))))

(defun parts-in-text (text)
  "What `robot-world:description-parts' tells of TEXT; nothing of one that is not URDF."
  (if (search "<mujoco" text) '(nil nil nil) (robot-world:description-parts text)))

(defun pose->transform (pose)
  (cl-transforms:make-transform (cl-transforms:origin pose) (cl-transforms:orientation pose)))

(defun make-geometry (kind size file)
  (ecase kind
    (:box (make-instance 'box :size (apply #'cl-transforms:make-3d-vector size)))
    (:cylinder (make-instance 'cylinder :radius (first size) :length (second size)))
    (:sphere (make-instance 'sphere :radius (first size)))
    (:mesh (make-instance 'mesh :filename file :scale (apply #'cl-transforms:make-3d-vector size)))))

(defun make-material (material)
  (destructuring-bind (name color texture) material
    (apply #'make-instance 'material :name name (append (and color (list :color color)) (and texture (list :texture texture))))))

(defun make-visual (shape material)
  (destructuring-bind (kind size pose file) shape
    (apply #'make-instance 'visual :origin (pose->transform pose) :geometry (make-geometry kind size file)
           (and material (list :material (make-material material))))))

(defun make-links (description visuals)
  "A hash table of the links of DESCRIPTION by their names. VISUALS: a list of (link shape material)."
  (let ((links (make-hash-table :test 'equal)))
    (loop for (name mass shapes) in (robot-world:description-links description)
          for collisions = (loop for (kind size pose file) in shapes
                                 collect (make-instance 'collision
                                           :origin (pose->transform pose) :geometry (make-geometry kind size file)))
          for seen = (or (loop for (link shape material) in visuals
                               when (string= link name) collect (make-visual shape material))
                         (loop for shape in shapes collect (make-visual shape nil)))
          do (setf (gethash name links)
                   (make-instance 'link
                     :name name :inertial (make-instance 'inertial :mass mass) :visual (first seen) :visuals seen
                     :collision (first collisions) :collisions collisions :collisions-in-file collisions)))
    links))

(defun make-joints (description links mimics)
  "A hash table of the joints of DESCRIPTION by their names. MIMICS: a list of (joint other multiplier offset)."
  (let ((joints (make-hash-table :test 'equal)))
    (loop for (name kind parent child pose axis lower upper velocity effort mimic) in (robot-world:description-joints description)
          for above = (gethash parent links)
          for below = (gethash child links)
          for (other times plus) = (or (rest (assoc name mimics :test #'string=)) (and mimic (list mimic 1.0d0 0.0d0)))
          for origin = (pose->transform pose)
          for joint = (apply #'make-instance 'joint
                             :name name :type kind :origin origin :origin-in-file origin :axis axis :parent above :child below
                             (append (when (or lower upper velocity effort)
                                       (list :limits (make-limits lower upper velocity effort)))
                                     (when other
                                       (list :mimics (make-instance 'mimics :joint other :multiplier times :offset plus)))))
          do (setf (gethash name joints) joint
                   (slot-value below 'from-joint) joint
                   (slot-value above 'to-joints) (append (slot-value above 'to-joints) (list joint))))
    joints))

(defun make-limits (lower upper velocity effort)
  (apply #'make-instance 'limits
         (append (and lower (list :lower lower)) (and upper (list :upper upper))
                 (and velocity (list :velocity velocity)) (and effort (list :effort effort)))))

;;; What a world takes.

(defun geometry-as-list (geometry)
  "(kind size file) of a shape, as `robot-world:description-links' tells it."
  (flet ((lengths (vector)
           (list (cl-transforms:x vector) (cl-transforms:y vector) (cl-transforms:z vector))))
    (etypecase geometry
      (box (list :box (lengths (size geometry)) nil))
      (cylinder (list :cylinder (list (radius geometry) (cylinder-length geometry)) nil))
      (sphere (list :sphere (list (radius geometry)) nil))
      (mesh (list :mesh
                  (let ((scale (scale geometry)))
                    (cond ((null scale) (list 1 1 1)) ((numberp scale) (list scale scale scale)) (t (lengths scale))))
                  (filename geometry))))))

(defun as-pose (transform)
  "TRANSFORM, or a pose, as a pose."
  (if (typep transform 'cl-transforms:transform)
      (cl-transforms:make-pose (cl-transforms:translation transform) (cl-transforms:rotation transform))
      transform))

(defun changed-origins (robot)
  "A list of (name pose) for the joints that were put elsewhere."
  (loop for joint being the hash-values of (joints robot)
        unless (eq (origin joint) (origin-in-file joint)) collect (list (name joint) (as-pose (origin joint)))))

(defun changed-shapes (robot)
  "A list of (name shape ...) for the links that got other collisions. The first one counts where only that was set."
  (loop for link being the hash-values of (links robot)
        for first = (collision link) and all = (collisions link) and old = (collisions-in-file link)
        unless (and (eq all old) (eq first (first old)))
          collect (cons (name link)
                        (loop for collision in (if (member first all) all (and first (list first)))
                              for (kind size file) = (geometry-as-list (geometry collision))
                              collect (list kind size (as-pose (origin collision)) file)))))

(defun description-of (robot)
  "The description of ROBOT that a world takes, with all that a program has changed in its slots."
  (cond ((not (typep robot 'robot)) robot)
        ((null (description robot))
         (error "~a was not read from a description, so it cannot be put into a world." robot))
        (t
         (let ((description (description robot)))
           (when (slot-boundp robot 'links)
             (let ((origins (changed-origins robot)) (shapes (changed-shapes robot)))
               (unless (and (null origins) (null shapes) (null (from-joint (root-link robot))))
                 (setf description (robot-world:changed-description description (name (root-link robot)) origins shapes)))))
           (setf (gethash description *robots*) robot)
           description))))

;;; Writing.

(defun generate-urdf-string (robot)
  "The URDF text of ROBOT."
  (robot-world:description-file-text (description-of robot)))

(defun generate-urdf-xml (robot)
  "The element <robot> of ROBOT, as an XML-ELEMENT of the library s-xml, which is loaded for it."
  (asdf:load-system :s-xml)
  (uiop:symbol-call :s-xml '#:parse-xml-string (generate-urdf-string robot) :output-type :xml-struct))

;;; Chains.

(defun chain (robot start end)
  "The joints that move on the way from the link named START down to the one named END; and whether there is such a way."
  (flet ((link (name)
           (or (gethash name (links robot)) (error "There is no link ~s in ~a." name robot))))
    (let ((start (link start)) (link (link end)) (found nil))
      (loop (when (eq link start) (return (values found t)))
            (let ((joint (from-joint link)))
              (unless joint (return (values nil nil)))
              (unless (eq (joint-type joint) :fixed) (push joint found))
              (setf link (parent joint)))))))

(defun get-joint-chain (robot start end)
  "The joints that move between the link named START and the one named END, below it; nil if END is not below START."
  (values (chain robot start end)))

(defun get-link-chain (robot start end)
  "The link named START, and the links below it on the way to the one named END that a joint moves; nil if END is not below START."
  (multiple-value-bind (joints below) (chain robot start end)
    (and below (cons (gethash start (links robot)) (mapcar #'child joints)))))
