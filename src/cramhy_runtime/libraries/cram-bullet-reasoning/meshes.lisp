;;;; The kinds of objects that have a mesh: a list of their names and files, which programs extend with files of their own.

(in-package #:cram-bullet-reasoning)

(defvar *mesh-files*
  (loop for (name file flip-winding) in '((:mug "mug.stl" t) (:plate "plate.stl") (:mondamin "mondamin.stl") (:pot "pot-ww.stl")
                                          (:weisswurst "ww.stl") (:bowl "bowl.stl") (:fork "fork.stl") (:knife "knife.stl")
                                          (:spatula "spatula.stl") (:cap "cap.stl" t) (:glasses "glasses.stl") (:glove "glove.stl")
                                          (:shoe "shoe.stl"))
        collect (list name (concatenate 'string "package://cram_bullet_reasoning/resource/" file) flip-winding))
  "A list (name address flip-winding) for each kind of object that has a mesh. Where a file is not there, and cramhy has a model of that
name, the model is taken.")

(defun mesh-name (path)
  "The name of the object in the file PATH: red_metal_plate.stl is :RED-METAL-PLATE."
  (intern (substitute #\- #\_ (string-upcase (pathname-name path))) :keyword))

(defun mesh-file-p (path extension)
  "Whether the file PATH has a mesh in it, or the EXTENSION that was asked for."
  (let ((type (pathname-type path)))
    (and type (member type (if extension (list extension) '("stl" "dae" "obj")) :test #'string-equal))))

(defun note-mesh (name address)
  "Write a mesh into the list: over one of that name, or before all others."
  (let ((known (assoc name *mesh-files*)))
    (if known
        (setf (rest known) (list address nil))
        (push (list name address nil) *mesh-files*))
    name))

(defun add-objects-to-mesh-list (ros-package &key (directory "resource") extension)
  "Make the meshes in a folder of ROS-PACKAGE known, each under the name of its file: red_metal_plate.stl is :RED-METAL-PLATE. EXTENSION:
only files that end so; by default STL, Collada and OBJ. The list of the names, in which files that are no mesh are nil."
  (let ((files (physics-utils:parse-uri (format nil "package://~a/~a/*.*" ros-package directory))))
    (if files
        (loop for file in (sort (directory files) #'string< :key #'namestring)
              collect (when (mesh-file-p file extension)
                        (note-mesh (mesh-name file)
                                   (format nil "package://~a/~a/~a" ros-package directory (file-namestring file)))))
        (let ((models (robot-world:models-of-package ros-package)))
          (if models
              (loop for (name file) in models
                    when (mesh-file-p file extension)
                      collect (note-mesh name (format nil "package://~a/~a/~a" ros-package directory file)))
              (warn "There is no ROS package ~a, so its meshes are not known. ROS_PACKAGE_PATH names the folders in which packages are looked for."
                    ros-package))))))

(defun file-of-mesh (name)
  "The path of the file for the mesh NAME, nil when there is none."
  (let* ((address (second (assoc name *mesh-files*)))
         (path (and address (physics-utils:parse-uri address))))
    (and path (probe-file path) path)))

(defun add-mesh-item (world name pose mesh &rest arguments)
  "Add an item of MESH: the name of a mesh, the file of one, or what `physics-utils:load-3d-model' gives."
  (flet ((of-mesh (mesh types)
           (apply #'robot-world:add-mesh world name mesh pose :types (or (getf arguments :types) types) arguments)))
    (cond ((not (symbolp mesh)) (of-mesh (if (pathnamep mesh) (namestring mesh) mesh) '(mesh)))
          ((file-of-mesh mesh) (of-mesh (namestring (file-of-mesh mesh)) (list mesh)))
          (t (apply #'robot-world:add-object-of-type world name mesh pose arguments)))))

(defun mesh-dimensions (mesh)
  "The lengths of the box around the mesh of that name, a 3d-vector, or nil."
  (let ((file (file-of-mesh mesh)))
    (if file
        (robot-world:mesh-size (namestring file))
        (robot-world:object-size mesh))))
