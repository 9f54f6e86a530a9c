;;;; Grids from and for ROS: nav_msgs/GridCells, nav_msgs/OccupancyGrid, and markers.

(in-package #:cram-location-costmap)

(defun cells-metadata (cells cell-width padding)
  "The geometry of the smallest grid that has all CELLS, points, with PADDING metres around."
  (when (zerop (length cells)) (error "The message has no cells."))
  (flet ((extent (reader)
           (loop for cell across cells for value = (funcall reader cell)
                 minimize value into least maximize value into most
                 finally (return (values (- least padding) (+ (- most least) cell-width (* 2 padding)))))))
    (multiple-value-bind (origin-x width) (extent #'geometry_msgs-msg:x)
      (multiple-value-bind (origin-y height) (extent #'geometry_msgs-msg:y)
        (list :width width :height height :origin-x origin-x :origin-y origin-y :resolution cell-width)))))

(defun grid-cells-msg->occupancy-grid (msg &optional padding)
  "The occupancy grid around the cells of a nav_msgs/GridCells, which are occupied, as is what is within PADDING metres of them."
  (with-fields (cells cell_width) msg
    (let ((grid (apply #'make-instance 'occupancy-grid (cells-metadata cells cell_width (or padding 0)))))
      (loop with mask = (make-padding-mask 1)
            for cell across cells
            do (occupancy-grid-put-mask (geometry_msgs-msg:x cell) (geometry_msgs-msg:y cell) grid mask))
      (%pad-grid grid padding))))

(defun grid-cells-msg->height-map (msg)
  "A 2d-value-map with the height of each cell of a nav_msgs/GridCells."
  (with-fields (cells cell_width) msg
    (let ((map (apply #'make-instance '2d-value-map (cells-metadata cells cell_width 0))))
      (loop for cell across cells
            do (2d-value-map-set map (geometry_msgs-msg:x cell) (geometry_msgs-msg:y cell) (geometry_msgs-msg:z cell)))
      map)))

(defun occupancy-grid-msg-metadata (map &key key)
  "The geometry of a nav_msgs/OccupancyGrid in metres: with KEY (:width, :height, :origin-x, :origin-y, :resolution) that
figure, else an object with all of them."
  (with-fields ((columns (width info)) (rows (height info)) (resolution (resolution info))
                (x (x position origin info)) (y (y position origin info)))
      map
    (let ((metadata (list :width (* columns resolution) :height (* rows resolution) :origin-x x :origin-y y :resolution resolution)))
      (cond ((null key) (apply #'make-instance 'occupancy-grid-metadata metadata))
            ((getf metadata key))
            (t (error "~S is none of the keys ~{~S~^, ~}." key (loop for name in metadata by #'cddr collect name)))))))

(defun occupancy-grid-msg->occupancy-grid (msg &key padding invert)
  "The grid whose cells are occupied where a nav_msgs/OccupancyGrid says so; with INVERT, those that it knows to be free. What is
within PADDING metres of such a cell counts, too."
  (%pad-grid (%grid-of-values (occupancy-grid-msg-metadata msg) (nav_msgs-msg:data msg) (if invert #'zerop #'plusp)) padding))

(defun occupancy-grid->grid-cells-msg (grid &key (frame-id (fixed-frame)) (z 0.0))
  "The nav_msgs/GridCells with the occupied cells of GRID."
  (make-message "nav_msgs/GridCells"
                (frame_id header) frame-id
                (stamp header) (ros-time)
                cell_width (resolution grid)
                cell_height (resolution grid)
                cells (map 'vector (lambda (place) (make-message "geometry_msgs/Point" x (first place) y (second place) z z))
                           (%occupied-places grid))))

(defun fixed-frame ()
  "The frame in which costmaps lie: cram-tf's, where that is loaded and knows one, else \"map\"."
  (let ((variable (and (find-package '#:cram-tf) (find-symbol "*FIXED-FRAME*" '#:cram-tf))))
    (or (and variable (boundp variable) (symbol-value variable)) "map")))

;;; ------------------------------------------------------------------------------------------------------------------ markers

(defun marker (type id scale &rest more)
  "A visualization_msgs/Marker of a TYPE (a symbol of that message), red, SCALE metres large."
  (apply #'with-slots-set
         (make-message "visualization_msgs/Marker"
                       (frame_id header) (fixed-frame)
                       (stamp header) (ros-time)
                       ns "location_costmap"
                       id id
                       type (symbol-code 'visualization_msgs-msg:marker type)
                       action (symbol-code 'visualization_msgs-msg:marker :add)
                       (w orientation pose) 1.0
                       (x scale) scale (y scale) scale (z scale) scale
                       (r color) 1.0 (a color) 1.0)
         more))

(defun with-slots-set (message &rest fields)
  "MESSAGE with FIELDS (slots and values in turn) set."
  (loop for (slot value) on fields by #'cddr do (setf (slot-value message slot) value))
  message)

(defun publish-marker (marker topic type)
  "Publish a message on TOPIC if a node is running."
  (when (eq (node-status) :running)
    (publish (advertise topic type) marker))
  marker)

(defun publish-location-costmap (map &key (frame-id (fixed-frame)) (threshold 0.0005) (z *z-padding*))
  "Show a costmap on the topic visualization_marker_array: a coloured square for each cell whose value is at least THRESHOLD times
the greatest; from blue to red. FRAME-ID: where the map lies. Returns the message."
  (let ((cells (coerce (%visible-cells map threshold) 'vector)))
    (publish-marker
     (make-message
      "visualization_msgs/MarkerArray"
      markers
      (vector (marker :cube_list 0 (resolution map)
                      'visualization_msgs-msg:header (make-message "std_msgs/Header" frame_id frame-id stamp (ros-time))
                      'visualization_msgs-msg:points
                      (map 'vector (lambda (cell) (make-message "geometry_msgs/Point" x (first cell) y (second cell) z z)) cells)
                      'visualization_msgs-msg:colors
                      (map 'vector (lambda (cell)
                                     (let ((value (third cell)))
                                       (make-message "std_msgs/ColorRGBA" r value b (- 1 value) a 0.8)))
                           cells))))
     "visualization_marker_array" "visualization_msgs/MarkerArray")))

(defun publish-point (point &key id)
  "Show a point as a ball on the topic visualization_marker. ID: a number; a marker with the same one is replaced."
  (publish-marker (marker :sphere (or id 0) 0.1 'visualization_msgs-msg:pose (to-msg (make-pose point (make-identity-rotation))))
                  "visualization_marker" "visualization_msgs/Marker"))

(defun publish-pose (pose &key id)
  "Show a pose as an arrow on the topic visualization_marker. ID as for PUBLISH-POINT."
  (publish-marker (marker :arrow (or id 0) 0.3 'visualization_msgs-msg:pose (to-msg (pose->plain pose)))
                  "visualization_marker" "visualization_msgs/Marker"))

(defun pose->plain (pose)
  (make-pose (origin pose) (orientation pose)))
