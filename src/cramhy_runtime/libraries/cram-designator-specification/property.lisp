;;;; PROPERTY, the sibling of DESIG-PROP that knows which entries designators have and of what types they are. Types are checked while
;;;; PROLOG:*BREAK-ON-LISP-ERRORS* is true.
;;;;
;;;; An entry whose key and value are both known is found as it stands, whatever the key is. The value of a known key is found, too. So a
;;;; known key with a known value is found twice; plans that go on to the next solution count on it.

(defpackage #:cram-designator-specification
  (:use #:common-lisp #:cram-prolog)
  (:nicknames #:spec)
  (:export #:property))

(in-package #:cram-designator-specification)

(def-fact-group all-designator-specs (property)

  (<- (property ?designator (?key ?value))
    (assert-type ?designator desig:designator "PROPERTY-MEMBER")
    (bound ?key)
    (bound ?value)
    (desig:desig-prop ?designator (?key ?value))))

(defmacro define-properties (class &body types)
  "Say which entries designators of CLASS, such as MOTION, have: each of TYPES is (TYPE KEY...)."
  (let ((group (intern (format nil "~A-DESIGNATOR-SPECS" class)))
        (test (find-symbol (ecase class ((motion action) (format nil "~A-DESIG?" class)) (location "LOC-DESIG?") (object "OBJ-DESIG?"))
                           :desig))
        (tag (format nil "~A SPEC:PROPERTY" class)))
    `(def-fact-group ,group (property)
       ,@(loop for (type . keys) in types
               collect `(<- (property ?designator (?key ?value))
                          (lisp-type ?designator desig:designator)
                          (,test ?designator)
                          (member ?key ,keys)
                          (desig:desig-prop ?designator (?key ?value))
                          (assert-type ?value ,type ,tag))))))

(define-properties motion
  (desig:location-designator :target :left-target :right-target)
  (desig:object-designator :object :objects)
  (string :frame)
  (number :effort :joint-angle)
  ((or keyword list) :gripper :direction :arm)
  (list :left-configuration :right-configuration))

(define-properties action
  (desig:location-designator :target :location)
  (list :left-poses :right-poses)
  ((or keyword list) :gripper :arm :direction :grasp :camera :type)
  (desig:object-designator :object :on-object :with-object)
  (number :position :effort :distance)
  ((or keyword desig:object-designator) :for))

(define-properties location
  (cl-transforms-stamped:pose-stamped :pose)
  (desig:object-designator :object)
  (keyword :arm))

(define-properties object
  (keyword :type)
  (symbol :name :urdf-name)
  (keyword :part-of))
