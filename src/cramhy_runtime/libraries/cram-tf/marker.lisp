;;;; Markers: poses, drawn in RViz, Foxglove or on the page.

(in-package #:cram-tf)

(defvar *marker-publications* (make-hash-table :test 'equal)
  "The publication of each topic.")

(defun forget-marker-publications ()
  (clrhash *marker-publications*))

(roslisp-utilities:register-ros-cleanup-function forget-marker-publications)

(defun marker-publication (topic)
  (or (gethash topic *marker-publications*)
      (setf (gethash topic *marker-publications*) (roslisp:advertise topic "visualization_msgs/Marker"))))

(defun visualize-marker (pose/s &key (topic "visualization_marker") (r-g-b-list '(1 0 0)) (marker-type :arrow) (id 1) in-frame)
  "Draw a pose, or several. MARKER-TYPE: a type of a visualization_msgs/Marker, such as :ARROW, :SPHERE or :CUBE. ID: the number of the
first marker, which replaces what had it. IN-FRAME: the frame of poses that have none; else the fixed frame."
  (destructuring-bind (red green blue) r-g-b-list
    (loop for pose in (if (listp pose/s) pose/s (list pose/s))
          for number from id
          do (let ((stamped (ensure-pose-stamped-in pose in-frame)))
               (roslisp:publish-msg (marker-publication topic)
                 (:frame_id :header) (frame-id stamped)
                 (:stamp :header) (roslisp:ros-time)
                 :ns "cram_tf"
                 :id number
                 :type (roslisp:symbol-code 'visualization_msgs-msg:marker marker-type)
                 :action (roslisp:symbol-code 'visualization_msgs-msg:marker :add)
                 :pose (to-msg (stamped-pose->pose stamped))
                 (:x :scale) (if (eq marker-type :arrow) 0.15 0.05)
                 (:y :scale) (if (eq marker-type :arrow) 0.03 0.05)
                 (:z :scale) (if (eq marker-type :arrow) 0.03 0.05)
                 (:r :color) red
                 (:g :color) green
                 (:b :color) blue
                 (:a :color) 1)))))

(defun ensure-pose-stamped-in (pose frame)
  (if (typep pose 'pose-stamped) pose (pose->pose-stamped (or frame *fixed-frame* "map") 0.0 pose)))

(defun stamped-pose->pose (pose)
  (make-pose (origin pose) (orientation pose)))
