(asdf:load-system :cl-transforms)
;=> T

(in-package :cl-transforms)
;=> .*

(euler->quaternion :az (/ pi 2))
;=> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>

(quaternion->axis-angle (euler->quaternion :az (/ pi 2)))
;=> #<3D-VECTOR \(0\.0d0 0\.0d0 0\.7071067811865475d0\)>

(axis-angle->quaternion (make-3d-vector 0 0 1) pi)
;=> #<QUATERNION \(0\.0d0 0\.0d0 1\.0d0 6\.123233995736766d-17\)>

(q* (euler->quaternion :az (/ pi 2)) (euler->quaternion :az (/ pi 2)))
;=> #<QUATERNION \(0\.0d0 0\.0d0 1\.0d0 2\.220446049250313d-16\)>

(q-inv (make-quaternion 0.5d0 0.5d0 0.5d0 0.5d0))
;=> #<QUATERNION \(-0\.5d0 -0\.5d0 -0\.5d0 0\.5d0\)>

(angle-between-quaternions (make-identity-rotation) (euler->quaternion :ax 0.3d0))
;=> 0\.3000000000000006d0

(slerp (make-identity-rotation) (euler->quaternion :az 1.0d0) 0.5d0)
;=> #<QUATERNION \(0\.0d0 0\.0d0 0\.24740395925452296d0 0\.9689124217106448d0\)>

(normalize (make-quaternion 1 2 3 4))
;=> #<QUATERNION \(0\.18257418583505536d0 0\.3651483716701107d0 0\.5477225575051661d0 0\.7302967433402214d0\)>

(rotate (euler->quaternion :az (/ pi 2)) (make-3d-vector 1 2 3))
;=> #<3D-VECTOR \(-1\.9999999999999998d0 1\.0000000000000004d0 3\.0d0\)>

(v+ (make-3d-vector 1 2 3) (make-3d-vector 4 5 6))
;=> #<3D-VECTOR \(5\.0d0 7\.0d0 9\.0d0\)>

(v- (make-3d-vector 1 2 3) (make-3d-vector 4 5 6))
;=> #<3D-VECTOR \(-3\.0d0 -3\.0d0 -3\.0d0\)>

(v* (make-3d-vector 1 2 3) 0.5)
;=> #<3D-VECTOR \(0\.5d0 1\.0d0 1\.5d0\)>

(v-dist (make-3d-vector 1 2 3) (make-3d-vector 4 6 3))
;=> 5\.0d0

(dot-product (make-3d-vector 1 2 3) (make-3d-vector 4 5 6))
;=> 32\.0d0

(cross-product (make-3d-vector 1 0 0) (make-3d-vector 0 1 0))
;=> #<3D-VECTOR \(0\.0d0 0\.0d0 1\.0d0\)>

(v-norm (make-3d-vector 3 4 0))
;=> 5\.0d0

(transform (make-transform (make-3d-vector 1 0 0) (euler->quaternion :az (/ pi 2))) (make-3d-vector 1 0 0))
;=> #<3D-VECTOR \(1\.0000000000000002d0 1\.0d0 0\.0d0\)>

(transform* (make-transform (make-3d-vector 1 2 3) (euler->quaternion :az 0.5d0)) (make-transform (make-3d-vector 1 0 0) (euler->quaternion :ax 0.25d0)))
;=> #<TRANSFORM #<3D-VECTOR \(1\.8775825618903728d0 2\.479425538604203d0 3\.0d0\)> #<QUATERNION \(0\.12079889785040993d0 0\.030845022658507384d0 0\.24547363123563762d0 0\.9613526445708216d0\)>>

(transform-inv (make-transform (make-3d-vector 1 2 3) (euler->quaternion :az (/ pi 2))))
;=> #<TRANSFORM #<3D-VECTOR \(-2\.0d0 0\.9999999999999996d0 -3\.0d0\)> #<QUATERNION \(-0\.0d0 -0\.0d0 -0\.7071067811865475d0 0\.7071067811865476d0\)>>

(transform-diff (make-transform (make-3d-vector 1 2 3) (make-identity-rotation)) (make-transform (make-3d-vector 0 1 1) (make-identity-rotation)))
;=> #<TRANSFORM #<3D-VECTOR \(1\.0d0 1\.0d0 2\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(pose->transform (make-pose (make-3d-vector 1 2 3) (make-identity-rotation)))
;=> #<TRANSFORM #<3D-VECTOR \(1\.0d0 2\.0d0 3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(reference-transform (make-identity-transform))
;=> #<TRANSFORM #<3D-VECTOR \(0\.0d0 0\.0d0 0\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(transform-pose (make-transform (make-3d-vector 1 2 3) (euler->quaternion :az pi)) (make-pose (make-3d-vector 1 1 1) (make-identity-rotation)))
;=> #<POSE #<3D-VECTOR \(-2\.220446049250313d-16 1\.0d0 4\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 1\.0d0 6\.123233995736766d-17\)>>

(make-identity-transform)
;=> #<TRANSFORM #<3D-VECTOR \(0\.0d0 0\.0d0 0\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(normalize-angle 7.0d0)
;=> 0\.7168146928204138d0

(get-yaw (euler->quaternion :az 0.7d0))
;=> 0\.7d0

(quaternion->euler (euler->quaternion :ax 0.1d0 :ay 0.2d0 :az 0.3d0))
;=> \(:AX 0\.0999999999999999[89]d0 :AY 0\.2d0 :AZ 0\.30000000000000004d0\)

(copy-3d-vector (make-3d-vector 1 2 3) :z 9)
;=> #<3D-VECTOR \(1\.0d0 2\.0d0 9\.0d0\)>

(transform->matrix (make-transform (make-3d-vector 1 2 3) (euler->quaternion :az (/ pi 2))))
;=> #2A\(\(2\.220446049250313d-16 -1\.0d0 0\.0d0 1\.0d0\) \(1\.0d0 2\.220446049250313d-16 0\.0d0 2\.0d0\) \(0\.0d0 0\.0d0 1\.0d0 3\.0d0\) \(0\.0 0\.0 0\.0 1\)\)

(matrix->quaternion (transform->matrix (make-transform (make-3d-vector 0 0 0) (euler->quaternion :az 0.4d0))))
;=> #<QUATERNION \(0\.0d0 0\.0d0 0\.19866933079506122d0 0\.9800665778412415d0\)>

(is-normalized (make-quaternion 1 2 3 4))
;=> NIL

(interpolate-vector (make-3d-vector 0 0 0) (make-3d-vector 2 4 6) 0.25)
;=> #<3D-VECTOR \(0\.5d0 1\.0d0 1\.5d0\)>
