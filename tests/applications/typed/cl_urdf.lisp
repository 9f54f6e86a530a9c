(asdf:load-system :cl-urdf)
;=> T

(in-package :cl-urdf)
;=> .*

(defparameter *robot* (parse-urdf "<robot name='arm'><material name='red'><color rgba='1 0 0 1'/></material><link name='base'><inertial><origin xyz='0 0 0.1' rpy='0 0 0'/><mass value='2.5'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial><visual><origin xyz='0 0 0.5' rpy='0 0 0'/><geometry><box size='1 2 3'/></geometry><material name='red'/></visual><collision><geometry><cylinder radius='0.25' length='0.5'/></geometry></collision></link><link name='upper'><visual><geometry><sphere radius='0.125'/></geometry></visual></link><link name='hand'><visual><geometry><mesh filename='package://arm/hand.dae' scale='2 2 2'/></geometry></visual></link><joint name='shoulder' type='revolute'><parent link='base'/><child link='upper'/><origin xyz='0 0 1' rpy='0 0 0'/><axis xyz='0 1 0'/><limit lower='-1.5' upper='0.5' effort='10' velocity='2'/></joint><joint name='wrist' type='fixed'><parent link='upper'/><child link='hand'/><origin xyz='0.5 0 0' rpy='0 0 0'/></joint></robot>"))
;=> \*ROBOT\*

(name *robot*)
;=> "arm"

(hash-table-count (links *robot*))
;=> 3

(hash-table-count (joints *robot*))
;=> 2

(name (root-link *robot*))
;=> "base"

(from-joint (root-link *robot*))
;=> NIL

(mapcar #'name (to-joints (root-link *robot*)))
;=> \("shoulder"\)

(name (from-joint (gethash "hand" (links *robot*))))
;=> "wrist"

(joint-type (gethash "shoulder" (joints *robot*)))
;=> :REVOLUTE

(joint-type (gethash "wrist" (joints *robot*)))
;=> :FIXED

(axis (gethash "shoulder" (joints *robot*)))
;=> #<CL-TRANSFORMS:3D-VECTOR \(0\.0d0 1\.0d0 0\.0d0\)>

(origin (gethash "shoulder" (joints *robot*)))
;=> #<CL-TRANSFORMS:TRANSFORM #<3D-VECTOR \(0\.0d0 0\.0d0 1\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(name (parent (gethash "shoulder" (joints *robot*))))
;=> "base"

(name (child (gethash "shoulder" (joints *robot*))))
;=> "upper"

(let ((l (limits (gethash "shoulder" (joints *robot*))))) (list (lower l) (upper l) (effort l) (velocity l)))
;=> \(-1\.5d0 0\.5d0 10(\.0d0)? 2(\.0d0)?\)

(size (geometry (visual (gethash "base" (links *robot*)))))
;=> #<CL-TRANSFORMS:3D-VECTOR \(1\.0d0 2\.0d0 3\.0d0\)>

(type-of (geometry (visual (gethash "base" (links *robot*)))))
;=> BOX

(origin (visual (gethash "base" (links *robot*))))
;=> #<CL-TRANSFORMS:TRANSFORM #<3D-VECTOR \(0\.0d0 0\.0d0 0\.5d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(let ((g (geometry (collision (gethash "base" (links *robot*)))))) (list (type-of g) (radius g) (cylinder-length g)))
;=> \(CYLINDER 0\.25d0 0\.5d0\)

(radius (geometry (visual (gethash "upper" (links *robot*)))))
;=> 0\.125d0

(let ((g (geometry (visual (gethash "hand" (links *robot*)))))) (list (filename g) (scale g)))
;=> \("package://arm/hand\.dae" #<CL-TRANSFORMS:3D-VECTOR \(2\.0d0 2\.0d0 2\.0d0\)>\)

(mass (inertial (gethash "base" (links *robot*))))
;=> 2\.5d0

(name (material (visual (gethash "base" (links *robot*)))))
;=> "red"

(color (material (visual (gethash "base" (links *robot*)))))
;=> \(1(\.0d0)? 0(\.0d0)? 0(\.0d0)? 1(\.0d0)?\)

(name (gethash "red" (materials *robot*)))
;=> "red"

(mapcar #'name (get-joint-chain *robot* "base" "hand"))
;=> \("shoulder"\)

(mapcar #'name (get-link-chain *robot* "base" "hand"))
;=> \("base" "upper"\)

(mapcar #'name (get-joint-chain *robot* "base" "upper"))
;=> \("shoulder"\)

(get-joint-chain *robot* "hand" "base")
;=> NIL

(length (visuals (gethash "base" (links *robot*))))
;=> 1

(length (collisions (gethash "base" (links *robot*))))
;=> 1

(name (parse-urdf (generate-urdf-string *robot*)))
;=> "arm"

(s-xml:xml-element-name (generate-urdf-xml *robot*))
;=> :\|robot\|

(s-xml:xml-element-attribute (generate-urdf-xml *robot*) :|name|)
;=> "arm"

(length (s-xml:xml-element-children (generate-urdf-xml *robot*)))
;=> 5

(slot-boundp (gethash "wrist" (joints *robot*)) 'limits)
;=> NIL

(mapcar #'name (list (setf (slot-value *robot* 'root-link) (gethash "upper" (links *robot*)))))
;=> \("upper"\)
